// SPDX-License-Identifier: MIT
// A baked COLLADA document: of a mirrored node that is shown twice each place gets its own
// coordinates at the right corners, and what the bake does not touch stays as it was.
#include "test_collada.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/collada/collada_read.h"
#include "formats/formats.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char inside[] = TEST_COLLADA_SQUARE(
    "<polylist count='1'>" TEST_COLLADA_INPUT
    "<vcount>4</vcount><p>0 1 2 3</p></polylist>") "<library_nodes><node id='k'><scale>1 1 "
                                                   "-1</scale><!-- kept --><instance_geometry "
                                                   "url='#g'/>"
                                                   "</node></"
                                                   "library_nodes><library_visual_scenes><visual_"
                                                   "scene id='s'><node><instance_node "
                                                   "url='#k'/></node><node><translate>5 0 "
                                                   "0</translate><instance_node url='#k'/></node>"
                                                   "</visual_scene></"
                                                   "library_visual_scenes>" TEST_COLLADA_SCENE;

TEST_WITH_CONTEXT(mirrored_twice, 1)
{
    alp_scene *old = NULL, *new = NULL;
    ASSERT_OK(context, test_collada_scene(context, inside, &old));
    assert_int_equal(old->triangle_count, 4);
    float uvs[4][3][2];
    for (int t = 0; t < 4; t++) { // by place, so that each corner of a square has its own
        for (int k = 0; k < 3; k++) {
            const float *p = old->positions[old->triangles[t][k]];
            uvs[t][k][0] = p[0] / 8.0f;
            uvs[t][k][1] = p[1] / 2.0f;
        }
    }
    const uint8_t *const pngs[] = {(const uint8_t *)"x"};
    const size_t sizes[] = {1};
    const alpi_mesh_patch patch = {.page_count = 1,
                                   .corner_uvs = (const float(*)[3][2])uvs,
                                   .page_pngs = pngs,
                                   .page_png_sizes = sizes};
    const char *path = test_path(test_folder(), "out.dae");
    ASSERT_OK(context, alpi_scene_write_patched(old, &patch, path, true));
    ASSERT_OK(context, alp_scene_load(context, path, &new));
    assert_int_equal(new->triangle_count, 4);
    for (int t = 0; t < 4; t++) {
        assert_true(new->surfaces[new->triangle_surface[t]].mirrored);
        for (int k = 0; k < 3; k++) {
            const uint32_t v = new->triangles[t][k];
            assert_memory_equal(new->positions[v], old->positions[old->triangles[t][k]], 12);
            ASSERT_NEAR(new->uvs[0][v][0], uvs[t][k][0], 0.0); // eighths and halves are exact
            ASSERT_NEAR(new->uvs[0][v][1], uvs[t][k][1], 0.0);
        }
    }
    size_t size;
    char *text = (char *)test_read_file(path, &size);
    assert_non_null(strstr(text, "<node id=\"k\"><scale>1 1 -1</scale><!-- kept -->"));
    assert_non_null(strstr(text, "<vcount>4</vcount>"));
    free(text);
    alp_scene_destroy(old);
    alp_scene_destroy(new);
}

/// Bakes coordinates by place times `scale` into the document at `path`, every second triangle on
/// a page of its own where wanted; the scene that was written.
static alp_scene *bake_again(alp_context *context, const char *path, const float scale[2],
                             bool two_pages)
{
    static float uvs[8][3][2];
    static uint32_t pages[8];
    const uint8_t *const pngs[] = {(const uint8_t *)"x", (const uint8_t *)"y"};
    const size_t sizes[] = {1, 1};
    alp_scene *old = NULL, *new = NULL;
    ASSERT_OK(context, alp_scene_load(context, path, &old));
    assert_int_equal(old->triangle_count, 4);
    for (uint32_t t = 0; t < 4; t++) {
        pages[t] = two_pages && t % 2 == 1;
        for (int k = 0; k < 3; k++) {
            const float *p = old->positions[old->triangles[t][k]];
            uvs[t][k][0] = scale[0] * p[0];
            uvs[t][k][1] = scale[1] * p[1];
        }
    }
    const alpi_mesh_patch patch = {.page_count = two_pages ? 2 : 1,
                                   .triangle_pages = two_pages ? pages : NULL,
                                   .corner_uvs = (const float(*)[3][2])uvs,
                                   .page_pngs = pngs,
                                   .page_png_sizes = sizes,
                                   .extras_json = "{}"};
    ASSERT_OK(context, alpi_scene_write_patched(old, &patch, path, true));
    ASSERT_OK(context, alp_scene_load(context, path, &new));
    assert_int_equal(new->triangle_count, 4);
    alp_scene_destroy(old);
    return new;
}

