// SPDX-License-Identifier: MIT
// Name patterns: each element, lists, UTF-8, and what is malformed.
#include "test_support.h"

#include "base/glob.h"

#include <stdlib.h>

static bool match(const char *pattern, const char *name)
{
    return alpi_glob_match(pattern, strlen(pattern), name);
}

TEST(each_element_matches_what_it_says)
{
    assert_true(match("chair", "chair"));
    assert_false(match("chair", "chairs"));
    assert_false(match("chair", "chai"));
    assert_false(match("chair", "Chair")); // as it is written
    assert_true(match("*", ""));
    assert_true(match("**", "anything"));
    assert_true(match("", ""));
    assert_false(match("", "a"));
    assert_false(match("?", ""));
    assert_true(match("wall_??", "wall_07"));
    assert_false(match("wall_??", "wall_7"));
    assert_true(match("*.00[1-3]", "lamp.002"));
    assert_false(match("*.00[1-3]", "lamp.004"));
    assert_true(match("[!a-c]x", "dx"));
    assert_true(match("[^a-c]x", "dx"));
    assert_false(match("[!a-c]x", "bx"));
    assert_true(match("[]]", "]"));
    assert_true(match("[a-]", "-"));
    assert_true(match("[\\]a]", "]"));
    assert_true(match("\\*", "*"));
    assert_false(match("\\*", "a"));
    assert_true(match("a*b*c", "a-b-b-c"));
    assert_false(match("a*b*c", "a-b-b"));
    assert_true(match("*ab", "aab")); // the star must give back what it took first
}

TEST(characters_are_code_points)
{
    assert_true(match("?", "ü"));
    assert_true(match("B?ch", "Büch"));
    assert_true(match("木?", "木製"));
    assert_false(match("??", "ü"));
    assert_true(match("[ä-ü]", "ö"));
    assert_false(match("[ä-ü]", "z"));
    assert_true(match("[🪑a]", "🪑"));
    assert_true(match("*製", "木製"));
    assert_true(match("?", "\xff")); // a byte that is no UTF-8 is one character
    assert_true(match("\xff", "\xff"));
    assert_false(match("\xff", "\xfe"));
    assert_false(match("ÿ", "\xff"));
    assert_true(match("??", "\xc3x")); // a sequence that breaks off
}

TEST(what_is_malformed_stands_for_itself)
{
    assert_true(match("[", "["));
    assert_true(match("a[b", "a[b"));
    assert_true(match("[]", "[]"));
    assert_true(match("[!", "[!"));
    assert_true(match("a\\", "a\\"));
    assert_false(match("[z-a]", "m")); // an empty range
}

TEST(lists_are_parted_at_commas)
{
    assert_int_equal(alpi_glob_length("a,b"), 1);
    assert_int_equal(alpi_glob_length("ab"), 2);
    assert_int_equal(alpi_glob_length(""), 0);
    assert_int_equal(alpi_glob_length(",a"), 0);
    assert_int_equal(alpi_glob_length("a\\,b,c"), 4);
    assert_int_equal(alpi_glob_length("[,]x,c"), 4);
    assert_int_equal(alpi_glob_length("[a,c"), 2); // never closed
    assert_int_equal(alpi_glob_length("a\\"), 2);
    assert_true(match("a\\,b", "a,b"));
}

TEST(stars_cost_no_more_than_the_product)
{
    enum { SIZE = 20000 };
    char *name = malloc(SIZE + 1);
    assert_non_null(name);
    memset(name, 'a', SIZE);
    name[SIZE] = '\0';
    assert_false(match("*a*a*a*a*a*a*a*a*b", name)); // would never end if every star were tried
    free(name);
}
