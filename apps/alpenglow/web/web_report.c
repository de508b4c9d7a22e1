// SPDX-License-Identifier: MIT
#include "web/web_report.h"

#include "output.h"
#include "printing/messages.h"
#include "web/report_link.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Whether both files lie in one folder.
static bool are_neighbours(const char *report, const char *page)
{
    const char *slash = strrchr(report, '/'), *last = strrchr(page, '/');
    const char *name = last == NULL ? page : last + 1;
    const int folder = slash == NULL ? 0 : (int)(slash + 1 - report);
    const size_t size = (size_t)folder + strlen(name) + 1;
    char *beside = allocate_or_exit(NULL, size);
    snprintf(beside, size, "%.*s%s", folder, report, name);
    const bool same = output_is_same(beside, page);
    free(beside);
    return same;
}

int web_report_check(const command_line *a)
{
    const char *report = a->values[OPTION_REPORT].text, *page = a->values[OPTION_OUTPUT].text;
    if (report == NULL) {
        return EXIT_DONE;
    }
    if (output_is_same(report, page)) {
        return usage_error(COMMAND_WEB, "--report %s: is OUT.html too; name the report of bake",
                           report);
    }
    const int code = report_link_check(report);
    if (code != EXIT_DONE) {
        return code;
    }
    if (!are_neighbours(report, page)) {
        return usage_error(COMMAND_WEB,
                           "--report %s: lies in another folder than %s; write the page beside the "
                           "report",
                           report, page);
    }
    return output_check(report, true); // -f is for the page: the report keeps all it holds
}

void web_report_compare(const command_line *a, const web_scene *scene, message_log *messages)
{
    const char *report = a->values[OPTION_REPORT].text, *hash = web_scene_hash(scene);
    if (report != NULL && hash != NULL && report_is_of_other(report, hash)) {
        web_report(messages, ALP_LOG_WARNING, "web-other-report", report,
                   "is of another scene than this bake, or of another state of it; name the report "
                   "of the same bake");
    }
}

int web_report_write(const command_line *a)
{
    const char *report = a->values[OPTION_REPORT].text;
    return report == NULL ? EXIT_DONE : report_link_write(report, a->values[OPTION_OUTPUT].text);
}
