// SPDX-License-Identifier: MIT
// Between the files that write COLLADA: a document, what is changed in its text, what is added.
//
//   collada_plan.c            which geometries get which coordinates and pages; what must be copied
//   collada_patch_mesh.c      the new source, inputs, and indices of primitives
//   collada_patch_uvs.c       the coordinates in that source, and which of them corners have
//   collada_patch_material.c  images, effects and materials
//   collada_patch_again.c     coordinates of an earlier bake, and sets that others read
//   collada_patch_tidy.c      what else an earlier bake left
//   collada_patch_names.c     the word that new ids begin with
//   collada_patch_instance.c  instances: geometry shown, materials bound, sets bound
//   collada_patch_text.c      pieces of XML text
//   collada_write.c           the whole sequence, files
#ifndef ALPI_FORMATS_COLLADA_PATCH_H
#define ALPI_FORMATS_COLLADA_PATCH_H

#include "formats/collada/collada_marks.h"
#include "formats/collada/collada_read.h"
#include "formats/text/text_edits.h"
#include "scene/mesh_patch.h"

/// Marks what several share, in place of whose it is.
#define ALPI_COLLADA_SHARED UINT32_MAX
enum { ALPI_COLLADA_SETS = 3 }; // of coordinates that are blended

/// A material symbol of a geometry whose triangles lie on one page.
typedef struct alpi_collada_symbol {
    const char *old;    // NULL: the primitive names none
    char *name;         // in the written file
    uint32_t page;      // ALPI_NONE: gets no map
    uint32_t surface;   // place of a surface that uses it within those of the placement
    uint32_t input_set; // of the coordinates that the map is read with
} alpi_collada_symbol;

/// A geometry with one set of bake coordinates, and the placements that show it so.
typedef struct alpi_collada_class {
    xmlNode *geometry;
    uint32_t first_surface, surface_end; // of the placement whose coordinates these are
    bool copied;                         // a copy of the geometry, because others show it too
    alpi_collada_symbol *symbols;
    uint32_t symbol_count;
    size_t symbol_capacity;
} alpi_collada_class;

/// Inputs of a primitive that an earlier bake wrote, which share their indices.
typedef struct alpi_collada_own {
    const xmlNode *inputs[ALPI_COLLADA_SETS]; // [count] in the order of the text
    uint32_t numbers[ALPI_COLLADA_SETS];      // [count] of their sets
    uint32_t count, offset;
} alpi_collada_own;

/// A material made for one page.
typedef struct alpi_collada_made {
    uint32_t material; // of the scene, ALPI_NONE: for primitives without one
    uint32_t page;
    char *id;
} alpi_collada_made;

typedef struct alpi_collada_patcher {
    alp_context *context;
    const alp_scene *scene;
    const alpi_mesh_patch *patch;
    const alpi_collada_origin *origin;
    const alpi_collada_document *document;
    alpi_collada_reader reader; // of primitives, once more
    alpi_edits edits;           // of the document's text
    char prefix[32];            // of all new ids; the document does not hold it
    bool endings;               // names of the document were given endings with it
    bool is_1_5;

    uint32_t *pages;           // [scene triangles] page of each, ALPI_NONE = no map
    bool *baked;               // [surface_count]
    uint32_t *first_surfaces;  // [placement_count + 1] surfaces stand by placement
    uint32_t *placement_class; // [placement_count] ALPI_NONE = stays as it is
    alpi_collada_class *classes;
    uint32_t class_count;

    uint32_t
        *effect_pages; // [elements] 1 + the only page of an effect, SHARED = several, 0 = unused
    bool *effect_done; // [elements] edited
    uint32_t *effect_users; // [elements] 1 + the only material of the scene with it, or SHARED
    alpi_collada_made *made;
    uint32_t made_count;
    size_t made_capacity;
    char *const *image_names; // [page_count] files of occlusion, as the document refers to them
    char *const *light_names; // the same of light
    bool *page_used;          // [page_count]
    uint64_t foreign_sets;    // bit n: something else than our maps reads coordinate set n
    uint32_t foreign_set_end; // one past the highest of them
    bool foreign_sets_known;
    bool tidy_known, may_tidy; // whether what an earlier bake left may be taken out
    bool *removed;             // [elements] taken out
    bool *left_out;            // [elements] of the copy of an effect; false between copies
    bool *rebound;             // [elements] an <instance_material> that another one replaces
    bool *named;               // [elements] with an id of ours that something names
    alpi_bytes images, effects, materials; // what the libraries gain
} alpi_collada_patcher;

