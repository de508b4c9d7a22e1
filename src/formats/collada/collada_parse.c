// SPDX-License-Identifier: MIT
// XML text → tree by libxml2, which opens and expands nothing. Its first fault is told.
#include "formats/collada/collada_document.h"

#include <libxml/parser.h>
#include <libxml/parserInternals.h>
#include <stdio.h>
#include <string.h>

/// A declared entity could expand without end: the scan refuses them, and here is the second lock.
static void refuse_entity(void *parser, const xmlChar *name, int type, const xmlChar *public_id,
                          const xmlChar *system_id, xmlChar *content)
{
    (void)name, (void)type, (void)public_id, (void)system_id, (void)content;
    xmlStopParser(parser);
}

/// The first fault, which is the cause of those after it.
typedef struct first_fault {
    int code, line, column; // code 0: none yet
    char words[200];
} first_fault;

/// Keeps the first fault and stops there. Those that follow would come one by one, and an unclosed
/// comment of a megabyte has a fault in every "--" that takes as long as all before it.
static void stop_at_fault(void *data, xmlError *error)
{
    xmlParserCtxt *parser = (xmlParserCtxt *)data;
    first_fault *fault = parser->_private;
    if (error->level != XML_ERR_FATAL && error->code != XML_ERR_NO_MEMORY &&
        error->domain != XML_FROM_I18N) {
        return;
    }
    if (fault->code == 0) {
        fault->code = error->code;
        fault->line = error->line;
        fault->column = error->int2;
        if (error->domain == XML_FROM_I18N && parser->input != NULL) { // it knows no place
            fault->line = parser->input->line;
            fault->column = parser->input->col;
        }
        snprintf(fault->words, sizeof fault->words, "%s",
                 error->message != NULL ? error->message : "is no XML");
        fault->words[strcspn(fault->words, "\r\n")] = '\0';
    }
    if (error->domain != XML_FROM_I18N) { // there its input is in use, and ends by itself
        xmlStopParser(parser);
    }
}

/// The cause in plain words and a remedy, for faults that people meet.
static const char *explain(const first_fault *fault)
{
    switch (fault->code) {
    case XML_ERR_NAME_REQUIRED: // of an entity or of an element
        return strstr(fault->words, "EntityRef") != NULL
                   ? "a bare \"&\"; write &amp;"
                   : "a \"<\" that begins no element; write &lt; where it is text";
    case XML_ERR_ENTITYREF_SEMICOL_MISSING:
        return "a bare \"&\"; write &amp;";
    case XML_ERR_UNDECLARED_ENTITY:
    case XML_WAR_UNDECLARED_ENTITY:
        return "an entity that XML does not have; write the character itself, or &amp; for \"&\"";
    case XML_ERR_LT_IN_ATTRIBUTE:
        return "a bare \"<\" in an attribute; write &lt;";
    case XML_ERR_INVALID_CHAR:
    case XML_ERR_INVALID_CHARREF:
        return "a control character, which XML forbids; take it out";
    case XML_ERR_INVALID_ENCODING:
    case XML_I18N_CONV_FAILED:
        return "bytes behind this place are not of the encoding that the file states; save it as "
               "UTF-8";
    case XML_ERR_UNSUPPORTED_ENCODING:
    case XML_ERR_UNKNOWN_ENCODING:
        return "an encoding that is not read; save it as UTF-8";
    case XML_ERR_RESERVED_XML_NAME:
        return "<?xml ...?> is not at the very beginning; take out what stands before it";
    case XML_ERR_DOCUMENT_EMPTY:
        return "no \"<\" begins the text, so it is no XML";
    case XML_ERR_ATTRIBUTE_REDEFINED:
        return "an attribute that is there twice; take one out";
    default:
        return NULL;
    }
}

static alp_result fail_parse(const alpi_collada_document *d, const first_fault *fault)
{
    const char *cause = explain(fault);
    if (fault->code == XML_ERR_NO_MEMORY) {
        return alpi_fail(d->context, ALP_ERROR_OUT_OF_MEMORY, "%s: no memory for its XML tree",
                         d->path);
    }
    if (fault->code == 0) {
        return alpi_fail(d->context, ALP_ERROR_INVALID_DATA, "%s: is no XML", d->path);
    }
    return cause != NULL
               ? alpi_fail(d->context, ALP_ERROR_INVALID_DATA, "%s: XML, line %d column %d: %s",
                           d->path, fault->line, fault->column, cause)
               : alpi_fail(d->context, ALP_ERROR_INVALID_DATA,
                           "%s: XML, line %d column %d: %s; it may be truncated or damaged",
                           d->path, fault->line, fault->column, fault->words);
}

alp_result alpi_collada_parse_text(alpi_collada_document *d)
{
    xmlParserCtxt *parser = xmlNewParserCtxt();
    if (parser == NULL) {
        return alpi_fail(d->context, ALP_ERROR_OUT_OF_MEMORY, "%s: no memory for the XML parser",
                         d->path);
    }
    first_fault fault = {0};
    parser->_private = &fault;
    parser->sax->entityDecl = refuse_entity;
    parser->sax->serror = stop_at_fault;
    // Not XML_PARSE_NOENT, DTDLOAD or XINCLUDE: nothing is expanded, nothing else is opened. HUGE
    // lifts limits that real arrays pass; the scan has set ours.
    const int options = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE |
                        XML_PARSE_NOBLANKS | XML_PARSE_COMPACT;
    const char *encoding = d->encoding == ALPI_XML_BYTES && !d->is_utf8 ? NULL : "UTF-8";
    // Faults of iconv come without a parser, and would be printed. The handler is the thread's own.
    xmlStructuredErrorFunc before = xmlStructuredError;
    void *before_data = xmlStructuredErrorContext;
    xmlSetStructuredErrorFunc(parser, stop_at_fault);
    d->tree = xmlCtxtReadMemory(parser, d->text, (int)d->text_size, NULL, encoding, options);
    xmlSetStructuredErrorFunc(before_data, before);
    alp_result result = d->tree != NULL ? ALP_OK : fail_parse(d, &fault);
    xmlFreeParserCtxt(parser);
    return result;
}
