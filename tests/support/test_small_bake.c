// SPDX-License-Identifier: MIT
#include "test_small_bake.h"

#include "base/image.h"
#include "test_collada.h"
#include "test_obj.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const char precious[] = "precious";

// --- memory --------------------------------------------------------------------------------------

static void *allocate_but_one(void *user, size_t size)
{
    test_memory *memory = user;
    if (atomic_fetch_add(&memory->count, 1) == memory->failing) {
        return NULL;
    }
    atomic_fetch_add(&memory->live, 1);
    return malloc(size);
}

static void release_counted(void *user, void *pointer)
{
    test_memory *memory = user;
    atomic_fetch_sub(&memory->live, pointer != NULL);
    free(pointer);
}

static void run_backwards(void *user, uint32_t count, uint32_t grain, alp_range_fn *body,
                          void *body_user)
{
    (void)user;
    for (uint32_t ranges = (count + grain - 1) / grain; ranges > 0; ranges--) {
        const uint32_t begin = (ranges - 1) * grain;
        body(body_user, begin, count - begin < grain ? count : begin + grain, 0);
    }
}

alp_context *test_memory_context(test_memory *memory, uint32_t workers)
{
    alp_context_options options = alp_context_options_default();
    options.allocate = allocate_but_one;
    options.release = release_counted;
    options.allocator_user = memory;
    options.worker_count = workers;
    options.parallel_for = memory->backwards ? run_backwards : NULL;
    const long failing = memory->failing;
    memory->failing = -1;
    alp_context *context = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    atomic_store(&memory->count, 0);
    memory->failing = failing;
    return context;
}

// --- scenes --------------------------------------------------------------------------------------

/// A floor with a picture and a small lamp above it, which looks down.
static void write_gltf(const char *folder)
{
    static const float bin[] = {
        -1,   0,   1,   1,   0,   1,   1,   0,   -1,   -1,   0,   -1, // floor
        0,    0,   1,   0,   1,   1,   0,   1,                        // its coordinates; the lamp
        -.3f, .5f, .3f, .3f, .5f, .3f, .3f, .5f, -.3f, -.3f, .5f, -.3f};
    static const unsigned char indices[] = {0, 1, 2, 0, 2, 3, 0, 2, 1, 0, 3, 2};
    static const char text[] =
        "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0,1]}],"
        "'nodes':[{'name':'floor','mesh':0},{'name':'lamp','mesh':1}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'indices':3,"
        "'material':0}]},{'primitives':[{'attributes':{'POSITION':2},'indices':4,'material':1}]}],"
        "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0},"
        "'metallicFactor':0}},"
        "{'emissiveFactor':[1,1,1]}],'textures':[{'source':0}],'images':[{'uri':'wood.png'}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':4},"
        "{'bufferView':0,'byteOffset':48,'componentType':5126,'type':'VEC2','count':4},"
        "{'bufferView':0,'byteOffset':80,'componentType':5126,'type':'VEC3','count':4},"
        "{'bufferView':1,'componentType':5121,'type':'SCALAR','count':6},"
        "{'bufferView':1,'byteOffset':6,'componentType':5121,'type':'SCALAR','count':6}],"
        "'bufferViews':[{'buffer':0,'byteLength':128},{'buffer':0,'byteOffset':128,"
        "'byteLength':12}],'buffers':[{'byteLength':140,'uri':'scene.bin'}]}";
    char json[sizeof text];
    for (size_t i = 0; i < sizeof text; i++) {
        json[i] = text[i] == '\'' ? '"' : text[i];
    }
    unsigned char bytes[sizeof bin + sizeof indices];
    memcpy(bytes, bin, sizeof bin);
    memcpy(bytes + sizeof bin, indices, sizeof indices);
    test_write_text(test_path(folder, "scene.gltf"), json);
    test_write_file(test_path(folder, "scene.bin"), bytes, sizeof bytes);
}

