/* published.c - forms that others publish and ours, against one reference on the same inputs.
 * SPDX-License-Identifier: MIT
 *
 * published            prints the table
 * published --check F  fails where it is not that of the file F, to 2 %, and where ours do not keep
 *                      the distance that they should
 *
 * A row is a form: a published one by its author, ours by its name. The bias is the mean of signed
 * errors, for forms of one number. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HDRP_BRDF_IMPLEMENTATION
#include "../accuracy/film_reference.h"
#include "../brdf_quadrature.h"
#include "hdrp_brdf.h"
#include "hdrp_pack.h"
#include "published_forms.h"

#define HEADING  "topic,form,quantity,unit,max,mean,bias"
#define MAX_ROWS 64

typedef struct row {
    const char *topic, *form, *quantity, *unit;
    double max, sum, signed_sum;
    long count;
    bool biased; /* whether errors have a sign */
} row;

static row rows[MAX_ROWS];
static int row_count;

static row* add_row(const char* topic, const char* form, const char* quantity, const char* unit)
{
    row* r = &rows[row_count++];
    r->topic = topic;
    r->form = form;
    r->quantity = quantity;
    r->unit = unit;
    return r;
}

static void add_error(row* r, double error)
{
    r->max = fmax(r->max, fabs(error));
    r->sum += fabs(error);
    r->signed_sum += error;
    ++r->count;
}

/* A fixed sequence. */
static double uniform(double lo, double hi)
{
    static uint64_t state = 88172645463325252u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return lo + (hi - lo) * (double)(state >> 11) / 9007199254740992.0;
}

/* ---- thin film: the talk's one thickness, all angles, some more of them at grazing ------------ */

static film_input film_of_talk(int i, double f0)
{
    film_input f;
    double t = uniform(0.0, 1.0), c = uniform(0.0, 1.0);
    f.cosine = (float)(i % 5 ? c : c * c * c + 1e-4 * (1.0 - c));
    f.outer = 1.0f;
    f.ior = (float)(2.0 - t);
    f.nm = (float)(1500.0 * t / (2.0 - t));
    f.f0 = (float)f0;
    return f;
}

static void films(void)
{
    typedef hdrp_v3 film_function(float, float, float, float, hdrp_v3);
    static const char* const names[] = {"talk", "hdrp_brdf_film_fast", "hdrp_brdf_film",
                                        "hdrp_brdf_film_exact"};
    static const char* const quantities[] = {"F0 0.04", "F0 0.2", "F0 0.5", "F0 0.9"};
    static const double f0s[] = {0.04, 0.2, 0.5, 0.9};
    film_function* forms[] = {published_film, hdrp_brdf_film_fast, hdrp_brdf_film,
                              hdrp_brdf_film_exact};
    for (int k = 0; k < 4; ++k) {
        row* first = &rows[row_count];
        for (int form = 0; form < 4; ++form) {
            add_row("iridescence", names[form], quantities[k], "absolute");
        }
        for (int i = 0; i < 4000; ++i) {
            double reference[3];
            film_input in = film_of_talk(i, f0s[k]);
            reference_color(in, reference);
            for (int form = 0; form < 4; ++form) {
                hdrp_v3 m = forms[form](in.cosine, in.outer, in.ior, in.nm, hdrp_v3_splat(in.f0));
                add_error(&first[form], color_difference(m, reference));
            }
        }
    }
}

/* ---- directional albedo: every view and roughness, evenly ------------------------------------- */

