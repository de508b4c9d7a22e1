// SPDX-License-Identifier: MIT
// The option --report of web: a link to the page in a report of bake --report.
#ifndef COMMAND_WEB_REPORT_H
#define COMMAND_WEB_REPORT_H

#include "options/options.h"
#include "web/web_scene.h"

/// Whether --report names a report of bake in the folder of the page, which can be written.
/// @return EXIT_DONE, also without --report, or EXIT_USAGE or EXIT_FAILED after a message
int web_report_check(const command_line *arguments);
/// Warns of a report of another bake's scene.
void web_report_compare(const command_line *arguments, const web_scene *scene,
                        message_log *messages);
/// Puts the link into the report, or replaces the one there. The report is written under a
/// temporary name and renamed when complete.
/// @return EXIT_DONE, also without --report, or EXIT_FAILED after a message
int web_report_write(const command_line *arguments);

#endif
