// SPDX-License-Identifier: MIT
// Spans of JSON values: found where they are, escapes and odd white space and all; edits of a text.
#include "test_support.h"

#include "formats/text/json_spans.h"
#include "formats/text/text_edits.h"

#include <stdlib.h>

static alpi_json_span all(const char *text)
{
    alpi_json_span span;
    assert_true(alpi_json_value(text, 0, strlen(text), &span));
    return span;
}

static void require_at(const char *text, const char *path, const char *expected)
{
    alpi_json_span span;
    if (!alpi_json_at(text, all(text), path, &span)) {
        fail_msg("%s is not found in %s", path, text);
    }
    assert_int_equal(span.end - span.begin, strlen(expected));
    assert_memory_equal(text + span.begin, expected, strlen(expected));
}

TEST(values_are_found_by_path)
{
    const char *text =
        " {\"a\" : [ 1.0e0,\t{\"b\":\"}]\\\"\"} , [] ,-1E+2\n], \"c\":{\"d\":null } }\r\n";
    require_at(text, "",
               "{\"a\" : [ 1.0e0,\t{\"b\":\"}]\\\"\"} , [] ,-1E+2\n], \"c\":{\"d\":null } }");
    require_at(text, "a/0", "1.0e0");
    require_at(text, "a/1", "{\"b\":\"}]\\\"\"}");
    require_at(text, "a/1/b", "\"}]\\\"\"");
    require_at(text, "a/2", "[]");
    require_at(text, "a/3", "-1E+2");
    require_at(text, "c/d", "null");
    alpi_json_span span;
    assert_false(alpi_json_at(text, all(text), "a/4", &span));
    assert_false(alpi_json_at(text, all(text), "a/b", &span));
    assert_false(alpi_json_at(text, all(text), "d", &span));
    assert_false(alpi_json_at(text, all(text), "c/0", &span));
}