/// The same square twice, with coordinates: the floor, and turned over the lamp.
static const char collada_inside[] =
    "<library_images><image id='i'><init_from>wood.png</init_from></image></library_images>"
    "<library_effects><effect id='e'><profile_COMMON><newparam sid='f'><surface type='2D'>"
    "<init_from>i</init_from></surface></newparam><newparam sid='t'><sampler2D><source>f"
    "</source></sampler2D></newparam><technique sid='c'><lambert><diffuse><texture "
    "texture='t' texcoord='UV'/></diffuse></lambert></technique></profile_COMMON></effect>"
    "<effect id='l'><profile_COMMON><technique sid='c'><lambert><emission><color>1 1 1 1"
    "</color></emission></lambert></technique></profile_COMMON></effect></library_effects>"
    "<library_materials><material id='m'><instance_effect url='#e'/></material>"
    "<material id='o'><instance_effect url='#l'/></material></library_materials>"
    "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='pa' "
    "count='12'>0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common><accessor "
    "source='#pa' count='4' stride='3'><param name='X' type='float'/><param name='Y' "
    "type='float'/><param name='Z' type='float'/></accessor></technique_common></source>"
    "<source id='c'><float_array id='ca' count='8'>0 0 1 0 1 1 0 1</float_array>"
    "<technique_common><accessor source='#ca' count='4' stride='2'><param name='S' "
    "type='float'/><param name='T' type='float'/></accessor></technique_common></source>"
    "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
    "<polylist count='1' material='m'><input semantic='VERTEX' source='#v' offset='0'/>"
    "<input semantic='TEXCOORD' source='#c' offset='0' set='0'/><vcount>4</vcount>"
    "<p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>"
    "<library_visual_scenes><visual_scene id='s'><node id='n'><instance_geometry url='#g'>"
    "<bind_material><technique_common><instance_material symbol='m' target='#m'>"
    "<bind_vertex_input semantic='UV' input_semantic='TEXCOORD' input_set='0'/>"
    "</instance_material></technique_common></bind_material></instance_geometry></node>"
    "<node id='lamp'><matrix>.3 0 0 .3 0 -.3 0 .7 0 0 -.3 .5 0 0 0 1</matrix>"
    "<instance_geometry url='#g'><bind_material><technique_common><instance_material "
    "symbol='m' target='#o'/></technique_common></bind_material></instance_geometry></node>"
    "</visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE;

static void write_collada(const char *folder)
{
    size_t size;
    char *text = test_collada_text(collada_inside, &size);
    test_write_file(test_path(folder, "scene.dae"), text, size);
    free(text);
}

static void write_obj(const char *folder)
{
    test_write_text(test_path(folder, "scene.obj"),
                    "mtllib scene.mtl\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\n"
                    "vt 1 1\nvt 0 1\nv -.3 .5 .3\nv .3 .5 .3\nv .3 .5 -.3\nv -.3 .5 -.3\n"
                    "o floor\nusemtl wood\nf 1/1 2/2 3/3 4/4\no lamp\nusemtl lamp\nf 8 7 6 5\n");
    test_write_text(test_path(folder, "scene.mtl"),
                    "newmtl wood\nKd 1 1 1\nmap_Kd wood.png\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n");
}

static void write_picture(const char *path)
{
    alp_context *context = test_context(1);
    alp_image *image = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){2, 2, 3, ALP_COMPONENT_U8}, &image));
    memset(image->pixels, 160, 12);
    ASSERT_OK(context, alp_image_save(image, path, true));
    alp_image_destroy(image);
    alp_context_destroy(context);
}

// --- the bake ------------------------------------------------------------------------------------

alp_result test_small_bake_run(const test_small_bake *bake, alp_context *context)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = 8;
    options.atlas.padding = 1;
    options.maps = ALP_MAP_AO | ALP_MAP_LIGHT;
    options.occlusion.samples = 4;
    options.light.samples = 2;
    options.light.bounces = 1;
    options.light.layers = bake->as == ALP_LIGHTMAP_AS_EMISSIVE && bake->format == ALP_MAPS_EXR;
    options.lightmap_as = bake->as;
    options.maps_format = bake->format;
    options.output = bake->output;
    options.maps_folder = bake->maps;
    options.overwrite = true;
    options.sampling.memory_limit = bake->memory_limit;
    alp_scene *scene = NULL;
    alp_result result = alp_scene_load(context, bake->scene, &scene);
    if (result == ALP_OK) {
        result = alp_bake(scene, &options, NULL, NULL);
    }
    alp_scene_destroy(scene);
    return result;
}

// --- its files -----------------------------------------------------------------------------------

static void keep_files(test_small_bake *bake, const char *folder)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, NULL, alphasort);
    assert_true(count >= 0);
    for (int i = 0; i < count; i++) {
        char path[1024];
        struct stat about;
        snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        assert_int_equal(stat(path, &about), 0);
        if (S_ISREG(about.st_mode)) {
            assert_in_range(bake->file_count, 0, TEST_SMALL_BAKE_FILES - 1);
            const uint32_t n = bake->file_count++;
            bake->files[n] = strdup(path);
            bake->bytes[n] = test_read_file(path, &bake->sizes[n]);
        }
        free(entries[i]);
    }
    free((void *)entries);
}

