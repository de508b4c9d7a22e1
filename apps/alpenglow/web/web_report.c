// SPDX-License-Identifier: MIT
#include "web/web_report.h"

#include "output.h"
#include "web/web_scene.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// The element of the link, which bake --report leaves empty. Text from files is escaped in a
/// report: no name can hold these marks.
static const char start[] = "<p id=\"web\">", end[] = "</p>";

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash == NULL ? path : slash + 1;
}

/// Whether both files lie in one folder.
static bool are_neighbours(const char *report, const char *page)
{
    const int folder = (int)(name_of(report) - report);
    const size_t size = (size_t)folder + strlen(name_of(page)) + 1;
    char *beside = allocate_or_exit(NULL, size);
    snprintf(beside, size, "%.*s%s", folder, report, name_of(page));
    const bool same = output_is_same(beside, page);
    free(beside);
    return same;
}

/// The text of a report. NULL after a message. @return malloc'ed
static char *read_report(const char *path)
{
    size_t size = 0;
    char *text = web_read_file(path, &size);
    if (text == NULL) {
        return NULL;
    }
    const char *first = strlen(text) == size ? strstr(text, start) : NULL;
    const char *last = first != NULL ? strstr(first, end) : NULL;
    if (last == NULL || strstr(first + 1, start) != NULL) {
        web_fail(path, "is no report of this alpenglow; write one by bake --report");
        free(text);
        return NULL;
    }
    return text;
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
    char *text = read_report(report);
    free(text);
    if (text == NULL) {
        return EXIT_FAILED;
    }
    if (!are_neighbours(report, page)) {
        return usage_error(COMMAND_WEB,
                           "--report %s: lies in another folder than %s; write the page beside the "
                           "report",
                           report, page);
    }
    return output_check(report, true); // -f is for the page: the report keeps all it holds
}

/// Writes a name as part of an address. Bytes but letters, digits and -._~ are coded.
static void write_address(FILE *stream, const char *name)
{
    for (const char *at = name; *at != '\0'; at++) {
        const unsigned char c = (unsigned char)*at;
        if (c < 0x80 && (isalnum(c) || strchr("-._~", c) != NULL)) {
            fputc(c, stream);
        } else {
            fprintf(stream, "%%%02X", c);
        }
    }
}

int web_report_write(const command_line *a)
{
    const char *report = a->values[OPTION_REPORT].text;
    char *text = report != NULL ? read_report(report) : NULL; // again: it may have changed
    if (text == NULL) {
        return report == NULL ? EXIT_DONE : EXIT_FAILED;
    }
    char *written = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&written, &size);
    if (stream == NULL) {
        free(text);
        return failure("out of memory");
    }
    const char *after = strstr(text, start) + strlen(start);
    fwrite(text, 1, (size_t)(after - text), stream);
    fputs("<a href=\"", stream);
    write_address(stream, name_of(a->values[OPTION_OUTPUT].text));
    fputs("\">See this scene in the browser</a>", stream);
    fputs(strstr(after, end), stream);
    const bool good = ferror(stream) == 0;
    const bool closed = fclose(stream) == 0;
    const int code =
        good && closed ? output_write_text(written, report, true) : failure("out of memory");
    free(written);
    free(text);
    return code;
}
