// SPDX-License-Identifier: MIT
// Files that an asset names outside of its folder: not read unless the context allows it, and never
// written. Links are read either way: the folder's owner made them.
#include "test_small_bake.h"

#include "base/image.h"
#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/// The scene's folder, "…/3", from "…/3/scene.dae".
static void folder_of(const test_small_bake *bake, char folder[512])
{
    snprintf(folder, 512, "%s", bake->scene);
    *strrchr(folder, '/') = '\0';
}

/// Has the asset name this in the place of its picture "wood.png".
static void name_picture(const test_small_bake *bake, const char *name)
{
    char folder[512];
    folder_of(bake, folder);
    const bool is_obj = strstr(bake->scene, ".obj") != NULL;
    const char *path = is_obj ? test_path(folder, "scene.mtl") : bake->scene;
    size_t size;
    char *text = (char *)test_read_file(path, &size);
    char *place = strstr(text, "wood.png");
    assert_non_null(place);
    const size_t room = size + strlen(name) + 1;
    char *changed = malloc(room);
    assert_non_null(changed);
    snprintf(changed, room, "%.*s%s%s", (int)(place - text), text, name,
             place + strlen("wood.png"));
    write_text(path, changed);
    free(changed);
    free(text);
}

static char last_log[1 << 14];

static void keep_log(void *user, const alp_log_message *message)
{
    (void)user;
    const size_t used = strlen(last_log);
    snprintf(last_log + used, sizeof last_log - used, "%s: %s\n", message->code, message->text);
}

static alp_context *make_context(bool outside)
{
    alp_context_options options = alp_context_options_default();
    options.worker_count = 1;
    options.read_outside = outside;
    options.log = keep_log;
    alp_context *context = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    last_log[0] = '\0';
    return context;
}

/// Whether the picture is read, from an asset that names it so. A refusal names the
/// option that allows it.
static bool is_read(int kind, const char *name, bool outside, const char *hint)
{
    test_small_bake bake = test_small_bake_open(kind);
    name_picture(&bake, name);
    char folder[512];
    folder_of(&bake, folder);
    assert_int_equal(unlink(test_path(folder, "wood.png")), 0); // else it is found by its own name
    alp_context *context = make_context(outside);
    alp_scene *scene = NULL;
    const alp_result result = alp_scene_load(context, bake.scene, &scene);
    bool has_picture = false;
    for (uint32_t i = 0; result == ALP_OK && i < scene->image_count; i++) {
        has_picture |= scene->images[i] != NULL;
    }
    if (!has_picture && hint != NULL) {
        const char *text = result == ALP_OK ? last_log : alp_context_message(context);
        if (strstr(text, hint) == NULL) {
            fail_msg("%s: %s: \"%s\" was told", bake.kind, name, text);
        }
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    test_small_bake_close(&bake);
    return has_picture;
}

/// A folder that is no asset's, with the picture in it; its name begins behind the last slash.
static const char *make_elsewhere(void)
{
    test_small_bake bake = test_small_bake_open(2);
    char folder[512], command[2048];
    static char elsewhere[512];
    folder_of(&bake, folder);
    snprintf(elsewhere, sizeof elsewhere, "%s", test_folder());
    snprintf(command, sizeof command, "cp '%s/wood.png' '%s/wood.png'", folder, elsewhere);
    assert_int_equal(system(command), 0);
    test_small_bake_close(&bake);
    return elsewhere;
}

TEST(names_outside)
{
    const char *elsewhere = make_elsewhere(), *name = strrchr(elsewhere, '/') + 1;
    char text[8][1024];
    snprintf(text[0], 1024, "../%s/wood.png", name);
    snprintf(text[1], 1024, "none/../../%s/wood.png", name);
    snprintf(text[2], 1024, "%s/wood.png", elsewhere);
    snprintf(text[3], 1024, "file://%s/wood.png", elsewhere);
    snprintf(text[4], 1024, "..%%2f%s%%2Fwood.png", name);
    snprintf(text[5], 1024, "%%2e./%s/wood.png", name);
    snprintf(text[6], 1024, "..\\%s\\wood.png", name);
    snprintf(text[7], 1024, "https://localhost/wood.png");
    // Each format has its own addresses: an OBJ knows no schemes, and decodes no escapes of "..".
    static const bool allowed[3][8] = {{true, true, true, true, true, true, true, false},
                                       {true, true, true, true, true, true, true, false},
                                       {true, true, true, false, false, false, true, false}};
    for (int kind = 0; kind < 3; kind++) {
        for (int i = 0; i < 8; i++) {
            const bool is_path = i != 7 && (kind != 2 || allowed[kind][i]);
            if (kind == 0 && i == 6) { // in JSON a backslash is escaped
                snprintf(text[6], 1024, "..\\\\%s\\\\wood.png", name);
            } else if (i == 6) {
                snprintf(text[6], 1024, "..\\%s\\wood.png", name);
            }
            assert_false(is_read(kind, text[i], false, is_path ? "--allow-outside" : NULL));
            if (is_read(kind, text[i], true, NULL) != allowed[kind][i]) {
                fail_msg("kind %d, %s: allowed, but %d", kind, text[i], !allowed[kind][i]);
            }
        }
    }
}

/// The scene of an asset that names its picture so, "wood.png" beside it.
static alp_scene *load_named(const test_small_bake *bake, alp_context *context, const char *name)
{
    alp_scene *scene = NULL;
    name_picture(bake, name);
    ASSERT_OK(context, alp_scene_load(context, bake->scene, &scene));
    return scene;
}

/// Paths of other machines and other cases lead to the file of that name beside the asset.
TEST(names_of_people)
{
    static const char *const names[] = {"C:/x/wood.png",      "file:///C:/x/wood.png",
                                        "/Users/x/wood.png",  "../textures/wood.png",
                                        "WOOD.png",           "file:///home/x/Wood.PNG",
                                        "textures/wood.png",  "https://localhost/wood.png",
                                        "C:\\\\x\\\\wood.png"}; // escaped as in JSON
    for (int kind = 0; kind < 3; kind++) {
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
            test_small_bake bake = test_small_bake_open(kind);
            alp_context *context = make_context(false);
            alp_scene *scene = load_named(&bake, context, names[i]);
            if (scene->images[0] == NULL) {
                fail_msg("%s: %s: %s", bake.kind, names[i], last_log);
            }
            const char *note = strstr(last_log, "image-path: ");
            assert_non_null(note);
            assert_null(strstr(note + 1, "image-path: "));
            assert_null(strstr(last_log, "--allow-outside"));
            alp_scene_destroy(scene);
            alp_context_destroy(context);
            test_small_bake_close(&bake);
        }
    }
}

