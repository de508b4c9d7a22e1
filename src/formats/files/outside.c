// SPDX-License-Identifier: MIT
#include "formats/files/outside.h"

#include "base/bytes.h"
#include "base/memory.h"

#include <string.h>
#include <strings.h>

static int hex_value(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

bool alpi_uri_decode(char *text)
{
    char *out = text;
    for (const char *in = text; *in != '\0'; in++) {
        const int high = *in == '%' ? hex_value(in[1]) : -1;
        const int low = high >= 0 ? hex_value(in[2]) : -1;
        if (low < 0) {
            *out++ = *in;
            continue;
        }
        if (high == 0 && low == 0) {
            return false;
        }
        *out++ = (char)(high * 16 + low);
        in += 2;
    }
    *out = '\0';
    return true;
}

char *alpi_uri_encode(alp_context *context, const char *name)
{
    alpi_bytes uri = alpi_bytes_create(context);
    alpi_bytes_add(&uri, "", 0);
    for (; *name != '\0'; name++) {
        unsigned char c = (unsigned char)*name;
        bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                     strchr("-._~", c) != NULL;
        if (plain) {
            alpi_bytes_add(&uri, name, 1);
        } else {
            alpi_bytes_print(&uri, "%%%02X", (unsigned)c);
        }
    }
    char *copy = uri.failed ? NULL : alpi_copy_string(context, (const char *)uri.bytes);
    alpi_bytes_destroy(&uri);
    return copy;
}

bool alpi_path_stays_below(const char *path)
{
    if (path[0] == '\0' || path[0] == '/' || path[0] == '\\') {
        return false;
    }
    for (const char *part = path; part != NULL;) {
        const size_t length = strcspn(part, "/\\");
        if (length == 2 && part[0] == '.' && part[1] == '.') {
            return false;
        }
        part = part[length] == '\0' ? NULL : part + length + 1;
    }
    return true;
}

bool alpi_outside_takes(const alp_context *context, const char *uri)
{
    return alpi_context_options(context)->read_outside && strncasecmp(uri, "file:/", 6) == 0;
}

/// The absolute path of "file:/…", "file:///…" and "file://localhost/…" (RFC 8089); NULL of
/// another machine's.
static const char *file_uri_path(const char *uri)
{
    static const char host[] = "localhost";
    const char *path = uri + strlen("file:");
    if (strncmp(path, "//", 2) != 0) {
        return path;
    }
    path += 2;
    path += strncasecmp(path, host, sizeof host - 1) == 0 ? sizeof host - 1 : 0;
    return path[0] == '/' ? path : NULL;
}

alp_result alpi_outside_path(alp_context *context, const char *folder, const char *name,
                             char **path)
{
    *path = NULL;
    if (alpi_outside_takes(context, name)) {
        name = file_uri_path(name);
        folder = "";
    } else if (alpi_context_options(context)->read_outside && name[0] == '/') {
        folder = "";
    } else if (!alpi_context_options(context)->read_outside && !alpi_path_stays_below(name)) {
        name = NULL;
    }
    if (name == NULL || name[0] == '\0') {
        return ALP_OK;
    }
    *path = alpi_format(context, "%s%s", folder, name);
    return *path == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}