TEST(texts_are_measured)
{
    static const struct {
        const char *text;
        alpi_json_size size;
    } cases[] = {{"", {0, 1, 0}},
                 {"{}", {1, 2, 1}},
                 {"{\"a,[{\":[1,{\"b\":\"\\\",}\"},[]]}", {4, 7, 3}},
                 {"}}]],,[[", {2, 5, 2}},
                 {"[\"", {1, 2, 1}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const alpi_json_size size = alpi_json_measure(cases[i].text, strlen(cases[i].text));
        assert_int_equal(size.containers, cases[i].size.containers);
        assert_int_equal(size.values, cases[i].size.values);
        assert_int_equal(size.depth, cases[i].size.depth);
    }
}

TEST(keys_may_be_escaped)
{
    require_at("{\"m\\u0065sh\":1}", "mesh", "1");
    require_at("{\"\\/a\\tb\":1,\"ab\":2}", "ab", "2");
    alpi_json_span span;
    const char *text = "{\"mesh\\u0000\":1,\"me\\u00e9\":2,\"\\\\mesh\":3,\"mes\":4,\"meshe\":5}";
    assert_false(alpi_json_find(text, all(text), "mesh", &span));
    const char *twice = "{\"a\":1,\"a\":2}";
    require_at(twice, "a", "2");
}

TEST(broken_text_stays_in_bounds)
{
    const char *whole = "{\"a\":[1,{\"b\\u0041\":\"x\\\"y\"}],\"c\":tru";
    for (size_t size = 0; size <= strlen(whole); size++) {
        char *cut = malloc(size + 1); // exact size: the address sanitizer sees every step too far
        assert_non_null(cut);
        memcpy(cut, whole, size);
        alpi_json_span span = {0, size}, found;
        alpi_json_at(cut, span, "a/1/bA", &found);
        alpi_json_at(cut, span, "c", &found);
        alpi_json_value(cut, 0, size, &found);
        free(cut);
    }
}

TEST(deep_nesting_needs_no_stack)
{
    enum { DEPTH = 1000000 };
    char *text = malloc(2 * DEPTH + 1);
    assert_non_null(text);
    memset(text, '[', DEPTH);
    memset(text + DEPTH, ']', DEPTH);
    text[2 * DEPTH] = '\0';
    alpi_json_span span = all(text);
    assert_int_equal(span.end, 2 * DEPTH);
    free(text);
}

/// Applies edits to `text` and compares.
static void require_edited(alpi_edits *edits, const char *expected)
{
    alpi_bytes out = alpi_bytes_create(edits->context);
    alpi_json_span whole = {0, strlen(edits->text)};
    ASSERT_OK(edits->context, alpi_edits_apply(edits, whole, &out));
    assert_string_equal((const char *)out.bytes, expected);
    alpi_bytes_destroy(&out);
    alpi_edits_destroy(edits);
}

TEST_WITH_CONTEXT(edits_keep_what_is_around_them, 1)
{
    const char *text = "{ \"a\" : { } , \"b\":[ 1 , 2 ]\n}";
    alpi_edits edits = alpi_edits_create(context, text);
    alpi_json_span a, b;
    assert_true(alpi_json_at(text, all(text), "a", &a));
    assert_true(alpi_json_at(text, all(text), "b", &b));
    alpi_edits_add(&edits, b, NULL, "3", 1);
    alpi_edits_add(&edits, b, NULL, "4", 1);
    alpi_edits_add(&edits, a, "x", "5", 1);
    alpi_edits_set_index(&edits, a, "y", 6);
    alpi_edits_add(&edits, all(text), "c", "7", 1);
    require_edited(&edits, "{ \"a\" : {\"x\":5,\"y\":6 } , \"b\":[ 1 , 2,3,4 ],\"c\":7\n}");
    edits = alpi_edits_create(context, text);
    alpi_edits_set(&edits, all(text), "a", "\"new\"", 5);
    require_edited(&edits, "{ \"a\" : \"new\" , \"b\":[ 1 , 2 ]\n}");
}

TEST_WITH_CONTEXT(members_are_removed_with_one_comma, 1)
{
    const char *text = "{\"a\":1, \"b\":2, \"c\":3}";
    const char *const names[] = {"a", "b", "c", "d"};
    const char *const results[] = {"{\"b\":2, \"c\":3}", "{\"a\":1, \"c\":3}", "{\"a\":1, \"b\":2}",
                                   text};
    for (size_t i = 0; i < 4; i++) {
        alpi_edits edits = alpi_edits_create(context, text);
        alpi_edits_remove(&edits, all(text), names[i]);
        require_edited(&edits, results[i]);
    }
    alpi_edits edits = alpi_edits_create(context, text);
    alpi_edits_remove(&edits, all(text), "c");
    alpi_edits_add(&edits, all(text), "e", "5", 1);
    require_edited(&edits, "{\"a\":1, \"b\":2,\"e\":5}");
    edits = alpi_edits_create(context, "{\"a\":1}");
    alpi_edits_remove(&edits, all("{\"a\":1}"), "a");
    require_edited(&edits, "{}");
}

TEST_WITH_CONTEXT(overlapping_edits_are_refused, 1)
{
    alpi_edits edits = alpi_edits_create(context, "[1,2]");
    alpi_edits_replace(&edits, (alpi_json_span){1, 4}, "x");
    alpi_edits_replace(&edits, (alpi_json_span){3, 4}, "y");
    alpi_bytes out = alpi_bytes_create(context);
    assert_int_equal(alpi_edits_apply(&edits, (alpi_json_span){0, 5}, &out),
                     ALP_ERROR_INVALID_DATA);
    alpi_bytes_destroy(&out);
    alpi_edits_destroy(&edits);
}

TEST_WITH_CONTEXT(strings_and_numbers_are_json, 1)
{
    alpi_bytes text = alpi_bytes_create(context);
    alpi_bytes_quote(&text, "a\"b\\c\n\xc3\xa9");
    alpi_bytes_number(&text, 0.1, 9);
    alpi_bytes_print(&text, " ");
    alpi_bytes_number(&text, 4294967295.0, 17);
    assert_string_equal((const char *)text.bytes, "\"a\\\"b\\\\c\\u000a\xc3\xa9\"0.1 4294967295");
    alpi_bytes_destroy(&text);
}
