// SPDX-License-Identifier: MIT
// The link to the page of alpenglow web in a report of bake --report. Both lie in one folder.
#ifndef COMMAND_REPORT_LINK_H
#define COMMAND_REPORT_LINK_H

#include <stdbool.h>

/// Whether the file is a report with a place for the link. @return EXIT_DONE, or EXIT_FAILED after
/// a message
int report_link_check(const char *report);
/// Whether a report states another hash of its input. False if it states none.
/// @param hash 16 hexadecimal digits
bool report_is_of_other(const char *report, const char *hash);
/// Puts a link into a report, or replaces the one there. The report is written under a temporary
/// name and renamed when complete.
/// @param page its folder is ignored   @return EXIT_DONE, or EXIT_FAILED after a message
int report_link_write(const char *report, const char *page);

/// The page that a new report should link: the one that the report of this name links, else the one
/// with the name of the baked file, OUT.html for OUT.glb. Pages must lie beside the report.
/// @param report may be absent   @param baked NULL: none
/// @return name without folder, malloc'ed; NULL: there is no such page
char *report_link_find(const char *report, const char *baked);

#endif
