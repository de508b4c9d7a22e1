// SPDX-License-Identifier: MIT
// What a page of HTML is held to: well-formed, self-contained; and the pictures in it.
#ifndef PAGE_CHECK_H
#define PAGE_CHECK_H

#include "base/image.h"
#include "test_support.h"

#define ASSERT_HAS(text, wanted) assert_non_null(strstr((text), (wanted)))

/// How often `wanted` stands in it.
int page_count_of(const char *text, const char *wanted);

/// Every tag is closed in order, & begins a reference, and the bytes are UTF-8 without controls.
void page_check_form(const char *text);

/// Nothing is loaded and nothing runs: every picture is in the page, references stay inside.
void page_check_self_contained(const char *text);

/// The picture, RGBA, whose <img> has this alternative text; the caller destroys it.
alp_image *page_find_picture(alp_context *context, const char *text, const char *alt);

#endif
