/* A strict reader of JSON (RFC 8259): valid UTF-8, no duplicate keys, bounded depth and size.
 * glTF files are checked on this tree before a loader sees them. */
#ifndef RD_JSON_H
#define RD_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum rd_json_type {
    RD_JSON_NULL,
    RD_JSON_BOOL,
    RD_JSON_NUMBER,
    RD_JSON_STRING,
    RD_JSON_ARRAY,
    RD_JSON_OBJECT
} rd_json_type;

typedef struct rd_json {
    rd_json_type type;
    bool is_integer;    /* a number written without fraction and exponent */
    uint32_t count;     /* of members or elements */
    const char* key;    /* of a member, else NULL */
    const char* string; /* of a string, else NULL */
    double number;      /* of a number; 0 or 1 of a bool */
    struct rd_json* first;
    struct rd_json* next;
} rd_json;

typedef struct rd_json_document {
    rd_json* root;
    void* blocks; /* memory of the nodes */
    char* text;   /* memory of the strings */
} rd_json_document;

/* Reads text[0..size). On failure `why` (at least 160 bytes) says what and where, and the document
 * is empty. */
bool rd_json_read(rd_json_document* doc, const char* text, size_t size, char why[160]);
void rd_json_free(rd_json_document* doc);

/* The member of an object, or NULL; NULL objects have no members. */
const rd_json* rd_json_get(const rd_json* object, const char* key);
/* Element i of an array, or NULL. Linear in i: walk first and next in loops. */
const rd_json* rd_json_at(const rd_json* array, uint32_t i);
/* The number of a member, or fallback where it is absent. */
double rd_json_number(const rd_json* object, const char* key, double fallback);

#ifdef __cplusplus
}
#endif
#endif
