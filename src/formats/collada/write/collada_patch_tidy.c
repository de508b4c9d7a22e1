// SPDX-License-Identifier: MIT
// What an earlier bake left in a document and nothing reads any more: parameters and numbers of
// effects that get new ones, copies of materials and effects, and images. Taken out where they are
// surely ours.
#include "formats/collada/write/collada_patch.h"

#include <string.h>

enum { PARAM_LIMIT = 64 }; // of one effect: each is looked for in all of it

/// What follows "alpenglow-KIND-", "alpenglow2-KIND-" or such; NULL where a name does not begin so.
static const char *find_ending(const char *name, const char *kind)
{
    static const char word[] = "alpenglow";
    const size_t length = strlen(kind);
    if (name == NULL || strncmp(name, word, sizeof word - 1) != 0) {
        return NULL;
    }
    name += sizeof word - 1;
    name += strspn(name, "0123456789");
    const bool same = *name == '-' && strncmp(name + 1, kind, length) == 0;
    return same && name[length + 1] == '-' ? name + length + 2 : NULL;
}

/// Whether a name is one of a map of ours, and what follows.
static bool is_ours(const char *name, const char **rest)
{
    const char *ao = find_ending(name, "ao"), *light = find_ending(name, "light");
    *rest = ao != NULL ? ao : light;
    return *rest != NULL;
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

void alpi_collada_note_removed(const alpi_collada_patcher *p, const xmlNode *element, bool *removed)
{
    const uint32_t end = alpi_xml_end_index(p->document, element);
    for (uint32_t i = alpi_xml_index(element); i < end; i++) {
        removed[i] = true;
    }
}

/// What is changed, and the elements that go.
typedef struct changes {
    alpi_edits *edits;
    bool *removed; // [elements]
} changes;

static void take_out(const alpi_collada_patcher *p, const changes *to, const xmlNode *element)
{
    alpi_collada_note_removed(p, element, to->removed);
    alpi_xml_replace(p->document, to->edits, element, "");
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
static bool is_read(const alpi_collada_patcher *p, const bool *removed, const xmlNode *effect,
                    const char *sid, const char *const *members)
{
    const uint32_t end = alpi_xml_end_index(p->document, effect);
    const xmlNode *shader = alpi_collada_shader(effect);
    for (uint32_t i = alpi_xml_index(effect); i < end; i++) {
        const xmlNode *e = p->document->elements[i];
        const char *texture = alpi_xml_attribute(e, "texture");
        bool goes = removed[i];
        for (int k = 0; !goes && members[k] != NULL; k++) {
            goes = e->parent->parent == shader && alpi_xml_is(e->parent, members[k]);
        }
        if (!goes && ((texture != NULL && strcmp(texture, sid) == 0) || says(e, sid))) {
            return true;
        }
    }
    return false;
}

static void drop_params(const alpi_collada_patcher *p, const changes *to, const xmlNode *effect,
                        const char *ending, const char *const *members)
{
    const xmlNode *profile = alpi_collada_shader(effect)->parent->parent;
    uint32_t count = 0;
    const xmlNode *param = alpi_xml_child(profile, "newparam");
    for (; param != NULL && count < PARAM_LIMIT; param = alpi_xml_next(param, "newparam")) {
        const char *sid = alpi_xml_attribute(param, "sid"), *rest = "";
        if (is_ours(sid, &rest) && strcmp(rest, ending) == 0) {
            count++;
            if (!is_read(p, to->removed, effect, sid, members)) {
                take_out(p, to, param);
            }
        }
    }
}

void alpi_collada_tidy_effect(alpi_collada_patcher *p, const xmlNode *effect, alpi_edits *edits,
                              bool *removed)
{
    const changes to = {edits, removed};
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
                take_out(p, &to, extra);
            }
        }
    }
    drop_params(p, &to, effect, "sampler", members); // which read surfaces
    drop_params(p, &to, effect, "surface", members);
}

// --- what nothing names any more -----------------------------------------------------------------

/// Marks the element that a word names, where it begins with one of ours.
static void mark_named(alpi_collada_patcher *p, const char *word, const char *kind)
{
    word += *word == '#';
    const xmlNode *named =
        find_ending(word, kind) != NULL ? alpi_collada_find(p->document, word) : NULL;
    if (named != NULL) {
        p->named[alpi_xml_index(named)] = true;
    }
}

/// Marks what the attributes and the text of an element name.
static void mark_all_named(alpi_collada_patcher *p, const xmlNode *element, const char *kind)
{
    static const char *const others[] = {"id", "sid", "name"};
    const bool rebound = p->rebound[alpi_xml_index(element)];
    const char *text = alpi_xml_text(element);
    mark_named(p, text + strspn(text, " \t\r\n"), kind);
    for (const xmlAttr *a = element->properties; a != NULL; a = a->next) {
        bool names = !(rebound && strcmp((const char *)a->name, "target") == 0);
        for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
            names &= strcmp((const char *)a->name, others[k]) != 0;
        }
        if (names && a->children != NULL && a->children->content != NULL) {
            mark_named(p, (const char *)a->children->content, kind);
        }
    }
}

static void tidy_library(alpi_collada_patcher *p, const char *library, const char *kind)
{
    const alpi_collada_document *d = p->document;
    const changes to = {&p->edits, p->removed};
    for (uint32_t i = 0; i < d->element_count; i++) {
        if (!p->removed[i]) {
            mark_all_named(p, d->elements[i], kind);
        }
    }
    for (uint32_t i = 0; i < d->element_count; i++) {
        const xmlNode *e = d->elements[i];
        if (alpi_xml_is(e, kind) && alpi_xml_is(e->parent, library) &&
            e->parent->parent == d->root && !p->named[i] && !p->removed[i] &&
            find_ending(alpi_xml_attribute(e, "id"), kind) != NULL) {
            take_out(p, &to, e);
        }
    }
}

void alpi_collada_tidy_copies(alpi_collada_patcher *p)
{
    if (may_tidy(p)) {
        tidy_library(p, "library_materials", "material");
        tidy_library(p, "library_effects", "effect"); // which those name
    }
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
        p->named[alpi_xml_index(image)] = true;
    }
    return image != NULL || strcmp(rest, "surface") == 0 || strcmp(rest, "sampler") == 0;
}

void alpi_collada_tidy_images(alpi_collada_patcher *p)
{
    const alpi_collada_document *d = p->document;
    const changes to = {&p->edits, p->removed};
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
        if (alpi_xml_is(d->elements[i], "image") && !p->named[i] && !p->removed[i] &&
            is_ours(id, &rest)) {
            take_out(p, &to, d->elements[i]);
        }
    }
}
