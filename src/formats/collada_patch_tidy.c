// SPDX-License-Identifier: MIT
// What an earlier bake left in a document and nothing reads any more: parameters and numbers of
// effects that get new ones, and images. Taken out where they are surely ours.
#include "formats/collada_patch.h"

#include <string.h>

enum { PARAM_LIMIT = 64 }; // of one effect: each is looked for in all of it

/// Whether a name is "alpenglow-ao-", "alpenglow2-light-" or such, and what follows.
static bool is_ours(const char *name, const char **rest)
{
    static const char word[] = "alpenglow", ao[] = "-ao-", light[] = "-light-";
    if (name == NULL || strncmp(name, word, sizeof word - 1) != 0) {
        return false;
    }
    name += sizeof word - 1;
    name += strspn(name, "0123456789");
    const bool is_ao = strncmp(name, ao, sizeof ao - 1) == 0;
    const bool is_light = strncmp(name, light, sizeof light - 1) == 0;
    *rest = name + (is_ao ? sizeof ao - 1 : is_light ? sizeof light - 1 : 0);
    return is_ao || is_light;
}

/// Only in a document that we wrote; where materials set parameters by name, nothing is sure.
static bool may_tidy(alpi_collada_patcher *p)
{
    if (!p->tidy_known) {
        p->tidy_known = true;
        p->may_tidy = alpi_collada_was_baked(p->document);
        for (uint32_t i = 0; p->may_tidy && i < p->document->element_count; i++) {
            p->may_tidy = !alpi_xml_is(p->document->elements[i], "setparam");
        }
    }
    return p->may_tidy;
}

static void take_out(alpi_collada_patcher *p, const xmlNode *element)
{
    const uint32_t end = alpi_xml_end_index(p->document, element);
    for (uint32_t i = alpi_xml_index(element); i < end; i++) {
        p->removed[i] = true;
    }
    alpi_xml_replace(p->document, &p->edits, element, "");
}

/// Whether an element's text is that word.
static bool says(const xmlNode *element, const char *word)
{
    const char *text = alpi_xml_text(element);
    text += strspn(text, " \t\r\n");
    const size_t length = strlen(word);
    return strncmp(text, word, length) == 0 &&
           text[length + strspn(text + length, " \t\r\n")] == '\0';
}

/// Whether something of an effect that stays reads a parameter.
static bool is_read(const alpi_collada_patcher *p, const xmlNode *effect, const char *sid,
                    const char *const *members)
{
    const uint32_t end = alpi_xml_end_index(p->document, effect);
    const xmlNode *shader = alpi_collada_shader(effect);
    for (uint32_t i = alpi_xml_index(effect); i < end; i++) {
        const xmlNode *e = p->document->elements[i];
        const char *texture = alpi_xml_attribute(e, "texture");
        bool goes = p->removed[i];
        for (int k = 0; !goes && members[k] != NULL; k++) {
            goes = e->parent->parent == shader && alpi_xml_is(e->parent, members[k]);
        }
        if (!goes && ((texture != NULL && strcmp(texture, sid) == 0) || says(e, sid))) {
            return true;
        }
    }
    return false;
}

static void drop_params(alpi_collada_patcher *p, const xmlNode *effect, const char *ending,
                        const char *const *members)
{
    const xmlNode *profile = alpi_collada_shader(effect)->parent->parent;
    uint32_t count = 0;
    const xmlNode *param = alpi_xml_child(profile, "newparam");
    for (; param != NULL && count < PARAM_LIMIT; param = alpi_xml_next(param, "newparam")) {
        const char *sid = alpi_xml_attribute(param, "sid"), *rest = "";
        if (is_ours(sid, &rest) && strcmp(rest, ending) == 0) {
            count++;
            if (!is_read(p, effect, sid, members)) {
                take_out(p, param);
            }
        }
    }
}

void alpi_collada_tidy_effect(alpi_collada_patcher *p, const xmlNode *effect)
{
    const char *members[4] = {0};
    uint32_t count = 0;
    if (!may_tidy(p)) {
        return;
    }
    const xmlNode *shader = alpi_collada_shader(effect);
    if (p->patch->page_pngs != NULL) {
        members[count++] = "ambient";
    }
    if (p->patch->light != NULL) {
        members[count++] = "emission";
        members[count] = alpi_xml_is(shader, "constant") ? NULL : "diffuse";
        const xmlNode *extra = alpi_xml_child(shader->parent, "extra");
        for (; extra != NULL; extra = alpi_xml_next(extra, "extra")) {
            const xmlNode *technique = alpi_xml_child(extra, NULL);
            const char *profile = alpi_xml_attribute(technique, "profile");
            if (profile != NULL && strcmp(profile, "alpenglow") == 0 &&
                alpi_xml_next(technique, NULL) == NULL) {
                take_out(p, extra);
            }
        }
    }
    drop_params(p, effect, "sampler", members); // which read surfaces
    drop_params(p, effect, "surface", members);
}

/// Marks the image that a word names. False where it looks like a name of ours, but is none.
static bool mark_read(alpi_collada_patcher *p, const char *word)
{
    const char *rest = "";
    if (!is_ours(word, &rest)) {
        return true;
    }
    const xmlNode *image = alpi_collada_find(p->document, word);
    if (image != NULL) {
        p->image_read[alpi_xml_index(image)] = true;
    }
    return image != NULL || strcmp(rest, "surface") == 0 || strcmp(rest, "sampler") == 0;
}

void alpi_collada_tidy_images(alpi_collada_patcher *p)
{
    const alpi_collada_document *d = p->document;
    const char *rest = "";
    bool sure = may_tidy(p);
    for (uint32_t i = 0; sure && i < d->element_count; i++) {
        const char *url = alpi_xml_attribute(d->elements[i], "url");
        const char *text = alpi_xml_text(d->elements[i]);
        if (!p->removed[i]) {
            sure = mark_read(p, url != NULL && url[0] == '#' ? url + 1 : url) &&
                   mark_read(p, alpi_xml_attribute(d->elements[i], "texture")) &&
                   mark_read(p, text + strspn(text, " \t\r\n"));
        }
    }
    for (uint32_t i = 0; sure && i < d->element_count; i++) {
        const char *id = alpi_xml_attribute(d->elements[i], "id");
        if (alpi_xml_is(d->elements[i], "image") && !p->image_read[i] && is_ours(id, &rest)) {
            take_out(p, d->elements[i]);
        }
    }
}