/// A picture that was found goes with the baked asset, which finds it too.
TEST(found_pictures_are_copied)
{
    for (int kind = 0; kind < 2; kind++) {
        test_small_bake bake = test_small_bake_open(kind);
        unlink(test_path(bake.folder, "wood.png"));
        alp_context *context = make_context(false);
        alp_scene *scene = load_named(&bake, context, "C:/x/Wood.png"), *baked = NULL;
        alp_bake_options options = alp_bake_options_default();
        options.atlas.size = 8;
        options.atlas.padding = 1;
        options.occlusion.samples = 4;
        options.output = bake.output;
        options.overwrite = true;
        ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
        assert_int_equal(access(test_path(bake.folder, "wood.png"), F_OK), 0);
        ASSERT_OK(context, alp_scene_load(context, bake.output, &baked));
        assert_non_null(baked->images[0]);
        alp_scene_destroy(scene);
        alp_scene_destroy(baked);
        alp_context_destroy(context);
        test_small_bake_close(&bake);
    }
}

/// A link in the folder is the work of who made the folder.
TEST(links_are_followed)
{
    const char *elsewhere = make_elsewhere();
    for (int kind = 0; kind < 3; kind++) {
        test_small_bake bake = test_small_bake_open(kind);
        char folder[512], link[600], target[600];
        folder_of(&bake, folder);
        snprintf(link, sizeof link, "%s/wood.png", folder);
        snprintf(target, sizeof target, "%s/wood.png", elsewhere);
        for (int loops = 0; loops < 2; loops++) {
            assert_int_equal(unlink(link), 0);
            assert_int_equal(symlink(loops ? "wood.png" : target, link), 0);
            alp_context *context = make_context(false);
            alp_scene *scene = NULL;
            const alp_result result = alp_scene_load(context, bake.scene, &scene);
            const bool has_picture = result == ALP_OK && scene->images[0] != NULL;
            assert_int_equal(has_picture, !loops);
            const char *text = result == ALP_OK ? last_log : alp_context_message(context);
            assert_true(!loops || strstr(text, "Too many levels of symbolic links") != NULL);
            alp_scene_destroy(scene);
            alp_context_destroy(context);
        }
        test_small_bake_close(&bake);
    }
}

/// A .gltf that names its picture by ".." is baked into another folder: the picture is not copied
/// to where that leads from there, and the user is told once.
TEST(nothing_is_written_outside)
{
    const char *elsewhere = make_elsewhere();
    char name[1024], beside[2048];
    test_small_bake bake = test_small_bake_open(0);
    bake.as = ALP_LIGHTMAP_AS_EXTRAS; // an emissive map would leave the picture without use
    snprintf(name, sizeof name, "../%s/wood.png", strrchr(elsewhere, '/') + 1);
    name_picture(&bake, name);
    alp_context *context = make_context(true);
    ASSERT_OK(context, test_small_bake_run(&bake, context));
    const char *told = strstr(last_log, "outside-file: ");
    assert_non_null(told);
    assert_null(strstr(told + 1, "outside-file: "));
    snprintf(beside, sizeof beside, "%s/%s", bake.folder, name);
    assert_int_not_equal(access(beside, F_OK), 0);
    alp_context_destroy(context);
    test_small_bake_close(&bake);
}
