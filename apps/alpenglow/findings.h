// SPDX-License-Identifier: MIT
// What the doctor finds, as text and as JSON.
#ifndef COMMAND_FINDINGS_H
#define COMMAND_FINDINGS_H

#include "session.h"

#include <jansson.h>
#include <stdio.h>

/// Looks at the session's scene, with the warnings it heard so far.
/// @param baked NULL, or the bake that is to be told of: that there is no light is a warning then
///              where light was asked for, and nobody is asked whether to go on
/// @param diagnosis out: NULL unless EXIT_DONE   @return an exit code, after a message
int findings_look(session *s, const alp_bake_report *baked, alp_diagnosis **diagnosis);

/// The table of texture coordinate sets; nothing where there are none.
void findings_print_uv_sets(const alp_diagnosis *diagnosis);
/// Findings by severity, the first of each kind.
void findings_print(const alp_diagnosis *diagnosis);

/// [{"code", "severity", "place", "index", "name", "count", "value", "what", "seen", "todo",
///   "spot"}]
json_t *findings_json(const alp_diagnosis *diagnosis);
/// [{"set", "surfaces", …, "holds_bake", "reason"}]
json_t *findings_uv_sets_json(const alp_diagnosis *diagnosis);

#endif
