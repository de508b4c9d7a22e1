// SPDX-License-Identifier: MIT
// Numbers in text. An array of a million floats is one text node: it is counted once, allocated
// once and read once.
#include "formats/collada/collada_numbers.h"

#include "base/memory.h"
#include "base/plural.h"

#include <math.h>
#include <string.h>
#include <strings.h>

static bool is_space(char c)
{
    return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

/// value · 10^exponent. Powers to 22 are exact in a double; larger ones are made of few.
static double scale_by_ten(double value, int exponent)
{
    static const double small[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                   1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                   1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const bool down = exponent < 0;
    int left = down ? -exponent : exponent;
    while (left > 0 && value != 0.0 && isfinite(value)) { // ends: value leaves the range
        const int step = left > 22 ? 22 : left;
        value = down ? value / small[step] : value * small[step];
        left -= step;
    }
    return value;
}

/// Digits into the mantissa, as far as 19 fit; *dropped counts those that do not.
static const char *read_digits(const char *p, uint64_t *mantissa, int *taken, int *dropped)
{
    for (; (unsigned)(*p - '0') < 10u; p++) {
        if (*taken < 19) {
            *mantissa = *mantissa * 10 + (unsigned)(*p - '0');
            *taken += *mantissa != 0; // leading zeros take no place
        } else {
            *dropped += 1;
        }
    }
    return p;
}

/// The exponent behind "e"; one beyond a double's reach is as good as any.
static const char *read_exponent(const char *p, int *exponent)
{
    const char *q = p + 1;
    const bool negative = *q == '-';
    q += *q == '-' || *q == '+';
    if ((unsigned)(*q - '0') >= 10u) {
        return p;
    }
    int value = 0;
    for (; (unsigned)(*q - '0') < 10u; q++) {
        value = value < 100000 ? value * 10 + (*q - '0') : value;
    }
    *exponent += negative ? -value : value;
    return q;
}

static bool read_word(const char **at, double *value)
{
    static const struct {
        const char *word;
        double value;
    } words[] = {{"INF", HUGE_VAL}, {"NaN", (double)NAN}, {"Infinity", HUGE_VAL}};
    const char *p = *at + (**at == '-' || **at == '+');
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        const size_t length = strlen(words[i].word);
        if (strncasecmp(p, words[i].word, length) == 0 &&
            (p[length] == '\0' || is_space(p[length]))) {
            *value = **at == '-' ? -words[i].value : words[i].value;
            *at = p + length;
            return true;
        }
    }
    return false;
}

bool alpi_text_number(const char **at, double *value)
{
    const char *p = *at;
    const bool negative = *p == '-';
    p += *p == '-' || *p == '+';
    uint64_t mantissa = 0;
    int taken = 0, dropped = 0, exponent = 0;
    const char *digits = p;
    p = read_digits(p, &mantissa, &taken, &dropped);
    bool any = p > digits;
    exponent += dropped;
    if (*p == '.' || *p == ',') { // some exporters print by their locale
        const char *fraction = p + 1;
        dropped = 0;
        p = read_digits(fraction, &mantissa, &taken, &dropped);
        any |= p > fraction;
        exponent -= (int)(p - fraction < 1000000 ? p - fraction : 1000000) - dropped;
    }
    if (any && (*p == 'e' || *p == 'E')) {
        p = read_exponent(p, &exponent);
    }
    if (!any || !(*p == '\0' || is_space(*p))) {
        if (!read_word(at, value)) {
            return false;
        }
        p = *at;
    } else {
        const double size = scale_by_ten((double)mantissa, exponent);
        *value = negative ? -size : size;
    }
    while (is_space(*p)) {
        p++;
    }
    *at = p;
    return true;
}

// --- lists ---------------------------------------------------------------------------------------

static const char *skip_space(const char *p)
{
    while (is_space(*p)) {
        p++;
    }
    return p;
}

static size_t count_words(const char *p)
{
    size_t count = 0;
    for (bool inside = false; *p != '\0'; p++) {
        const bool word = !is_space(*p);
        count += word && !inside;
        inside = word;
    }
    return count;
}

/// Next child that holds text, from `node` on.
static const xmlNode *text_from(const xmlNode *node)
{
    while (node != NULL &&
           !((node->type == XML_TEXT_NODE || node->type == XML_CDATA_SECTION_NODE) &&
             node->content != NULL)) {
        node = node->next;
    }
    return node;
}

/// The word at `p` is no number: where and which.
static alp_result fail_word(const alpi_collada_document *d, const xmlNode *node, const char *start,
                            const char *p, const char *wanted)
{
    uint32_t lines = 0;
    for (const char *c = start; c < p; c++) {
        lines += *c == '\n';
    }
    const size_t length = strcspn(p, " \t\r\n");
    return alpi_collada_fail(d, node, "\"%.*s\" (%u line%s further) is no %s",
                             (int)(length < 40 ? length : 40), p, lines, alpi_plural(lines),
                             wanted);
}

static size_t count_numbers(const xmlNode *node)
{
    size_t words = 0;
    for (const xmlNode *t = text_from(node->children); t != NULL; t = text_from(t->next)) {
        words += count_words((const char *)t->content);
    }
    return words;
}

/// All numbers of an element's text, in the one array or the other.
static alp_result read_numbers(const alpi_collada_document *d, const xmlNode *node, float *singles,
                               double *doubles, size_t *count)
{
    *count = 0;
    for (const xmlNode *t = text_from(node->children); t != NULL; t = text_from(t->next)) {
        const char *p = skip_space((const char *)t->content);
        while (*p != '\0') {
            double value;
            if (!alpi_text_number(&p, &value)) {
                return fail_word(d, node, (const char *)t->content, p, "number");
            }
            if (singles != NULL) {
                singles[(*count)++] = (float)value;
            } else {
                doubles[(*count)++] = value;
            }
        }
    }
    return ALP_OK;
}

alp_result alpi_collada_floats(const alpi_collada_document *d, const xmlNode *node, float **values,
                               size_t *count)
{
    *count = 0;
    ALPI_TRY_NEW(d->context, *values, count_numbers(node));
    return read_numbers(d, node, *values, NULL, count);
}

alp_result alpi_collada_exact(const alpi_collada_document *d, const xmlNode *node, double **values,
                              size_t *count)
{
    *count = 0;
    ALPI_TRY_NEW(d->context, *values, count_numbers(node));
    return read_numbers(d, node, NULL, *values, count);
}

alp_result alpi_collada_doubles(const alpi_collada_document *d, const xmlNode *node, size_t count,
                                double *values)
{
    const char *p = skip_space(alpi_xml_text(node));
    for (size_t i = 0; i < count; i++) {
        if (*p == '\0') {
            return alpi_collada_fail(d, node, "holds %zu numbers, must hold %zu", i, count);
        }
        if (!alpi_text_number(&p, &values[i])) {
            return fail_word(d, node, alpi_xml_text(node), p, "number");
        }
        if (!isfinite(values[i])) {
            return alpi_collada_fail(d, node, "holds a number that is not finite");
        }
    }
    return ALP_OK;
}

/// @return false at what is no whole number from 0 to 2^32 − 2
static bool read_index(const char **at, uint32_t *value)
{
    const char *p = *at;
    uint64_t number = 0;
    for (; (unsigned)(*p - '0') < 10u && number < UINT32_MAX; p++) {
        number = number * 10 + (unsigned)(*p - '0');
    }
    if (p == *at || !(*p == '\0' || is_space(*p)) || number >= UINT32_MAX) {
        return false;
    }
    *value = (uint32_t)number;
    *at = skip_space(p);
    return true;
}

alp_result alpi_collada_indices(const alpi_collada_document *d, const xmlNode *node,
                                uint32_t **values, size_t *count, size_t *capacity)
{
    for (const xmlNode *t = text_from(node->children); t != NULL; t = text_from(t->next)) {
        const size_t words = count_words((const char *)t->content);
        void *items = *values;
        ALP_TRY(alpi_grow(d->context, &items, capacity, *count + words, sizeof **values));
        *values = items;
        const char *p = skip_space((const char *)t->content);
        while (*p != '\0') {
            if (!read_index(&p, &(*values)[*count])) {
                return fail_word(d, node, (const char *)t->content, p,
                                 "index (a whole number from 0)");
            }
            ++*count;
        }
    }
    return ALP_OK;
}

alp_result alpi_collada_count(const alpi_collada_document *d, const xmlNode *node,
                              const char *attribute, uint32_t absent, uint32_t most,
                              uint32_t *value)
{
    const char *text = alpi_xml_attribute(node, attribute);
    *value = absent;
    if (text == NULL) {
        return ALP_OK;
    }
    text = skip_space(text);
    if (!read_index(&text, value) || *value > most) {
        return alpi_collada_fail(d, node, "its %s=\"%.30s\" is no whole number from 0 to %u",
                                 attribute, alpi_xml_attribute(node, attribute), most);
    }
    return ALP_OK;
}
