// SPDX-License-Identifier: MIT
// Lists that go by the order of an option's choices. These tests need no OpenGL.
#include "test_gl.h"

#include "shaders/bindings.h"

/// Number of choices of an option.
static int count_choices(const char *name)
{
    int count = 1;
    for (const char *at = option_find(COMMAND_VIEW, name, strlen(name))->choices; *at != '\0';
         at++) {
        count += *at == '|' ? 1 : 0;
    }
    return count;
}

/// Whether choice `number` of option `name` is a word.
static bool is_choice(const char *name, int number, const char *word)
{
    const char *at = option_find(COMMAND_VIEW, name, strlen(name))->choices;
    for (int i = 0; i < number && at != NULL; i++) {
        at = strchr(at, '|');
        at = at != NULL ? at + 1 : NULL;
    }
    const size_t length = strlen(word);
    return at != NULL && strncmp(at, word, length) == 0 &&
           (at[length] == '|' || at[length] == '\0');
}

TEST(modes_are_listed_as_choices_of_with)
{
    command_line line = {.command = COMMAND_VIEW};
    const int count = count_choices("--with");
    assert_int_equal(count_choices("--beside"), count);
    for (int i = 0; i < count; i++) {
        line.values[OPTION_WITH].choice = i;
        const char *name = view_mode_of(&line)->name;
        assert_non_null(name);
        assert_true(is_choice("--with", i, name));
        assert_true(is_choice("--beside", i, name));
    }
}

TEST(places_of_fields_are_listed_as_choices_of_read)
{
    assert_int_equal(count_choices("--read"), 3);
    assert_true(is_choice("--read", READ_PIXEL, "pixel"));
    assert_true(is_choice("--read", READ_VERTEX, "vertex"));
    assert_true(is_choice("--read", READ_OBJECT, "object"));
}
