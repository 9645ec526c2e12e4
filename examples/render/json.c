#include "json.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_DEPTH   64
#define MAX_NODES   (1u << 22)
#define MAX_MEMBERS 1024 /* of one object: the search for duplicates is quadratic */
#define BLOCK_NODES 4096

typedef struct node_block {
    struct node_block* next;
    rd_json nodes[BLOCK_NODES];
} node_block;

typedef struct reader {
    rd_json_document* doc;
    const char* begin;
    const char* at;
    const char* end;
    char* text; /* where the next string goes */
    uint32_t node_count;
    char* why;
} reader;

static bool fail(reader* r, const char* what)
{
    if (!r->why[0]) {
        snprintf(r->why, 160, "%s at byte %zu of the JSON text", what, (size_t)(r->at - r->begin));
    }
    return false;
}

static rd_json* new_node(reader* r)
{
    uint32_t i = r->node_count % BLOCK_NODES;
    node_block* b = (node_block*)r->doc->blocks;
    if (r->node_count >= MAX_NODES) {
        fail(r, "too many values");
        return NULL;
    }
    if (i == 0) {
        b = (node_block*)calloc(1, sizeof *b);
        if (!b) {
            fail(r, "out of memory");
            return NULL;
        }
        b->next = (node_block*)r->doc->blocks;
        r->doc->blocks = b;
    }
    ++r->node_count;
    return &b->nodes[i];
}

static void skip_space(reader* r)
{
    while (r->at < r->end &&
           (*r->at == ' ' || *r->at == '\t' || *r->at == '\n' || *r->at == '\r')) {
        ++r->at;
    }
}

static bool take(reader* r, char c)
{
    if (r->at < r->end && *r->at == c) {
        ++r->at;
        return true;
    }
    return false;
}

static bool read_hex4(reader* r, uint32_t* out)
{
    uint32_t u = 0;
    for (int i = 0; i < 4; ++i, ++r->at) {
        char c = r->at < r->end ? *r->at : '\0';
        uint32_t digit;
        if (c >= '0' && c <= '9') {
            digit = (uint32_t)(c - '0');
        } else if (c >= 'a' && c <= 'f') {
            digit = (uint32_t)(c - 'a') + 10;
        } else if (c >= 'A' && c <= 'F') {
            digit = (uint32_t)(c - 'A') + 10;
        } else {
            return fail(r, "bad \\u escape");
        }
        u = u * 16 + digit;
    }
    *out = u;
    return true;
}

static void put_utf8(reader* r, uint32_t u)
{
    if (u < 0x80) {
        *r->text++ = (char)u;
    } else if (u < 0x800) {
        *r->text++ = (char)(0xc0 | (u >> 6));
        *r->text++ = (char)(0x80 | (u & 63));
    } else if (u < 0x10000) {
        *r->text++ = (char)(0xe0 | (u >> 12));
        *r->text++ = (char)(0x80 | ((u >> 6) & 63));
        *r->text++ = (char)(0x80 | (u & 63));
    } else {
        *r->text++ = (char)(0xf0 | (u >> 18));
        *r->text++ = (char)(0x80 | ((u >> 12) & 63));
        *r->text++ = (char)(0x80 | ((u >> 6) & 63));
        *r->text++ = (char)(0x80 | (u & 63));
    }
}

static bool read_unicode_escape(reader* r)
{
    uint32_t u, low;
    if (!read_hex4(r, &u)) {
        return false;
    }
    if (u >= 0xd800 && u < 0xdc00) {
        if (!take(r, '\\') || !take(r, 'u') || !read_hex4(r, &low) || low < 0xdc00 ||
            low > 0xdfff) {
            return fail(r, "unpaired surrogate");
        }
        u = 0x10000 + ((u - 0xd800) << 10) + (low - 0xdc00);
    } else if ((u >= 0xdc00 && u <= 0xdfff) || u == 0) {
        return fail(r, "unusable \\u escape");
    }
    put_utf8(r, u);
    return true;
}