static uint32_t count_entries(const char *folder)
{
    DIR *stream = opendir(folder);
    uint32_t count = 0;
    for (const struct dirent *entry; stream != NULL && (entry = readdir(stream)) != NULL;) {
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    }
    if (stream != NULL) {
        closedir(stream);
    }
    return count;
}

void test_small_bake_reset(const test_small_bake *bake)
{
    mkdir(bake->maps, 0777);
    for (uint32_t i = 0; i < bake->file_count; i++) {
        test_write_text(bake->files[i], precious);
    }
}

void test_small_bake_clear(const test_small_bake *bake)
{
    for (uint32_t i = 0; i < bake->file_count; i++) {
        unlink(bake->files[i]);
    }
    rmdir(bake->maps);
}

test_small_bake_state test_small_bake_look(const test_small_bake *bake)
{
    test_small_bake_state state = {0};
    for (uint32_t i = 0; i < bake->file_count; i++) {
        if (access(bake->files[i], F_OK) != 0) {
            state.missing++;
            continue;
        }
        size_t size;
        unsigned char *bytes = test_read_file(bake->files[i], &size);
        const bool is_old = size == strlen(precious) && memcmp(bytes, precious, size) == 0;
        const bool is_new = size == bake->sizes[i] && memcmp(bytes, bake->bytes[i], size) == 0;
        state.old += is_old;
        state.new += is_new;
        state.neither += !is_old && !is_new;
        free(bytes);
    }
    const uint32_t entries = count_entries(bake->folder) + count_entries(bake->maps);
    state.others = entries - (access(bake->maps, F_OK) == 0) - (bake->file_count - state.missing);
    return state;
}

test_small_bake test_small_bake_open(int kind)
{
    static const struct {
        const char *name, *from, *to;
        void (*write)(const char *folder);
        alp_lightmap_as as;
        alp_maps_format format;
    } kinds[TEST_SMALL_BAKE_KINDS] = {
        {".gltf -> .gltf", ".gltf", ".gltf", write_gltf, ALP_LIGHTMAP_AS_EMISSIVE, ALP_MAPS_EXR},
        {".dae -> .dae", ".dae", ".dae", write_collada, ALP_LIGHTMAP_AS_EMISSIVE, ALP_MAPS_HDR},
        {".obj -> .obj", ".obj", ".obj", write_obj, ALP_LIGHTMAP_AS_EMISSIVE, ALP_MAPS_KTX2},
        {".gltf -> .glb", ".gltf", ".glb", write_gltf, ALP_LIGHTMAP_AS_EXTRAS, ALP_MAPS_EXR},
        {".obj -> .json", ".obj", ".json", write_obj, ALP_LIGHTMAP_AS_THREE, ALP_MAPS_EXR},
        {".dae -> .babylon", ".dae", ".babylon", write_collada, ALP_LIGHTMAP_AS_BABYLON,
         ALP_MAPS_EXR}};
    test_small_bake bake = {
        .kind = kinds[kind].name, .as = kinds[kind].as, .format = kinds[kind].format};
    const char *folder = test_folder();
    kinds[kind].write(folder);
    write_picture(test_path(folder, "wood.png"));
    snprintf(bake.scene, sizeof bake.scene, "%s/scene%s", folder, kinds[kind].from);
    snprintf(bake.folder, sizeof bake.folder, "%s/out", folder);
    snprintf(bake.output, sizeof bake.output, "%s/out/baked%s", folder, kinds[kind].to);
    snprintf(bake.maps, sizeof bake.maps, "%s/out/maps", folder);
    assert_int_equal(mkdir(bake.folder, 0777), 0);
    alp_context *context = test_context(1);
    ASSERT_OK(context, test_small_bake_run(&bake, context));
    alp_context_destroy(context);
    keep_files(&bake, bake.folder);
    keep_files(&bake, bake.maps);
    test_small_bake_reset(&bake);
    return bake;
}

void test_small_bake_close(test_small_bake *bake)
{
    for (uint32_t i = 0; i < bake->file_count; i++) {
        free(bake->files[i]);
        free(bake->bytes[i]);
    }
    *bake = (test_small_bake){0};
}
