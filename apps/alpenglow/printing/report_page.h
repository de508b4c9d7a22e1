// SPDX-License-Identifier: MIT
// The --report page of a bake.
#ifndef COMMAND_REPORT_PAGE_H
#define COMMAND_REPORT_PAGE_H

#include "session.h"

/// Checks before long work that the page can be written; it must not overwrite the scene.
/// @return EXIT_DONE, or EXIT_USAGE or EXIT_FAILED after a message
int report_page_check(const command_line *arguments);

/// Writes the page. @param diagnosis of the session's scene   @return EXIT_DONE, or EXIT_FAILED
/// after a message
int report_page_write(session *s, const alp_lightmap *lightmap, const alp_bake_report *report,
                      const alp_diagnosis *diagnosis, const command_line *arguments);

#endif