static bool read_escape(reader* r)
{
    static const char from[] = "\"\\/bfnrt";
    static const char to[] = "\"\\/\b\f\n\r\t";
    const char* hit;
    if (r->at >= r->end) {
        return fail(r, "unterminated string");
    }
    if (take(r, 'u')) {
        return read_unicode_escape(r);
    }
    hit = *r->at ? strchr(from, *r->at) : NULL;
    if (!hit) {
        return fail(r, "bad escape");
    }
    *r->text++ = to[hit - from];
    ++r->at;
    return true;
}

/* Copies one multi-byte UTF-8 sequence; overlong forms and surrogates are refused. */
static bool read_utf8(reader* r)
{
    unsigned char c = (unsigned char)*r->at;
    int extra = c >= 0xf0 ? 3 : c >= 0xe0 ? 2 : 1;
    uint32_t u = c & (0x3fu >> extra);
    static const uint32_t lowest[4] = {0, 0x80, 0x800, 0x10000};
    if (c < 0xc2 || c > 0xf4 || r->end - r->at <= extra) {
        return fail(r, "invalid UTF-8");
    }
    for (int i = 1; i <= extra; ++i) {
        unsigned char d = (unsigned char)r->at[i];
        if ((d & 0xc0) != 0x80) {
            return fail(r, "invalid UTF-8");
        }
        u = (u << 6) | (d & 63u);
    }
    if (u < lowest[extra] || u > 0x10ffff || (u >= 0xd800 && u <= 0xdfff)) {
        return fail(r, "invalid UTF-8");
    }
    memcpy(r->text, r->at, (size_t)extra + 1);
    r->text += extra + 1;
    r->at += extra + 1;
    return true;
}

static const char* read_string(reader* r)
{
    const char* out = r->text;
    if (!take(r, '"')) {
        fail(r, "expected a string");
        return NULL;
    }
    while (r->at < r->end && *r->at != '"') {
        unsigned char c = (unsigned char)*r->at;
        bool ok = true;
        if (c < 0x20) {
            ok = fail(r, "control character in a string");
        } else if (c == '\\') {
            ++r->at;
            ok = read_escape(r);
        } else if (c >= 0x80) {
            ok = read_utf8(r);
        } else {
            *r->text++ = *r->at++;
        }
        if (!ok) {
            return NULL;
        }
    }
    if (!take(r, '"')) {
        fail(r, "unterminated string");
        return NULL;
    }
    *r->text++ = '\0';
    return out;
}

static bool skip_digits(reader* r)
{
    const char* from = r->at;
    while (r->at < r->end && *r->at >= '0' && *r->at <= '9') {
        ++r->at;
    }
    return r->at > from;
}

static bool read_number(reader* r, rd_json* n)
{
    char buffer[64];
    const char* from = r->at;
    size_t length;
    n->type = RD_JSON_NUMBER;
    n->is_integer = true;
    take(r, '-');
    if (!take(r, '0') && !skip_digits(r)) {
        return fail(r, "expected a value");
    }
    if (take(r, '.')) {
        n->is_integer = false;
        if (!skip_digits(r)) {
            return fail(r, "bad number");
        }
    }
    if (take(r, 'e') || take(r, 'E')) {
        n->is_integer = false;
        (void)(take(r, '+') || take(r, '-'));
        if (!skip_digits(r)) {
            return fail(r, "bad number");
        }
    }
    length = (size_t)(r->at - from);
    if (length >= sizeof buffer) {
        return fail(r, "number with too many digits");
    }
    memcpy(buffer, from, length);
    buffer[length] = '\0';
    n->number = strtod(buffer, NULL);
    return isfinite(n->number) ? true : fail(r, "number out of range");
}

static bool read_word(reader* r, rd_json* n)
{
    static const struct {
        const char* word;
        rd_json_type type;
        double number;
    } words[] = {
        {"true", RD_JSON_BOOL, 1.0}, {"false", RD_JSON_BOOL, 0.0}, {"null", RD_JSON_NULL, 0.0}};
    for (size_t i = 0; i < 3; ++i) {
        size_t length = strlen(words[i].word);
        if ((size_t)(r->end - r->at) >= length && !memcmp(r->at, words[i].word, length)) {
            n->type = words[i].type;
            n->number = words[i].number;
            r->at += length;
            return true;
        }
    }
    return fail(r, "expected a value");
}

