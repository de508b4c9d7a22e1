// SPDX-License-Identifier: MIT
// Faults that cost one element and a warning, and what else is odd. References that lead nowhere
// are gathered while the file is read, and told once for each thing that is missing; other kinds
// once a file.
#include "formats/collada/collada_read.h"

#include "formats/collada/collada_scene.h"

#include <stdio.h>
#include <string.h>

static void note_missing(alpi_collada_reader *reader, const xmlNode *node, const char *name,
                         const char *url)
{
    alpi_collada_missing *list = reader->missing;
    uint32_t at = 0;
    while (at < reader->missing_count &&
           (strcmp(list[at].name, name) != 0 || strcmp(list[at].url, url) != 0)) {
        at++;
    }
    if (at == ALPI_COLLADA_MISSING_LIMIT) {
        reader->missing_more++;
        return;
    }
    if (at == reader->missing_count) {
        list[reader->missing_count++] = (alpi_collada_missing){node, name, url, 0};
    }
    list[at].count++;
}

alp_result alpi_collada_refer(alpi_collada_reader *reader, const xmlNode *node,
                              const char *attribute, const char *name, xmlNode **target)
{
    const char *url = alpi_xml_attribute(node, attribute);
    url = url != NULL ? url + strspn(url, " \t\r\n") : "";
    *target = NULL;
    if (url[0] != '#' && strchr(url, '#') != NULL) { // of another document
        return alpi_collada_resolve(reader->document, node, attribute, name, target);
    }
    xmlNode *found = alpi_collada_target(reader->document, node, attribute);
    if (alpi_xml_is(found, name)) {
        *target = found;
    } else {
        note_missing(reader, node, name, url);
    }
    return ALP_OK;
}

static void tell_missing(const alpi_collada_reader *reader)
{
    for (uint32_t i = 0; i < reader->missing_count; i++) {
        const alpi_collada_missing *m = &reader->missing[i];
        char owner[ALPI_COLLADA_OWNER_SIZE], times[48] = "";
        alpi_collada_owner(reader->document, m->node, owner);
        if (m->count > 1) {
            snprintf(times, sizeof times, ", this reference first: %u", m->count);
        }
        alpi_warn(reader->context, "missing", owner,
                  "\"%.100s\" is no <%s> of the document: left out%s", m->url, m->name, times);
    }
    if (reader->missing_more > 0) {
        alpi_warn(reader->context, "missing", reader->document->path,
                  "references to other things that are not in the document: %u",
                  reader->missing_more);
    }
}

const char *alpi_collada_reason(const alpi_collada_document *document)
{
    const char *message = alp_context_message(document->context);
    const size_t length = strlen(document->path);
    const bool named = strncmp(message, document->path, length) == 0 && message[length] == ':';
    message += named ? length + 1 : 0;
    return message + strspn(message, " ");
}

bool alpi_collada_survives(const alpi_collada_document *document, alp_result *result,
                           char reason[ALPI_COLLADA_REASON_SIZE])
{
    if (*result != ALP_ERROR_INVALID_DATA) {
        return false;
    }
    snprintf(reason, ALPI_COLLADA_REASON_SIZE, "%s", alpi_collada_reason(document));
    *result = ALP_OK;
    return true;
}

/// Elements that cost a warning each, past the limit of such warnings.
static void warn_of_more(const alpi_collada_reader *r)
{
    const char *path = r->document->path;
    if (r->bad_parts > ALPI_COLLADA_TOLD_LIMIT) {
        alpi_warn(r->context, "bad-faces", path, "more primitives that are left out: %u",
                  r->bad_parts - ALPI_COLLADA_TOLD_LIMIT);
    }
    if (r->bad_fixtures > ALPI_COLLADA_TOLD_LIMIT) {
        alpi_warn(r->context, "bad-fixture", path, "more lights or cameras that are left out: %u",
                  r->bad_fixtures - ALPI_COLLADA_TOLD_LIMIT);
    }
}

static void warn_of_geometries(const alpi_collada_reader *r)
{
    char owner[ALPI_COLLADA_OWNER_SIZE];
    if (r->not_meshes > 0) {
        alpi_warn(r->context, "not-mesh", r->document->path,
                  "instances of geometries other than <mesh> (splines, convex hulls, solids) "
                  "left out: %u; export them as meshes",
                  r->not_meshes);
    }
    if (r->empty > 0) {
        alpi_collada_owner(r->document, r->first_empty, owner);
        alpi_warn(r->context, "empty-geometry", owner,
                  "geometries without a triangle are left out, this one first: %u", r->empty);
    }
}

static void warn_of_materials(const alpi_collada_reader *r)
{
    char owner[ALPI_COLLADA_OWNER_SIZE];
    if (r->odd_alpha > 0) {
        alpi_warn(r->context, "alpha", r->document->path,
                  "materials with the invisible opacity that some exporters write for opaque "
                  "ones: %u; read as opaque",
                  r->odd_alpha);
    }
    if (r->lost_sets > 0) {
        alpi_collada_owner(r->document, r->lost_set, owner);
        alpi_warn(r->context, "uv-set", owner,
                  "textures left out because they are bound to a coordinate set that their "
                  "primitive does not have, this one first: %u; correct the input_set",
                  r->lost_sets);
    }
}

static void note_assumptions(const alpi_collada_reader *r)
{
    const char *path = r->document->path;
    if (r->skinned > 0) {
        alpi_note(r->context, "skin", path,
                  "skinned meshes, read in their rest pose, before the skin is applied: %u",
                  r->skinned);
    }
    if (r->morphed > 0) {
        alpi_note(r->context, "morph", path, "meshes read without their morph targets: %u",
                  r->morphed);
    }
    if (r->not_triangles > 0) {
        alpi_note(r->context, "not-triangles", path, "<lines> and <linestrips> left out: %u",
                  r->not_triangles);
    }
    if (r->without_material > 0) {
        alpi_note(r->context, "no-material", path,
                  "primitives without a material, taken as a grey of albedo 0.5: %u",
                  r->without_material);
    }
}

void alpi_collada_tell_oddities(const alpi_collada_reader *reader)
{
    tell_missing(reader);
    warn_of_more(reader);
    warn_of_geometries(reader);
    warn_of_materials(reader);
    note_assumptions(reader);
}

void alpi_collada_tell_losses(const alp_scene *scene)
{
    const alpi_collada_origin *origin = scene->attachments[ALPI_ATTACHMENT_COLLADA].data;
    if (origin == NULL) {
        return;
    }
    const struct {
        uint32_t count;
        const char *kind;
    } losses[] = {{origin->losses.heights, "effects with a bump map of heights"},
                  {origin->losses.gloss_maps, "effects with a texture of specular colour or gloss"},
                  {origin->losses.mirrors, "effects that reflect an environment"},
                  {origin->losses.animations, "animations"}};
    for (size_t i = 0; i < sizeof losses / sizeof *losses; i++) {
        if (losses[i].count > 0) {
            alpi_warn(scene->context, "conversion", origin->document->path,
                      "not carried into another format: %s: %u; write .dae to keep them",
                      losses[i].kind, losses[i].count);
        }
    }
}