// --- collada_plan.c ------------------------------------------------------------------------------

alp_result alpi_collada_plan(alpi_collada_patcher *patcher);
/// The symbol of a class for the triangles of `old` on a page; made at its first use. NULL: no
/// memory.
alpi_collada_symbol *alpi_collada_get_symbol(alpi_collada_patcher *patcher,
                                             alpi_collada_class *class_of, const char *old,
                                             uint32_t page, uint32_t surface);

// --- collada_patch_mesh.c ------------------------------------------------------------------------

/// Edits the geometry of a class, or adds its copy behind it; fills its symbols.
alp_result alpi_collada_patch_geometry(alpi_collada_patcher *patcher, uint32_t class_index);
/// id of the geometry of a class in the written file, as it stands in an attribute.
void alpi_collada_print_geometry_id(const alpi_collada_patcher *patcher, uint32_t class_index,
                                    alpi_bytes *text);

// --- collada_patch_again.c -----------------------------------------------------------------------

/// Whether all primitives of a geometry that are baked, and no others, have coordinates of an
/// earlier bake as their last sets, which nothing else reads: the new ones take their place.
bool alpi_collada_takes_anew(alpi_collada_patcher *patcher, const alpi_collada_class *class_of);
/// What held them, where no other element needs it; NULL for the others.
void alpi_collada_own_sources(const alpi_collada_patcher *patcher, const xmlNode *mesh,
                              const xmlNode *sources[ALPI_COLLADA_SETS]);
/// One past the highest set among an element's inputs that are not `own`.
uint32_t alpi_collada_sets_end(const alpi_collada_patcher *patcher, const xmlNode *element,
                               const alpi_collada_own *own);
/// The semantic that set k of a map is bound to. No <texture> names those after the first, which
/// are blended, but a shader may.
const char *alpi_collada_semantic(uint32_t k);
/// Whether a semantic is one of these.
bool alpi_collada_is_our_semantic(const char *semantic);
/// Whether the document says that we wrote it.
bool alpi_collada_was_baked(const alpi_collada_document *document);
/// The first of `count` sets in a row, from `number` on, that nothing else than our maps reads
/// anywhere: a texture bound to a set that is not there must not come to read ours.
uint32_t alpi_collada_free_set(alpi_collada_patcher *patcher, uint32_t number, uint32_t count);
/// The <input>s of a primitive's highest TEXCOORDs where an earlier bake wrote them and their
/// indices are read by no other; none else.
void alpi_collada_own_inputs(const alpi_collada_patcher *patcher, const xmlNode *primitive,
                             alpi_collada_own *own);

/// The <input> that the new one stands before; NULL: it comes last, or where `own` are.
/// Blender shows every texture by the first coordinates of an element, whatever its material binds,
/// and of a material that shows light only that texture counts.
const xmlNode *alpi_collada_next_input(const alpi_collada_patcher *patcher,
                                       const xmlNode *primitive, const alpi_collada_own *own);
/// Puts the text of the new one in its place, and takes `own` out.
void alpi_collada_place_input(const alpi_collada_patcher *patcher, alpi_edits *edits,
                              const xmlNode *primitive, const alpi_collada_own *own,
                              const char *text);