static bool is_duplicate(const rd_json* object, const char* key)
{
    for (const rd_json* m = object->first; m; m = m->next) {
        if (!strcmp(m->key, key)) {
            return true;
        }
    }
    return false;
}

static bool read_key(reader* r, const rd_json* object, const char** key)
{
    *key = read_string(r);
    if (!*key) {
        return false;
    }
    if (is_duplicate(object, *key)) {
        return fail(r, "duplicate key");
    }
    if (object->count >= MAX_MEMBERS) {
        return fail(r, "object with too many members");
    }
    skip_space(r);
    if (!take(r, ':')) {
        return fail(r, "expected ':'");
    }
    skip_space(r);
    return true;
}

static rd_json* read_value(reader* r, int depth);

static bool read_container(reader* r, rd_json* n, char close, int depth)
{
    rd_json** tail = &n->first;
    ++r->at;
    skip_space(r);
    if (take(r, close)) {
        return true;
    }
    if (depth >= MAX_DEPTH) {
        return fail(r, "nested too deeply");
    }
    do {
        const char* key = NULL;
        skip_space(r);
        if (n->type == RD_JSON_OBJECT && !read_key(r, n, &key)) {
            return false;
        }
        *tail = read_value(r, depth + 1);
        if (!*tail) {
            return false;
        }
        (*tail)->key = key;
        tail = &(*tail)->next;
        ++n->count;
        skip_space(r);
    } while (take(r, ','));
    return take(r, close) ? true : fail(r, "expected ',' or a closing bracket");
}

static rd_json* read_value(reader* r, int depth)
{
    rd_json* n = new_node(r);
    bool ok;
    char c = r->at < r->end ? *r->at : '\0';
    if (!n) {
        return NULL;
    }
    if (c == '{') {
        n->type = RD_JSON_OBJECT;
        ok = read_container(r, n, '}', depth);
    } else if (c == '[') {
        n->type = RD_JSON_ARRAY;
        ok = read_container(r, n, ']', depth);
    } else if (c == '"') {
        n->type = RD_JSON_STRING;
        n->string = read_string(r);
        ok = n->string != NULL;
    } else if (c == '-' || (c >= '0' && c <= '9')) {
        ok = read_number(r, n);
    } else {
        ok = read_word(r, n);
    }
    return ok ? n : NULL;
}

bool rd_json_read(rd_json_document* doc, const char* text, size_t size, char why[160])
{
    reader r;
    memset(doc, 0, sizeof *doc);
    memset(&r, 0, sizeof r);
    why[0] = '\0';
    r.doc = doc;
    r.begin = r.at = text;
    r.end = text + size;
    r.why = why;
    /* A decoded string never takes more than its quoted form, terminator included. */
    doc->text = r.text = (char*)malloc(size + 1);
    if (!doc->text) {
        return fail(&r, "out of memory");
    }
    skip_space(&r);
    doc->root = read_value(&r, 0);
    skip_space(&r);
    if (doc->root && r.at != r.end) {
        fail(&r, "text after the end");
        doc->root = NULL;
    }
    if (!doc->root) {
        rd_json_free(doc);
        return false;
    }
    return true;
}

void rd_json_free(rd_json_document* doc)
{
    node_block* b = (node_block*)doc->blocks;
    while (b) {
        node_block* next = b->next;
        free(b);
        b = next;
    }
    free(doc->text);
    memset(doc, 0, sizeof *doc);
}

const rd_json* rd_json_get(const rd_json* object, const char* key)
{
    if (!object || object->type != RD_JSON_OBJECT) {
        return NULL;
    }
    for (const rd_json* m = object->first; m; m = m->next) {
        if (!strcmp(m->key, key)) {
            return m;
        }
    }
    return NULL;
}

const rd_json* rd_json_at(const rd_json* array, uint32_t i)
{
    const rd_json* e = array ? array->first : NULL;
    while (e && i--) {
        e = e->next;
    }
    return e;
}

double rd_json_number(const rd_json* object, const char* key, double fallback)
{
    const rd_json* m = rd_json_get(object, key);
    return m && m->type == RD_JSON_NUMBER ? m->number : fallback;
}
