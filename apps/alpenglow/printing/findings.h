// SPDX-License-Identifier: MIT
// The doctor's findings, as text and as JSON.
#ifndef COMMAND_FINDINGS_H
#define COMMAND_FINDINGS_H

#include "session.h"

#include <jansson.h>
#include <stdio.h>

/// Diagnoses the session's scene, with its warnings so far.
/// @param baked NULL, or the report of a bake: a scene without light is then a warning if light was
///              baked, and the diagnosis cannot be cancelled
/// @param diagnosis out: NULL unless EXIT_DONE   @return an exit code, after a message
int findings_look(session *s, const alp_bake_report *baked, alp_diagnosis **diagnosis);

/// Prints the table of texture coordinate sets, if there are any.
void findings_print_uv_sets(const alp_diagnosis *diagnosis);
/// Prints findings by severity, the first ones of each kind.
void findings_print(const alp_diagnosis *diagnosis);

/// [{"code", "severity", "place", "index", "name", "count", "value", "what", "seen", "todo",
///   "spot"}]
json_t *findings_json(const alp_diagnosis *diagnosis);
/// [{"set", "surfaces", …, "holds_bake", "reason"}]
json_t *findings_uv_sets_json(const alp_diagnosis *diagnosis);

#endif
