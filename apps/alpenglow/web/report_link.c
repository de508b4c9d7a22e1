// SPDX-License-Identifier: MIT
#include "web/report_link.h"

#include "options/options.h"
#include "output.h"
#include "printing/messages.h"
#include "web/web_file.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/// Marks of a report: the meta element that names its writer, and the element of the link, which
/// bake --report leaves empty. Text from files is escaped in a report: no name can hold them.
static const char generator[] = "<meta name=\"generator\" content=\"alpenglow report\"/>";
static const char start[] = "<p id=\"web\">", end[] = "</p>";
static const char before[] = "<a href=\"", after[] = "\">See this scene in the browser</a>";
/// The mark of a page of alpenglow web, in its first bytes.
static const char page_mark[] = "<meta name=\"generator\" content=\"alpenglow web\">";
enum { PAGE_HEAD = 2048 };

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash == NULL ? path : slash + 1;
}

static bool is_plain(char c)
{
    const unsigned char u = (unsigned char)c;
    return u < 0x80 && u != '\0' && (isalnum(u) || strchr("-._~", u) != NULL);
}

/// Writes a name as part of an address. Bytes but letters, digits and -._~ are coded.
static void write_address(FILE *stream, const char *name)
{
    for (const char *at = name; *at != '\0'; at++) {
        if (is_plain(*at)) {
            fputc(*at, stream);
        } else {
            fprintf(stream, "%%%02X", (unsigned char)*at);
        }
    }
}

/// The text of a report and the place of its link.
typedef struct report_text {
    char *text;        // malloc'ed
    const char *first; // behind the start of the element
    const char *last;  // the end of the element
    int address;       // length of the address of a link behind `before`; 0: the element is empty
} report_text;

/// Finds the element, which is empty or holds one link of ours. False: the text is no report.
static bool find_element(report_text *r)
{
    const char *mark = strstr(r->text, generator), *place = strstr(r->text, start);
    if (mark == NULL || place == NULL || mark > place || strstr(place + 1, start) != NULL) {
        return false;
    }
    r->first = place + strlen(start);
    r->last = strstr(r->first, end);
    if (r->last == r->first || r->last == NULL) {
        return r->last != NULL;
    }
    const char *address = r->first + strlen(before), *at = address;
    if (strncmp(r->first, before, strlen(before)) != 0) {
        return false;
    }
    while (is_plain(*at) || *at == '%') {
        at++;
    }
    r->address = (int)(at - address);
    return r->address > 0 && strncmp(at, after, strlen(after)) == 0 &&
           at + strlen(after) == r->last;
}

/// @param text of a file, malloc'ed; released on failure. NULL: nothing is done
static bool open_report(char *text, size_t size, report_text *r)
{
    *r = (report_text){.text = text};
    if (text == NULL || (strlen(text) == size && find_element(r))) {
        return text != NULL;
    }
    free(text);
    r->text = NULL;
    return false;
}

/// False after a message.
static bool read_report(const char *path, report_text *r)
{
    size_t size = 0;
    char *text = web_read_file(path, &size);
    const bool good = open_report(text, size, r);
    if (text != NULL && !good) {
        web_fail(path, "is no report of this alpenglow; write one by bake --report");
    }
    return good;
}

int report_link_check(const char *report)
{
    report_text r;
    const bool good = read_report(report, &r);
    free(r.text);
    return good ? EXIT_DONE : EXIT_FAILED;
}

bool report_is_of_other(const char *report, const char *hash)
{
    static const char before_hash[] = "<dt>Input hash</dt><dd>";
    size_t size = 0;
    char *text = web_read_bytes(report, &size);
    const char *at = text != NULL ? strstr(text, before_hash) : NULL;
    const bool is_other = at != NULL && strncmp(at + strlen(before_hash), hash, strlen(hash)) != 0;
    free(text);
    return is_other;
}

int report_link_write(const char *report, const char *page)
{
    report_text r;
    if (!read_report(report, &r)) {
        return EXIT_FAILED;
    }
    char *written = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&written, &size);
    if (stream == NULL) {
        free(r.text);
        return failure("out of memory");
    }
    fwrite(r.text, 1, (size_t)(r.first - r.text), stream);
    fputs(before, stream);
    write_address(stream, name_of(page));
    fputs(after, stream);
    fputs(r.last, stream);
    const bool good = ferror(stream) == 0;
    const bool closed = fclose(stream) == 0;
    const int code =
        good && closed ? output_write_text(written, report, true) : failure("out of memory");
    free(written);
    free(r.text);
    return code;
}

/// Whether a name in the folder of the report is a page of alpenglow web, which the report will not
/// replace.
static bool is_page(const char *report, const char *name)
{
    const int folder = (int)(name_of(report) - report);
    const size_t size = (size_t)folder + strlen(name) + 1;
    char *path = allocate_or_exit(NULL, size), head[PAGE_HEAD + 1];
    snprintf(path, size, "%.*s%s", folder, report, name);
    struct stat about;
    const bool is_file = strchr(name, '/') == NULL && !output_is_same(path, report) &&
                         stat(path, &about) == 0 && S_ISREG(about.st_mode);
    FILE *file = is_file ? fopen(path, "rb") : NULL;
    free(path);
    if (file == NULL) {
        return false;
    }
    head[fread(head, 1, PAGE_HEAD, file)] = '\0';
    fclose(file);
    return strstr(head, page_mark) != NULL;
}

/// The name that the report of this name links, malloc'ed; NULL: none.
static char *linked_name(const char *report)
{
    size_t size = 0;
    report_text r;
    char *text = web_read_bytes(report, &size), *name = NULL;
    if (open_report(text, size, &r) && r.address > 0) {
        name = allocate_or_exit(NULL, (size_t)r.address + 1);
        snprintf(name, (size_t)r.address + 1, "%s", r.first + strlen(before));
        web_decode_address(name);
    }
    free(r.text);
    return name;
}

/// The name of the baked file with .html in place of its ending, malloc'ed; NULL: none.
static char *baked_name(const char *baked)
{
    if (baked == NULL) {
        return NULL;
    }
    const char *name = name_of(baked), *dot = strrchr(name, '.');
    const int length = (int)(dot != NULL ? (size_t)(dot - name) : strlen(name));
    const size_t size = (size_t)length + sizeof ".html";
    char *page = allocate_or_exit(NULL, size);
    snprintf(page, size, "%.*s.html", length, name);
    return page;
}

char *report_link_find(const char *report, const char *baked)
{
    char *names[] = {linked_name(report), baked_name(baked)}, *found = NULL;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (found == NULL && names[i] != NULL && is_page(report, names[i])) {
            found = names[i];
        } else {
            free(names[i]);
        }
    }
    return found;
}
