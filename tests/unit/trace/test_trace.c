// SPDX-License-Identifier: MIT
// The tracer against brute force: nearest hit, occlusion, alpha cuts, one-sidedness, limits.
#include "soup.h"

#include "base/memory.h"

enum { PACKETS = 400 };

/// Hits of all lanes, those that are left out too, which keep what was there.
static void same_hits(const alpi_hits *fast, const alpi_hits *slow, uint32_t active)
{
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        assert_int_equal(fast->triangle[i], slow->triangle[i]);
        if ((active >> i & 1u) == 0) {
            continue;
        }
        if (slow->triangle[i] != ALPI_NONE) {
            ASSERT_NEAR(fast->distance[i], slow->distance[i], 2e-5);
            ASSERT_NEAR(fast->b1[i], slow->b1[i], 2e-3);
            ASSERT_NEAR(fast->b2[i], slow->b2[i], 2e-3);
            assert_int_equal(fast->behind >> i & 1u, slow->behind >> i & 1u);
        } else {
            assert_true(isinf(fast->distance[i]));
        }
    }
}

/// The same of packets that are traced together, as those of a camera, some of them with lanes left
/// out, so that they go in pairs and alone.
static void agree_together(const alp_scene *scene, const alpi_tracer *tracer,
                           alpi_trace_filter filter)
{
    enum { TOGETHER = 27 };
    alpi_rays rays[TOGETHER];
    const alpi_rays *packets[TOGETHER];
    uint32_t active[TOGETHER];
    alpi_hits fast[TOGETHER], slow;
    for (uint32_t p = 0; p < TOGETHER; p++) {
        soup_rays(&rays[p], 1000 + p);
        packets[p] = &rays[p];
        active[p] = p % 10 == 4 ? 0x5bu : 0xffu;
    }
    memset(fast, 0x55, sizeof fast);
    alpi_trace_nearest_coherent_many(tracer, packets, active, TOGETHER, filter, fast);
    for (uint32_t p = 0; p < TOGETHER; p++) {
        memset(&slow, 0x55, sizeof slow);
        alpi_brute_force_nearest(scene, &rays[p], active[p], filter, &slow);
        same_hits(&fast[p], &slow, active[p]);
    }
}

static void agrees_with_brute_force(alp_scene *scene, alpi_trace_filter filter, int *hit_count)
{
    alpi_tracer *tracer = NULL;
    ASSERT_OK(scene->context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    *hit_count = 0;
    agree_together(scene, tracer, filter);
    for (uint32_t packet = 0; packet < PACKETS; packet++) {
        alpi_rays rays;
        alpi_hits fast, slow;
        soup_rays(&rays, packet);
        uint32_t active = packet % 4 == 0 ? 0x5bu : 0xffu; // lanes left out too
        memset(&fast, 0x55, sizeof fast);
        memset(&slow, 0x55, sizeof slow);
        alpi_trace_nearest(tracer, &rays, active, filter, &fast);
        alpi_brute_force_nearest(scene, &rays, active, filter, &slow);
        same_hits(&fast, &slow, active);
        memset(&fast, 0x55, sizeof fast);
        alpi_trace_nearest_coherent(tracer, &rays, active, filter, &fast);
        same_hits(&fast, &slow, active);
        alpi_rays shadow = rays;
        alpi_trace_occluded(tracer, &shadow, 1, active, filter, (alpi_rays_spread)(packet % 3));
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            if ((active >> i & 1u) == 0) {
                assert_true(shadow.maximum[i] == rays.maximum[i]);
                continue;
            }
            bool hit = slow.triangle[i] != ALPI_NONE;
            *hit_count += hit;
            assert_int_equal(shadow.maximum[i] < 0.0f, hit);
        }
    }
}