/// The last set has the coordinates that bake_again gave.
static void assert_coordinates(const alp_scene *scene, uint32_t sets, const float scale[2])
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        assert_int_equal(scene->surfaces[scene->triangle_surface[t]].uv_sets, sets);
        for (int k = 0; k < 3; k++) {
            const uint32_t v = scene->triangles[t][k];
            ASSERT_NEAR(scene->uvs[sets - 1][v][0], scale[0] * scene->positions[v][0], 0.0);
            ASSERT_NEAR(scene->uvs[sets - 1][v][1], scale[1] * scene->positions[v][1], 0.0);
        }
    }
}

/// Baked once more, whether its triangles lie on one page or two, it still has one set and one
/// source for each geometry; where another texture reads our set, it gets a second one.
TEST_WITH_CONTEXT(baked_again, 1)
{
    size_t size;
    char *text = test_collada_text(inside, &size);
    char *path = alpi_format(context, "%s/again.dae", test_folder());
    ASSERT_OK(context, alpi_file_write(context, path, true, text, size));
    free(text);
    for (int round = 0; round < 6; round++) { // powers of two are exact; 0 takes indices away
        const float scale[2] = {0.125f / (float)(1 << round), round % 3 == 1 ? 0.0f : 0.125f};
        alp_scene *scene = bake_again(context, path, scale, round == 2);
        assert_coordinates(scene, 1, scale);
        alp_scene_destroy(scene);
        text = (char *)test_read_file(path, &size);
        int sources = 0;
        for (const char *at = text; (at = strstr(at, "<source id=\"alpenglow")) != NULL; at++) {
            sources++;
        }
        assert_int_equal(sources, 2); // two places with coordinates of their own
        free(text);
    }
    static const char ours[] = "<bind_vertex_input semantic=\"ALPENGLOW\"";
    text = (char *)test_read_file(path, &size);
    char *place = strstr(text, ours);
    assert_non_null(place);
    memcpy(place, "<bind_vertex_input semantic=\"ANOTHER!!\"", sizeof ours - 1);
    ASSERT_OK(context, alpi_file_write(context, path, true, text, size));
    free(text);
    static const float half[2] = {0.5f, 0.5f};
    alp_scene *scene = bake_again(context, path, half, false);
    assert_coordinates(scene, 2, half);
    alp_scene_destroy(scene);
    alpi_release(context, path);
}

#define TEXTURED_SET(input_set, set)                                                               \
    "<library_images><image id='i'><init_from>i.png</init_from></image></library_images>"          \
    "<library_effects><effect id='e'><profile_COMMON><newparam sid='u'><surface type='2D'>"        \
    "<init_from>i</init_from></surface></newparam><newparam sid='w'><sampler2D><source>u</source>" \
    "</sampler2D></newparam><technique sid='t'><lambert><diffuse><texture texture='w' texcoord"    \
    "='C'/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"           \
    "<library_materials><material id='m'><instance_effect url='#e'/></material>"                   \
    "</library_materials>" TEST_COLLADA_SQUARE(                                                    \
        "<source id='t'><float_array id='ta' count='4'>0 0 1 1</float_array><technique_common>"    \
        "<accessor source='#ta' count='2' stride='2'><param name='S'/><param name='T'/>"           \
        "</accessor></technique_common></source><polylist material='S' count='1'>"                 \
        "<input semantic='TEXCOORD' source='#t' offset='1'" set "/>" TEST_COLLADA_INPUT            \
        "<vcount>4</vcount><p>0 0 1 1 2 0 3 1</p></polylist>") "<library_visual_scenes><visual_"   \
                                                               "scene "                            \
                                                               "id='s'><node><instance_geometry "  \
                                                               "url='#g'>"                         \
                                                               "<bind_material><technique_common>" \
                                                               "<instance_material symbol='S' "    \
                                                               "target='#m'>"                      \
                                                               "<bind_vertex_input semantic='C' "  \
                                                               "input_semantic='TEXCOORD' "        \
                                                               "input_set='" input_set "'/>"       \
                                                               "</instance_material></"            \
                                                               "technique_common></"               \
                                                               "bind_material></"                  \
                                                               "instance_geometry></node>"         \
                                                               "</visual_scene></"                 \
                                                               "library_visual_"                   \
                                                               "scenes>" TEST_COLLADA_SCENE

