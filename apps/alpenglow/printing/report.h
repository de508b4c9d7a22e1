// SPDX-License-Identifier: MIT
// The --json report of a bake.
#ifndef COMMAND_REPORT_H
#define COMMAND_REPORT_H

#include "session.h"

#include <jansson.h>

/// The document, or NULL when memory ran out. The caller releases it.
/// @param diagnosis of the session's scene
json_t *report_make(const session *s, const alp_lightmap *lightmap, const alp_bake_report *report,
                    const alp_diagnosis *diagnosis);

/// [{"code", "object", "text"}]
json_t *report_warnings(const message_log *messages);

/// "charts", "kept", "blend", "vertex".
const char *atlas_mode_name(alp_atlas_mode mode);

#endif