// --- collada_patch_tidy.c ------------------------------------------------------------------------

/// Takes parameters of our earlier maps out of an effect whose maps are about to be replaced, and
/// what their numbers stood for.
/// @param removed [elements] what is taken out: the patcher's, or for a copy one of its own
void alpi_collada_tidy_effect(alpi_collada_patcher *patcher, const xmlNode *effect,
                              alpi_edits *edits, bool *removed);
/// Takes our earlier copies of materials and effects out that nothing names; after instances.
void alpi_collada_tidy_copies(alpi_collada_patcher *patcher);
/// Takes our earlier images out that nothing names; last of all.
void alpi_collada_tidy_images(alpi_collada_patcher *patcher);
/// Notes that an element and all in it is not in the written file.
void alpi_collada_note_removed(const alpi_collada_patcher *patcher, const xmlNode *element,
                               bool *removed);

// --- collada_patch_names.c -----------------------------------------------------------------------

/// New ids begin with a word that stands nowhere in the document.
void alpi_collada_choose_prefix(alpi_collada_patcher *patcher);
/// In the text of the written file: the first such word that what stays of the document leaves
/// free takes its place, so that a file that is baked again and again stays the same.
void alpi_collada_settle_prefix(const alpi_collada_patcher *patcher, alpi_bytes *text);

// --- collada_patch_material.c --------------------------------------------------------------------

/// Which effects are used with one page only.
alp_result alpi_collada_plan_effects(alpi_collada_patcher *patcher);
/// id of the material that shows the map of a page on `material` (NULL: on none).
alp_result alpi_collada_get_material(alpi_collada_patcher *patcher, uint32_t surface, uint32_t page,
                                     const char **id);
/// The elements of library_images.
void alpi_collada_add_images(alpi_collada_patcher *patcher);

// --- collada_patch_instance.c --------------------------------------------------------------------

/// The whole text of a placement's instance as it is to be.
alp_result alpi_collada_print_instance(alpi_collada_patcher *patcher, uint32_t placement,
                                       alpi_bytes *text);
/// Edits all instances; nodes that <instance_node> shows with different maps are written out.
alp_result alpi_collada_patch_instances(alpi_collada_patcher *patcher);

// --- collada_patch_text.c ------------------------------------------------------------------------

static inline const alpi_xml_span *alpi_xml_span_of(const alpi_collada_document *document,
                                                    const xmlNode *node)
{
    return &document->spans[alpi_xml_index(node)];
}
/// One past the last element inside `node`.
uint32_t alpi_xml_end_index(const alpi_collada_document *document, const xmlNode *node);
/// Text for an attribute or content: signs escaped, all but ASCII as numbers, whatever the
/// encoding.
void alpi_xml_print_text(alpi_bytes *text, const char *utf8);
void alpi_xml_print_index(alpi_bytes *text, uint32_t value); ///< a space, then the number
/// Inside the start tag of `node`: the value of an attribute. False without it.
bool alpi_xml_find_value(const alpi_collada_document *document, const xmlNode *node,
                         const char *name, alpi_json_span *value);
/// The start tag, never closed by "/>", with an attribute set to `value`, which is escaped already.
void alpi_xml_print_start(const alpi_collada_document *document, const xmlNode *node,
                          const char *name, const char *value, alpi_bytes *text);
void alpi_xml_print_end(const alpi_collada_document *document, const xmlNode *node,
                        alpi_bytes *text);
/// Puts text before a place of the document.
void alpi_xml_insert(alpi_edits *edits, size_t place, const char *text);
/// Puts text at the end of an element's content, before the child `before` where not NULL.
void alpi_xml_append(const alpi_collada_document *document, alpi_edits *edits, const xmlNode *node,
                     const xmlNode *before, const char *text);
void alpi_xml_replace(const alpi_collada_document *document, alpi_edits *edits, const xmlNode *node,
                      const char *text);

#endif
