#define _POSIX_C_SOURCE 200809L
#include "stats.h"

#include "file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

double rd_now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

void rd_stats_begin(rd_stats* s)
{
    memset(s, 0, sizeof *s);
    s->begin_ms = rd_now_ms();
}

static void add(rd_stats_entry* entries, int* count, const char* name, double value)
{
    for (int i = 0; i < *count; ++i) {
        if (!strcmp(entries[i].name, name)) {
            entries[i].value += value;
            return;
        }
    }
    if (*count < RD_STATS_MAX) {
        entries[*count].name = name;
        entries[*count].value = value;
        ++*count;
    }
}

void rd_stats_pass(rd_stats* s, const char* name, double ms)
{
    add(s->passes, &s->pass_count, name, ms);
}

void rd_stats_count(rd_stats* s, const char* name, double n)
{
    add(s->counts, &s->count_count, name, n);
}

void rd_stats_limit(rd_stats* s, const char* name, double n)
{
    add(s->limits, &s->limit_count, name, n);
}

void rd_stats_error(rd_stats* s, const char* name, double value)
{
    add(s->errors, &s->error_count, name, value);
}

void rd_stats_lit(rd_stats* s, const char* material, double samples, double ns_each)
{
    add(s->lit, &s->lit_count, material, samples);
    add(s->lit_ns, &s->lit_ns_count, material, ns_each);
}

void rd_stats_list(rd_stats* s, const char* name, double value)
{
    add(s->lists, &s->list_count, name, value);
}

void rd_stats_variant(rd_stats* s, const char* features, double tiles, double cycles_each)
{
    add(s->variants, &s->variant_count, features, tiles);
    add(s->variant_cycles, &s->variant_cycles_count, features, cycles_each);
}

static void print_lists(const rd_stats* s)
{
    for (int i = 0; i < s->list_count; ++i) {
        printf("%-24s %10.6g\n", s->lists[i].name, s->lists[i].value);
    }
    if (s->variant_count > 0) {
        printf("%10s %10s  %s\n", "tiles", "cycles", "variant");
    }
    for (int i = 0; i < s->variant_count; ++i) {
        printf("%10.0f %10.0f  %s\n", s->variants[i].value, s->variant_cycles[i].value,
               s->variants[i].name);
    }
}

static void print_lit(const rd_stats* s)
{
    if (s->lit_count > 0) {
        printf("%-24s %10s %6s\n", "lighting of materials", "samples", "ns");
    }
    for (int i = 0; i < s->lit_count; ++i) {
        printf("%-24s %10.0f", s->lit[i].name, s->lit[i].value);
        if (isfinite(s->lit_ns[i].value)) {
            printf(" %6.0f\n", s->lit_ns[i].value);
        } else {
            printf(" %6s\n", "-");
        }
    }
}

void rd_stats_print(const rd_stats* s)
{
    double total = rd_now_ms() - s->begin_ms;
    double other = total;
    if (s->device) {
        printf("device: %s\n", s->device);
    }
    printf("%-24s %10s %6s\n", "pass", "ms", "%");
    for (int i = 0; i < s->pass_count; ++i) {
        double ms = s->passes[i].value;
        other -= ms;
        printf("%-24s %10.1f %6.1f\n", s->passes[i].name, ms, 100.0 * ms / total);
    }
    printf("%-24s %10.1f %6.1f\n", "other", other, 100.0 * other / total);
    printf("%-24s %10.1f\n", "total", total);
    print_lit(s);
    print_lists(s);
    for (int i = 0; i < s->limit_count; ++i) {
        if (s->limits[i].value > 0) {
            printf("limit hit: %s: %.0f\n", s->limits[i].name, s->limits[i].value);
        }
    }
    for (int i = 0; i < s->error_count; ++i) {
        printf("%-24s %10.6g\n", s->errors[i].name, s->errors[i].value);
    }
}

static void write_string(FILE* f, const char* s)
{
    fputc('"', f);
    for (; *s; ++s) {
        unsigned char c = (unsigned char)*s;
        if (c == '"' || c == '\\') {
            fprintf(f, "\\%c", c);
        } else if (c < 0x20) {
            fprintf(f, "\\u%04x", c);
        } else {
            fputc(c, f);
        }
    }
    fputc('"', f);
}

/* JSON has no infinity: an error of identical images is null. */
static void write_number(FILE* f, double v)
{
    if (isfinite(v)) {
        fprintf(f, "%.9g", v);
    } else {
        fputs("null", f);
    }
}

static void write_object(FILE* f, const char* key, const rd_stats_entry* entries, int count)
{
    fprintf(f, ",\n  \"%s\": {", key);
    for (int i = 0; i < count; ++i) {
        fputs(i ? ",\n    " : "\n    ", f);
        write_string(f, entries[i].name);
        fputs(": ", f);
        write_number(f, entries[i].value);
    }
    fputs(count ? "\n  }" : "}", f);
}

static bool write_all(const rd_stats* s, FILE* f)
{
    fputs("{\n  \"scene\": ", f);
    write_string(f, s->scene ? s->scene : "built-in");
    fprintf(f, ",\n  \"width\": %d,\n  \"height\": %d,\n  \"samples_per_pixel\": %d", s->width,
            s->height, s->spp);
    if (s->device) {
        fputs(",\n  \"device\": ", f);
        write_string(f, s->device);
    }
    fputs(",\n  \"total_ms\": ", f);
    write_number(f, rd_now_ms() - s->begin_ms);
    write_object(f, "passes_ms", s->passes, s->pass_count);
    write_object(f, "counts", s->counts, s->count_count);
    write_object(f, "limits_hit", s->limits, s->limit_count);
    write_object(f, "errors", s->errors, s->error_count);
    write_object(f, "lit_samples", s->lit, s->lit_count);
    write_object(f, "lit_ns", s->lit_ns, s->lit_ns_count);
    write_object(f, "lists", s->lists, s->list_count);
    write_object(f, "variant_tiles", s->variants, s->variant_count);
    write_object(f, "variant_cycles", s->variant_cycles, s->variant_cycles_count);
    fputs("\n}\n", f);
    return !ferror(f);
}

bool rd_stats_write(const rd_stats* s, const char* path, rd_report* report)
{
    rd_output out;
    FILE* f;
    bool ok;
    if (!rd_output_begin(&out, path, report)) {
        return false;
    }
    f = fopen(out.temporary, "w");
    ok = f && write_all(s, f);
    if (f && fclose(f) != 0) {
        ok = false;
    }
    if (!ok) {
        rd_fail(report, path, "cannot write");
    }
    return rd_output_end(&out, ok, report);
}