/// Rays out of a closed sphere that meet nothing. @param packets even: they go in pairs, where the
///                                                                tracer takes them
static uint32_t count_slips(const alp_scene *scene, const alpi_tracer *tracer,
                            alpi_trace_filter filter, uint32_t packets, bool edges)
{
    enum { TOGETHER = 2 };
    uint32_t slips = 0;
    alpi_rays rays[TOGETHER];
    for (uint32_t packet = 0; packet < packets; packet++) {
        alpi_rays *r = &rays[packet % TOGETHER];
        soup_rays(r, packet);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            r->origin_x[i] *= 0.5f; // inside: √3 / 2 away at most
            r->origin_y[i] *= 0.5f;
            r->origin_z[i] *= 0.5f;
            r->maximum[i] = INFINITY;
        }
        if (edges) {
            soup_aim_at_edges(scene, packet, r);
        }
        if (packet % TOGETHER < TOGETHER - 1) {
            continue;
        }
        alpi_trace_occluded(tracer, rays, TOGETHER, 0xffu, filter, ALPI_RAYS_PAIRED);
        for (uint32_t i = 0; i < TOGETHER * ALPI_PACKET; i++) {
            slips += rays[i / ALPI_PACKET].maximum[i % ALPI_PACKET] >= 0.0f;
        }
    }
    return slips;
}

TEST_WITH_CONTEXT(quick_rays_slip_through_edges_as_rarely_as_is_told, 1)
{
    const uint32_t few = 1u << 12, many = 1u << 18;
    const alpi_trace_filter quick = {.quick = true}, careful = {0};
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1, 200, 100, 1.0, 1); // 40,000 triangles
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    bool worth = true;
    ASSERT_OK(context, alpi_tracer_quicken(tracer, 1e7, NULL, NULL, &worth));
    assert_false(worth); // too few
    ASSERT_OK(context, alpi_tracer_quicken(tracer, 1e9, NULL, NULL, &worth));
    assert_true(worth);
    ASSERT_OK(context, alpi_tracer_quicken(tracer, 1e7, NULL, NULL, &worth));
    assert_false(worth); // whatever was before
    assert_int_equal(count_slips(scene, tracer, careful, few, true), 0);
    const uint32_t aimed = count_slips(scene, tracer, quick, few, true);
    const uint32_t slips = count_slips(scene, tracer, quick, many, false);
    print_message("quick rays that slip: %u of %u at edges, %u of %u random ones\n", aimed,
                  ALPI_PACKET * few, slips, ALPI_PACKET * many);
    assert_true(aimed > 0);  // they are quick
    assert_true(slips <= 8); // one in a million, and four standard errors
    alp_scene_destroy(scene);
}

/// Many small triangles, and a few large ones.
TEST(random_rays_hit_what_brute_force_hits)
{
    const struct {
        uint32_t triangles;
        float size;
    } soups[] = {{600, 0.4f}, {21, 3.0f}};
    for (size_t k = 0; k < sizeof soups / sizeof *soups; k++) {
        alp_context *context = test_context(1);
        alp_scene *scene = soup_make(context, soups[k].triangles, soups[k].size);
        int both = 0, front = 0;
        agrees_with_brute_force(scene, (alpi_trace_filter){0}, &both);
        agrees_with_brute_force(scene, (alpi_trace_filter){.one_sided = true}, &front);
        print_message("%d hits, %d with single-sided surfaces open from behind\n", both, front);
        assert_true(both > PACKETS / 2 && front > PACKETS / 4 && front < both);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Copies the triangles of a mesh with the other winding, before or behind them.
static void add_reversed(test_mesh *mesh, bool before)
{
    const uint32_t count = mesh->triangle_count;
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *v = mesh->triangles[t];
        test_mesh_triangle(mesh, v[1], v[0], v[2]);
    }
    for (uint32_t t = 0; t < count && before; t++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t first = mesh->triangles[t][k];
            mesh->triangles[t][k] = mesh->triangles[count + t][k];
            mesh->triangles[count + t][k] = first;
        }
    }
}

