// SPDX-License-Identifier: MIT
#include "setup/number_lines.h"

#include "options/options.h"
#include "printing/messages.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MESSAGE_SIZE = 400 };

static void read_numbers(number_line *line, int columns)
{
    const char *at = line->text;
    line->rest = line->text;
    for (line->count = 0; line->count < columns; line->count++) {
        char *behind = NULL;
        at += strspn(at, " \t");
        at += line->count > 0 && (*at == ',' || *at == ';') ? 1 : 0; // an empty column is no number
        const double number = strtod(at, &behind);
        if (behind == at || (*behind != '\0' && strchr(",; \t\r\n", *behind) == NULL)) {
            return;
        }
        line->numbers[line->count] = number;
        line->rest = at = behind;
    }
}

/// Whether a line without numbers names columns: one of them is an x.
static bool is_names(const number_line *line)
{
    return line->count == 0 && strpbrk(line->text, "xX") != NULL;
}

static bool is_folder(FILE *file)
{
    struct stat found;
    return fstat(fileno(file), &found) == 0 && S_ISDIR(found.st_mode);
}

static int refuse(const char *path, unsigned long line, const char *fault)
{
    char text[MESSAGE_SIZE];
    if (line > 0) {
        snprintf(text, sizeof text, "%s:%lu: %s", path, line, fault);
    } else {
        snprintf(text, sizeof text, "%s: %s", path, fault);
    }
    return failure(text);
}

static int read_lines(FILE *file, const char *path, int columns, const char *empty,
                      number_line_fn *keep, void *user)
{
    char *text = NULL;
    size_t size = 0;
    bool has_numbers = false;
    int code = EXIT_DONE;
    for (unsigned long i = 1; code == EXIT_DONE && getline(&text, &size, file) >= 0; i++) {
        number_line line = {.text = text + strspn(text, " \t\r\n")};
        if (*line.text == '\0' || *line.text == '#') {
            continue;
        }
        read_numbers(&line, columns);
        if (has_numbers || !is_names(&line)) {
            const char *fault = keep(user, &line);
            code = fault != NULL ? refuse(path, i, fault) : EXIT_DONE;
            has_numbers = true;
        }
    }
    free(text);
    if (code == EXIT_DONE && ferror(file)) {
        return refuse(path, 0, "cannot be read to its end");
    }
    return code == EXIT_DONE && !has_numbers ? refuse(path, 0, empty) : code;
}

int number_lines_read(const char *path, int columns, const char *empty, number_line_fn *keep,
                      void *user)
{
    const bool input = strcmp(path, "-") == 0;
    FILE *file = input ? stdin : fopen(path, "r");
    if (file == NULL) {
        return refuse(path, 0, "cannot be read");
    }
    const int code = is_folder(file) ? refuse(path, 0, "is a folder; give a file of lines")
                                     : read_lines(file, path, columns, empty, keep, user);
    if (!input) {
        fclose(file);
    }
    return code;
}
