// SPDX-License-Identifier: MIT
// Whether a written JSON text is the read one with insertions: every member, element, number text,
// key, and gap between them at its place, byte for byte. Elements that nothing reads any more go.
#ifndef TEXT_CHECK_H
#define TEXT_CHECK_H

#include <stdbool.h>
#include <stddef.h>

/// Whether the value of `name` (the last member name on the path to it) may differ.
typedef bool may_differ_fn(const char *name, size_t depth);

/// Fails the test at the first byte that differs where it may not. @return elements that are gone
size_t assert_text_kept(const char *old_text, size_t old_size, const char *new_text,
                        size_t new_size, may_differ_fn *may_differ);

/// What a patch may change: references to accessors, materials and meshes, lengths, the map.
bool patch_may_change(const char *name, size_t depth);

#endif