static void fgds(void)
{
    enum { SIZE = 64, STEPS = 48 };
    static hdrp_brdf_fgd table[SIZE * SIZE];
    static bq_point points[BQ_MAX_POINTS];
    static const char* const names[] = {"Karis 2014", "hdrp_brdf_fgd_fast", "hdrp_brdf_fgd_lookup",
                                        "hdrp_brdf_fgd_integrate"};
    bq_rule rule = bq_make(16, 12);
    row* first = &rows[row_count];
    hdrp_brdf_fgd_bake_rows(table, SIZE, 0u, SIZE);
    for (int form = 0; form < 4; ++form) {
        add_row("FGD", names[form], "albedo and Schlick term", "absolute");
    }
    for (int form = 0; form < 4; ++form) {
        add_row("FGD", names[form], "reflectance at F0 0.04", "absolute");
    }
    for (int i = 0; i < STEPS * STEPS; ++i) {
        float p = ((float)(i / STEPS) + 0.5f) / (float)STEPS;
        float c = ((float)(i % STEPS) + 0.5f) / (float)STEPS;
        double alpha = fmax((double)p * (double)p, (double)HDRP_ALPHA_MIN);
        bq_fgd r = bq_integrate_fgd(&rule, (double)c, alpha, points);
        hdrp_brdf_fgd m[4] = {published_fgd(c, p), hdrp_brdf_fgd_fast(c, p),
                              hdrp_brdf_fgd_lookup(table, SIZE, c, p),
                              hdrp_brdf_fgd_integrate(c, p)};
        for (int form = 0; form < 4; ++form) {
            double albedo = (double)m[form].albedo - r.albedo;
            double schlick = (double)m[form].schlick - r.schlick;
            add_error(&first[form], fmax(fabs(albedo), fabs(schlick)));
            add_error(&first[4 + form], fabs(0.04 * albedo + 0.96 * schlick));
        }
    }
}

/* ---- small floats: normal numbers, every exponent as often ------------------------------------ */

static void small_floats(void)
{
    row* r11_cut = add_row("small floats", "truncated", "6 bits of mantissa", "relative");
    row* r11 =
        add_row("small floats", "hdrp_pack_r11g11b10f_from_rgb", "6 bits of mantissa", "relative");
    row* b10_cut = add_row("small floats", "truncated", "5 bits of mantissa", "relative");
    row* b10 =
        add_row("small floats", "hdrp_pack_r11g11b10f_from_rgb", "5 bits of mantissa", "relative");
    row* half_cut = add_row("small floats", "truncated", "10 bits of mantissa", "relative");
    row* half =
        add_row("small floats", "hdrp_pack_half_from_float", "10 bits of mantissa", "relative");
    row* all[] = {r11_cut, r11, b10_cut, b10, half_cut, half};
    for (int k = 0; k < 6; ++k) {
        all[k]->biased = true;
    }
    for (int i = 0; i < 400000; ++i) {
        /* Mantissas evenly, as in a smooth gradient. */
        float x = ldexpf((float)uniform(1.0, 2.0), (int)uniform(-14.0, 15.0));
        double d = (double)x;
        hdrp_v3 rgb =
            hdrp_pack_rgb_from_r11g11b10f(hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_splat(x)));
        float h = hdrp_pack_float_from_half(hdrp_pack_half_from_float(x));
        add_error(r11_cut, ((double)published_truncated(x, 17u) - d) / d);
        add_error(b10_cut, ((double)published_truncated(x, 18u) - d) / d);
        add_error(half_cut, ((double)published_truncated(x, 13u) - d) / d);
        add_error(r11, ((double)rgb.x - d) / d);
        add_error(b10, ((double)rgb.z - d) / d);
        add_error(half, ((double)h - d) / d);
    }
}

static void arc_cosines(void)
{
    static const char* const names[] = {"Abramowitz and Stegun 1964", "hdrp_acos_fast",
                                        "hdrp_acos_exact"};
    float (*forms[])(float) = {published_acos, hdrp_acos_fast, hdrp_acos_exact};
    for (int form = 0; form < 3; ++form) {
        row* r = add_row("acos", names[form], "angle", "absolute");
        r->biased = true;
        for (int i = 0; i <= 100000; ++i) {
            float x = (float)i / 100000.0f;
            add_error(r, (double)forms[form](x) - acos((double)x));
        }
    }
}