/// Bakes occlusion or light into `from` or, without it, into what stands there; the new text.
static char *bake_square(alp_context *context, const char *from, const char *path, bool as_light)
{
    static const float uvs[2][3][2] = {{{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {1, 1}, {0, 1}}};
    static const float scales[] = {1, 1};
    const uint8_t *const pngs[] = {(const uint8_t *)"x"};
    const size_t sizes[] = {1};
    const alpi_light_patch light = {
        .pages = pngs, .page_sizes = sizes, .ending = ".png", .scales = scales, .units = "nit"};
    const alpi_mesh_patch patch = {.page_count = 1,
                                   .corner_uvs = uvs,
                                   .page_pngs = as_light ? NULL : pngs,
                                   .page_png_sizes = as_light ? NULL : sizes,
                                   .light = as_light ? &light : NULL,
                                   .extras_json = "{}"};
    size_t size;
    if (from != NULL) {
        char *text = test_collada_text(from, &size);
        ASSERT_OK(context, alpi_file_write(context, path, true, text, size));
        free(text);
    }
    alp_scene *scene = test_load(context, path);
    assert_int_equal(scene->triangle_count, 2);
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, path, true));
    alp_scene_destroy(scene);
    return (char *)test_read_file(path, &size);
}

/// A texture bound to a set that is not there must not come to read our coordinates: they get a
/// number that nothing else names. Read again, it has its own set still.
TEST_WITH_CONTEXT(set_that_nothing_names, 1)
{
    static const char *const texts[] = {TEXTURED_SET("1", ""), TEXTURED_SET("70", " set='69'")};
    static const char *const sets[] = {"2", "71"}; // 1 is free of inputs, but not of readers
    char *path = alpi_format(context, "%s/named.dae", test_folder());
    for (int i = 0; i < 2; i++) {
        char *text = bake_square(context, texts[i], path, false);
        char *input =
            alpi_format(context, "source=\"#alpenglow-uv-0\" offset=\"2\" set=\"%s\"/>", sets[i]);
        char *bind = alpi_format(context,
                                 "semantic=\"ALPENGLOW\" input_semantic=\"TEXCOORD\" "
                                 "input_set=\"%s\"/>",
                                 sets[i]);
        assert_non_null(strstr(text, input));
        assert_non_null(strstr(text, bind));
        alp_scene *scene = test_load(context, path);
        const alpi_material *material = &scene->materials[scene->surfaces[0].material];
        assert_int_not_equal(material->base_color_texture.image, ALPI_NONE);
        assert_int_equal(material->base_color_texture.uv_set, 0);
        assert_int_equal(material->occlusion_texture.uv_set, 1);
        alp_scene_destroy(scene);
        alpi_release(context, input);
        alpi_release(context, bind);
        free(text);
    }
    alpi_release(context, path);
}