/// A closed sphere of which each triangle is there twice, once reversed: no ray meets a back.
TEST(fronts_are_met_before_backs_in_one_place)
{
    for (int variant = 0; variant < 4; variant++) {
        alp_context *context = test_context(1);
        test_mesh *mesh = test_mesh_start();
        test_mesh_sphere(mesh, (double[]){0.3, -0.2, 0.1}, 0.8, 24, 12, 1.0, 1);
        add_reversed(mesh, variant % 2 == 0);
        alp_scene *scene = test_mesh_scene(context, mesh, variant / 2);
        alpi_tracer *tracer = NULL;
        ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
        uint32_t met = 0;
        for (uint32_t packet = 0; packet < PACKETS; packet++) {
            alpi_rays rays;
            alpi_hits fast, slow;
            soup_rays(&rays, packet);
            memset(&fast, 0, sizeof fast);
            memset(&slow, 0, sizeof slow);
            alpi_trace_nearest(tracer, &rays, 0xffu, (alpi_trace_filter){0}, &fast);
            alpi_brute_force_nearest(scene, &rays, 0xffu, (alpi_trace_filter){0}, &slow);
            assert_int_equal(fast.behind, 0);
            assert_int_equal(slow.behind, 0);
            for (int i = 0; i < ALPI_PACKET; i++) {
                met += fast.triangle[i] != ALPI_NONE;
            }
        }
        assert_true(met > PACKETS);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Two sheets in one tilted plane, cut into different triangles, whose fronts part: the front is
/// met from either side. A sheet further behind than rounding is met as it lies.
TEST(only_fronts_in_the_same_place_count)
{
    for (int apart = 0; apart < 2; apart++) {
        alp_context *context = test_context(1);
        test_mesh *mesh = test_mesh_start();
        const double lift = apart ? 1e-4 : 0.0;
        const double u[3] = {2, 1, 0}, v[3] = {0, 1, 2}, a[3] = {-1, -1, -1};
        const double low[3] = {a[0] - lift, a[1] + 2 * lift, a[2] - lift};
        test_mesh_quad(mesh, a, v, u);
        test_mesh_quad(mesh, low, u, v); // apart: behind the other
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        alpi_tracer *tracer = NULL;
        ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
        uint32_t backs = 0, met = 0;
        for (uint32_t packet = 0; packet < PACKETS; packet++) {
            alpi_rays rays;
            alpi_hits hits;
            soup_rays(&rays, packet);
            memset(&hits, 0, sizeof hits);
            alpi_trace_nearest(tracer, &rays, 0xffu, (alpi_trace_filter){0}, &hits);
            for (int i = 0; i < ALPI_PACKET; i++) {
                met += hits.triangle[i] != ALPI_NONE;
                backs += hits.behind >> i & 1u;
            }
        }
        print_message("%u hits, %u of backs\n", met, backs);
        assert_true(met > PACKETS / 2);
        if (apart) {
            assert_true(backs > met * 9 / 10);
        } else {
            assert_int_equal(backs, 0);
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

static alp_scene *make_octahedron(alp_context *context)
{
    test_mesh *mesh = test_mesh_start();
    for (int k = 0; k < 6; k++) {
        const double at = k % 2 == 0 ? 1.0 : -1.0;
        test_mesh_vertex(mesh, k / 2 == 0 ? at : 0, k / 2 == 1 ? at : 0, k / 2 == 2 ? at : 0);
    }
    for (uint32_t k = 0; k < 8; k++) {
        const uint32_t x = k % 2, y = 2 + k / 2 % 2, z = 4 + k / 4;
        const bool turned = (k % 2 + k / 2 % 2 + k / 4) % 2 != 0;
        test_mesh_triangle(mesh, x, turned ? z : y, turned ? y : z);
    }
    return test_mesh_scene(context, mesh, 0);
}

/// From the middle of a solid exactly through its corners, and the middles of its edges and faces.
TEST(corners_stop_rays)
{
    alp_context *context = test_context(1);
    alp_scene *scene = make_octahedron(context);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    for (int way = 0; way < 27; way++) {
        const vec3 direction = {(float)(way % 3 - 1), (float)(way / 3 % 3 - 1),
                                (float)(way / 9 - 1)}; // not unit, but without rounding
        if (way == 13) {
            continue; // it has no length
        }
        alpi_rays rays[2]; // a pair, where the machine takes them
        alpi_hits hits;
        for (int i = 0; i < 2 * ALPI_PACKET; i++) {
            alpi_rays *packet = &rays[i / ALPI_PACKET];
            if (i % ALPI_PACKET == 0) {
                alpi_rays_clear(packet);
            }
            alpi_rays_set(packet, i % ALPI_PACKET, (vec3){0, 0, 0}, direction, INFINITY);
        }
        alpi_trace_nearest(tracer, rays, 0xffu, (alpi_trace_filter){0}, &hits);
        alpi_trace_occluded(tracer, rays, 2, 0xffu, (alpi_trace_filter){0}, ALPI_RAYS_PAIRED);
        for (int i = 0; i < ALPI_PACKET; i++) {
            assert_true(rays[0].maximum[i] < 0.0f && rays[1].maximum[i] < 0.0f);
            assert_true(hits.triangle[i] != ALPI_NONE && hits.distance[i] <= 1.0f);
        }
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

/// Gives every second triangle a surface whose material is cut by a checkered alpha texture.
static void cut_half(alp_scene *scene)
{
    alp_context *context = scene->context;
    alpi_material *materials = ALPI_NEW(context, alpi_material, 2);
    alpi_surface *surfaces = ALPI_NEW(context, alpi_surface, 2);
    materials[0] = materials[1] = alpi_material_default();
    materials[0].name = alpi_copy_string(context, "solid");
    materials[1].name = alpi_copy_string(context, "cut");
    materials[1].alpha_mode = ALPI_ALPHA_MASK;
    materials[1].base_color_texture.image = 0;
    for (uint32_t s = 0; s < 2; s++) {
        surfaces[s] = scene->surfaces[0];
        surfaces[s].name = alpi_copy_string(context, s ? "cut" : "solid");
        surfaces[s].material = s;
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        scene->triangle_surface[t] = t % 2;
        const float corner[3][2] = {{0, 0}, {4, 0}, {0, 4}};
        for (int k = 0; k < 3; k++) {
            memcpy(scene->uvs[0][scene->triangles[t][k]], corner[k], sizeof corner[k]);
        }
    }
    alpi_release(context, scene->surfaces[0].name);
    alpi_release(context, scene->surfaces);
    for (uint32_t m = 0; m < scene->material_count; m++) {
        alpi_release(context, scene->materials[m].name);
    }
    alpi_release(context, scene->materials);
    scene->surfaces = surfaces;
    scene->surface_count = 2;
    scene->materials = materials;
    scene->material_count = 2;
    scene->images = ALPI_NEW(context, alp_image *, 1);
    scene->image_count = 1;
    ASSERT_OK(context, alp_image_create(context, (alp_image_info){2, 2, 4, ALP_COMPONENT_U8},
                                        &scene->images[0]));
    uint8_t *pixels = alp_image_bytes(scene->images[0]);
    memset(pixels, 255, 16);
    pixels[3] = pixels[15] = 0;
}

TEST_WITH_CONTEXT(alpha_cuts_let_rays_through, 1)
{
    alp_scene *scene = soup_make(context, 600, 0.4f);
    int solid = 0, cut = 0;
    if (scene->uvs[0] == NULL) {
        scene->uvs[0] = alpi_allocate(context, scene->vertex_count, sizeof *scene->uvs[0]);
    }
    agrees_with_brute_force(scene, (alpi_trace_filter){0}, &solid);
    alp_scene_destroy(scene);
    scene = soup_make(context, 600, 0.4f);
    if (scene->uvs[0] == NULL) {
        scene->uvs[0] = alpi_allocate(context, scene->vertex_count, sizeof *scene->uvs[0]);
    }
    cut_half(scene);
    agrees_with_brute_force(scene, (alpi_trace_filter){0}, &cut);
    print_message("%d hits, %d with cuts\n", solid, cut);
    assert_true(cut < solid - PACKETS / 10);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(chosen_surfaces_alone_are_hit, 1)
{
    // Three squares one above the other; rays go down through all of them.
    const float squares[3][4][3] = {
        {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}},
        {{-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1}},
        {{-1, 2, 1}, {1, 2, 1}, {1, 2, -1}, {-1, 2, -1}},
    };
    const uint32_t indices[2][3] = {{0, 1, 2}, {0, 2, 3}};
    alp_mesh meshes[3];
    for (int i = 0; i < 3; i++) {
        meshes[i] = (alp_mesh){.vertex_count = 4,
                               .positions = squares[i][0],
                               .triangle_count = 2,
                               .indices = indices[0]};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 3, &scene));
    for (uint32_t set = 0; set < 8; set++) {
        const bool surfaces[3] = {(set & 1) != 0, (set & 2) != 0, (set & 4) != 0};
        alpi_tracer *tracer = NULL;
        ASSERT_OK(context, alpi_tracer_create(scene, surfaces, NULL, NULL, &tracer));
        alpi_rays rays;
        alpi_rays_clear(&rays);
        for (int i = 0; i < ALPI_PACKET; i++) { // every second from below
            const bool below = i % 2 == 1;
            alpi_rays_set(&rays, i, (vec3){0.25f, below ? -1.0f : 3.0f, 0.1f * (float)i - 0.35f},
                          (vec3){0.0f, below ? 1.0f : -1.0f, 0.0f}, INFINITY);
        }
        const uint32_t top = set >= 4 ? 2 : set >= 2 ? 1 : 0;
        const uint32_t bottom = (set & 1) != 0 ? 0 : (set & 2) != 0 ? 1 : 2;
        for (uint32_t active = 1; active <= 0xffu; active = active == 1 ? 0x5bu : active + 0xa4u) {
            alpi_hits hits; // one lane, some, all of them
            alpi_trace_nearest(tracer, &rays, active, (alpi_trace_filter){0}, &hits);
            for (uint32_t i = 0; i < ALPI_PACKET; i++) {
                const bool below = i % 2 == 1;
                if ((active >> i & 1u) == 0) {
                    continue;
                }
                if (set == 0) {
                    assert_int_equal(hits.triangle[i], ALPI_NONE);
                    assert_true(isinf(hits.distance[i]));
                } else { // the number is that of the scene
                    const uint32_t met = below ? bottom : top;
                    assert_int_equal(hits.triangle[i] / 2, met);
                    ASSERT_NEAR(hits.distance[i], below ? 1.0 + met : 3.0 - met, 1e-6);
                }
                assert_int_equal(hits.behind >> i & 1u, set != 0 && below);
            }
        }
        alpi_tracer_destroy(tracer);
    }
    alpi_tracer_destroy(NULL);
    assert_null(scene->attachments[ALPI_ATTACHMENT_TRACER].data); // none of these stays
    alp_scene_destroy(scene);
}

/// Solids that are wound inwards have their fronts outside, as scene/sides.h says.
TEST_WITH_CONTEXT(sides_of_a_solid_wound_inwards, 1)
{
    static const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint32_t outwards[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    static const uint32_t inwards[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    for (int k = 0; k < 2; k++) {
        const alp_mesh mesh = {.positions = &corners[0][0],
                               .indices = k == 0 ? &outwards[0][0] : &inwards[0][0],
                               .vertex_count = 4,
                               .triangle_count = 4,
                               .double_sided = true,
                               .base_color = {0.5f, 0.5f, 0.5f}};
        alp_scene *scene = NULL;
        alpi_tracer *tracer = NULL;
        alpi_rays rays;
        alpi_hits fast[3], slow;
        ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
        ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
        alpi_rays_clear(&rays);
        for (int i = 0; i < ALPI_PACKET; i++) { // the first half from inside
            const float x = i < 4 ? 0.1f : -1.0f, y = 0.1f + 0.03f * (float)i;
            alpi_rays_set(&rays, i, (vec3){x, y, 0.1f}, (vec3){1.0f, 0.0f, 0.0f}, INFINITY);
        }
        alpi_trace_nearest(tracer, &rays, 0xffu, (alpi_trace_filter){0}, &fast[0]);
        const alpi_rays *const pair[2] = {&rays, &rays};
        const uint32_t active[2] = {0xffu, 0xffu};
        alpi_trace_nearest_coherent_many(tracer, pair, active, 2, (alpi_trace_filter){0}, &fast[1]);
        alpi_brute_force_nearest(scene, &rays, 0xffu, (alpi_trace_filter){0}, &slow);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(fast[i].behind, 0x0fu);
            same_hits(&fast[i], &slow, 0xffu);
        }
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(an_empty_scene_is_never_hit, 1)
{
    test_mesh *mesh = test_mesh_start();
    uint32_t v = test_mesh_vertex(mesh, 0, 0, 0);
    test_mesh_triangle(mesh, v, v, v);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    int hits = 0;
    agrees_with_brute_force(scene, (alpi_trace_filter){0}, &hits);
    assert_int_equal(hits, 0);
    alp_scene_destroy(scene);
}

static bool refuse(void *user, const alp_progress *progress)
{
    (void)user;
    (void)progress;
    return false;
}

TEST_WITH_CONTEXT(building_can_be_cancelled, 1)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1, 500, 390, 1.0, 1); // 0.1 s to build
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alpi_tracer *tracer = NULL;
    alp_result result = alpi_tracer_for_scene(scene, refuse, NULL, &tracer, NULL);
    // A machine fast enough to finish before the first report is no fault.
    assert_true(result == ALP_ERROR_CANCELLED || result == ALP_OK);
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    alp_scene_destroy(scene);
}
