/* The JSON reader: what RFC 8259 allows and nothing else. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "json.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool reads(const char* text)
{
    rd_json_document d;
    char why[160];
    bool ok = rd_json_read(&d, text, strlen(text), why);
    assert_true(ok || why[0] != '\0');
    rd_json_free(&d);
    return ok;
}

static void accepts_every_kind_of_value(void** state)
{
    static const char* const good[] = {"{}",
                                       "[]",
                                       " [ ] \n",
                                       "null",
                                       "true",
                                       "-0",
                                       "0.5e-3",
                                       "1E+2",
                                       "\"\"",
                                       "[1,2,[3,{\"a\":[]}]]",
                                       "{\"a\":1,\"b\":{\"a\":2}}",
                                       "\"\\u00e9\\ud83d\\ude00\\n\\/\"",
                                       "\"\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80\""};
    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; ++i) {
        assert_true(reads(good[i]));
    }
}

static void refuses_everything_else(void** state)
{
    static const char* const bad[] = {"",
                                      "{",
                                      "[1,]",
                                      "{\"a\"}",
                                      "{\"a\":1,}",
                                      "{a:1}",
                                      "01",
                                      "+1",
                                      ".5",
                                      "1.",
                                      "1e",
                                      "1e999",
                                      "NaN",
                                      "Infinity",
                                      "nul",
                                      "'a'",
                                      "\"a",
                                      "\"\t\"",
                                      "\"\\x\"",
                                      "\"\\ud800\"",
                                      "\"\\u12g4\"",
                                      "\"\\u0000\"",
                                      "[] []",
                                      "{\"a\":1,\"a\":2}",
                                      "\"\xc3\"",
                                      "\"\xff\"",
                                      "\"\xc0\xaf\"",
                                      "\"\xed\xa0\x80\"",
                                      "\xef\xbb\xbf{}"};
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        assert_false(reads(bad[i]));
    }
}

static void bounds_the_depth(void** state)
{
    char text[2049];
    (void)state;
    memset(text, '[', 1024);
    memset(text + 1024, ']', 1024);
    text[2048] = '\0';
    assert_false(reads(text));
    assert_true(reads(text + 1024 - 60) == false); /* 60 open, 1024 closed */
    text[1024 + 60] = '\0';
    assert_true(reads(text + 1024 - 60));
}

static void keeps_strings_and_numbers(void** state)
{
    static const char text[] = "{\"n\":-12.5,\"i\":3,\"s\":\"a\\u00e9\\\"b\",\"l\":[4,5,6]}";
    rd_json_document d;
    char why[160];
    (void)state;
    assert_true(rd_json_read(&d, text, strlen(text), why));
    assert_true(rd_json_number(d.root, "n", 0) == -12.5);
    assert_false(rd_json_get(d.root, "n")->is_integer);
    assert_true(rd_json_get(d.root, "i")->is_integer);
    assert_string_equal(rd_json_get(d.root, "s")->string, "a\xc3\xa9\"b");
    assert_true(rd_json_at(rd_json_get(d.root, "l"), 2)->number == 6);
    assert_null(rd_json_at(rd_json_get(d.root, "l"), 3));
    assert_null(rd_json_get(d.root, "missing"));
    assert_null(rd_json_get(NULL, "n"));
    rd_json_free(&d);
}

static void reads_a_text_of_many_values(void** state)
{
    const size_t count = 20000;
    char* text = (char*)malloc(count * 2 + 2);
    rd_json_document d;
    char why[160];
    (void)state;
    text[0] = '[';
    for (size_t i = 0; i < count; ++i) {
        memcpy(text + 1 + i * 2, i + 1 < count ? "7," : "7]", 2);
    }
    assert_true(rd_json_read(&d, text, count * 2 + 1, why));
    assert_int_equal(d.root->count, count);
    rd_json_free(&d);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(accepts_every_kind_of_value),
        cmocka_unit_test(refuses_everything_else),
        cmocka_unit_test(bounds_the_depth),
        cmocka_unit_test(keeps_strings_and_numbers),
        cmocka_unit_test(reads_a_text_of_many_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