/// Of a material that shows light our coordinates are a primitive's first, also baked again;
/// without light they come last. What else the earlier bake left is gone.
TEST_WITH_CONTEXT(light_comes_first, 1)
{
    char *path = alpi_format(context, "%s/first.dae", test_folder());
    for (int as_light = 0; as_light < 2; as_light++) {
        for (int round = 0; round < 2; round++) {
            const char *from = round == 0 ? TEXTURED_SET("0", " set='0'") : NULL;
            char *text = bake_square(context, from, path, as_light == 1);
            static const char wanted[] = "<input semantic=\"TEXCOORD\" source=\"#alpenglow";
            const char *ours = strstr(text, wanted);
            const char *theirs = strstr(text, "<input semantic=\"TEXCOORD\" source=\"#t\"");
            const char *vertex = strstr(text, "<input semantic=\"VERTEX\"");
            assert_true(ours != NULL && theirs != NULL && vertex != NULL);
            assert_true(as_light == 1 ? ours < theirs : ours > theirs && ours > vertex);
            assert_null(strstr(ours + 1, wanted)); // not one for each round
            const char *image = strstr(text, "<image id=\"alpenglow");
            const char *param = strstr(text, "<newparam sid=\"alpenglow");
            param = param != NULL ? strstr(param + 1, "<newparam sid=\"alpenglow") : NULL;
            assert_true(image != NULL && param != NULL); // a surface and a sampler
            assert_null(strstr(image + 1, "<image id=\"alpenglow"));
            assert_null(strstr(param + 1, "<newparam sid=\"alpenglow"));
            const char *strength = strstr(text, "<emission_strength>");
            assert_int_equal(strength != NULL, as_light);
            assert_true(strength == NULL || strstr(strength + 1, "<emission_strength>") == NULL);
            assert_non_null(strstr(text, "<image id=\"i\">"));
            free(text);
        }
    }
    char *text = bake_square(context, NULL, path, false); // light stays beside occlusion
    assert_true(strstr(text, "-light-0\">") != NULL && strstr(text, "-ao-0\">") != NULL);
    assert_true(strstr(text, "-light-sampler\">") != NULL &&
                strstr(text, "-ao-sampler\">") != NULL);
    free(text);
    alpi_release(context, path);
}

/// Images that the document names below its folder go with it to another one; those that are there
/// already are kept, and what cannot be copied stays a reference.
TEST_WITH_CONTEXT(images_go_along, 1)
{
    static const char text[] =
        "<COLLADA version=\"1.4.1\"><library_images><image id=\"a\"><init_from>tex/two%20words.png"
        "</init_from></image><image id=\"b\"><init_from>./tex/two%20words.png</init_from></image>"
        "<image id=\"c\"><init_from>none.png</init_from></image><image id=\"d\"><init_from>../d.png"
        "</init_from></image><image id=\"e\"><init_from>file:///e.png</init_from></image>"
        "</library_images></COLLADA>";
    static const char picture[] = "bytes of a picture";
    char *from = alpi_format(context, "%s/from/tex", test_folder());
    char *to = alpi_format(context, "%s/to", test_folder());
    ASSERT_OK(context, alpi_folder_create(context, from));
    ASSERT_OK(context, alpi_folder_create(context, to));
    char *input = alpi_format(context, "%s/../in.dae", from);
    char *image = alpi_format(context, "%s/two words.png", from);
    char *output = alpi_format(context, "%s/out.dae", to);
    char *copy = alpi_format(context, "%s/tex/two words.png", to);
    ASSERT_OK(context, alpi_file_write(context, input, true, text, strlen(text)));
    ASSERT_OK(context, alpi_file_write(context, image, true, picture, sizeof picture));
    alp_scene *scene = test_load(context, input);
    const alpi_mesh_patch patch = {0};
    for (int round = 0; round < 2; round++) { // what is there already with the same bytes is fine
        ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, output, round == 1));
        size_t size = 0;
        assert_true(test_log_has("images") > 0 && test_log_has("missing-file") > 0);
        char *copied = (char *)test_read_file(copy, &size);
        assert_int_equal(size, sizeof picture);
        assert_memory_equal(copied, picture, size);
        free(copied);
    }
    ASSERT_OK(context, alpi_file_write(context, copy, true, "other", 5));
    (void)remove(output);
    assert_int_equal(alpi_scene_write_patched(scene, &patch, output, false), ALP_ERROR_IO);
    assert_int_equal(access(output, F_OK), -1); // all files or none
    alp_scene_destroy(scene);
    char *const names[] = {from, to, input, image, output, copy};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        alpi_release(context, names[i]);
    }
}

/// A .dae is written only of a scene that was read from one.
TEST_WITH_CONTEXT(other_scenes, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alpi_output_images images = {.occlusion = 1};
    assert_int_equal(alpi_collada_check_outputs(scene, &images, "out.dae", false),
                     ALP_ERROR_UNSUPPORTED);
    alp_scene_destroy(scene);
}