/* ---- the table -------------------------------------------------------------------------------- */

static void format(const row* r, char* out, size_t size)
{
    int used = snprintf(out, size, "%s,%s,%s,%s,%.3g,%.3g,", r->topic, r->form, r->quantity,
                        r->unit, r->max, r->sum / (double)r->count);
    if (r->biased) {
        double bias = r->signed_sum / (double)r->count;
        snprintf(out + used, size - (size_t)used, "%.2g", fabs(bias) < 1e-4 * r->max ? 0.0 : bias);
    }
}

static bool close_to(double measured, double recorded, double floor)
{
    return fabs(measured - recorded) <= 0.02 * fabs(recorded) + floor;
}

static int check_row(const row* r, const char* line)
{
    char start[256], text[256];
    double max = -1.0, mean = -1.0, bias = 0.0;
    size_t length = (size_t)snprintf(start, sizeof start, "%s,%s,%s,%s,", r->topic, r->form,
                                     r->quantity, r->unit);
    bool good =
        strncmp(line, start, length) == 0 &&
        sscanf(line + length, "%lf,%lf,%lf", &max, &mean, &bias) >= 2 &&
        close_to(r->max, max, 1e-9) && close_to(r->sum / (double)r->count, mean, 1e-9) &&
        (!r->biased || close_to(r->signed_sum / (double)r->count, bias, 0.05 * mean + 1e-9));
    if (!good) {
        format(r, text, sizeof text);
        printf("measured %s\nrecorded %s", text, line);
    }
    return good ? 0 : 1;
}

static int check(const char* path)
{
    char line[256];
    int wrong = 0, i = 0;
    FILE* file = fopen(path, "r");
    if (!file || !fgets(line, sizeof line, file) ||
        strncmp(line, HEADING "\n", sizeof HEADING) != 0) {
        printf("%s is not the table\n", path);
        return 1;
    }
    for (; fgets(line, sizeof line, file); ++i) {
        wrong += i < row_count ? check_row(&rows[i], line) : 1;
    }
    fclose(file);
    return wrong + (i == row_count ? 0 : 1);
}

/* The largest and the mean error of one form against those of another, of the same quantity. */
static int check_ratio(const char* form, const char* other, double most)
{
    int wrong = 0;
    for (int i = 0; i < row_count; ++i) {
        for (int k = 0; k < row_count; ++k) {
            const row *a = &rows[i], *b = &rows[k];
            if (strcmp(a->form, form) == 0 && strcmp(b->form, other) == 0 &&
                strcmp(a->quantity, b->quantity) == 0 &&
                (a->max > most * b->max || a->sum > most * b->sum)) {
                printf("%s is not within %g of %s: %s\n", form, most, other, a->quantity);
                ++wrong;
            }
        }
    }
    return wrong;
}

int main(int argc, char** argv)
{
    int wrong = 0;
    films();
    fgds();
    small_floats();
    arc_cosines();
    if (argc == 3 && strcmp(argv[1], "--check") == 0) {
        wrong = check(argv[2]) + check_ratio("hdrp_brdf_film", "talk", 0.5) +
                check_ratio("hdrp_brdf_film_exact", "hdrp_brdf_film", 0.5) +
                check_ratio("hdrp_brdf_fgd_fast", "Karis 2014", 0.1) +
                check_ratio("hdrp_pack_r11g11b10f_from_rgb", "truncated", 0.51) +
                check_ratio("hdrp_acos_fast", "Abramowitz and Stegun 1964", 0.1);
        printf("%d rows, %d wrong\n", row_count, wrong);
        return wrong ? 1 : 0;
    }
    printf("%s\n", HEADING);
    for (int i = 0; i < row_count; ++i) {
        char text[256];
        format(&rows[i], text, sizeof text);
        printf("%s\n", text);
    }
    return 0;
}
