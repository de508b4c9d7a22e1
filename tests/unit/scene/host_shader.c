// SPDX-License-Identifier: MIT
#include "host_shader.h"

#include "test_support.h"

#include <math.h>

static int64_t wrap(int64_t i, int64_t size, alp_wrap mode)
{
    if (mode == ALP_WRAP_CLAMP) {
        return i < 0 ? 0 : i >= size ? size - 1 : i;
    }
    const int64_t period = mode == ALP_WRAP_MIRROR ? 2 * size : size;
    i = (i % period + period) % period;
    return i < size ? i : period - 1 - i;
}

static double decode(double c)
{
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/// Bilinear, of an 8-bit RGBA image, by public calls alone.
static void sample(const alp_scene *scene, const alp_texture_info *t, const double uv[2], bool srgb,
                   double rgba[4])
{
    const alp_image *image = alp_scene_get_image(scene, t->image);
    assert_non_null(image);
    const alp_image_info info = alp_image_get_info(image);
    const uint8_t *bytes = alp_image_pixels(image);
    double place[2];
    for (int k = 0; k < 2; k++) {
        const float *row = t->transform[k];
        place[k] = (double)row[0] * uv[0] + (double)row[1] * uv[1] + (double)row[2];
    }
    const double x = place[0] * info.width - 0.5, y = place[1] * info.height - 0.5;
    const int64_t x0 = (int64_t)floor(x), y0 = (int64_t)floor(y);
    for (int c = 0; c < 4; c++) {
        rgba[c] = 0.0;
        for (int corner = 0; corner < 4; corner++) {
            const int right = corner & 1, down = corner >> 1;
            const int64_t px = wrap(x0 + right, info.width, t->wrap_u);
            const int64_t py = wrap(y0 + down, info.height, t->wrap_v);
            const double wx = x - floor(x), wy = y - floor(y);
            const double byte = bytes[4 * (py * info.width + px) + c] / 255.0;
            rgba[c] += (right ? wx : 1.0 - wx) * (down ? wy : 1.0 - wy) *
                       (srgb && c < 3 ? decode(byte) : byte);
        }
    }
}

static void interpolate(const alp_scene *scene, uint32_t slot, const uint32_t v[3],
                        const double shares[3], double uv[2])
{
    const alp_geometry g = alp_scene_get_geometry(scene);
    uv[0] = uv[1] = 0.0;
    for (int k = 0; k < 3 && g.uvs[slot] != NULL; k++) {
        uv[0] += shares[k] * (double)g.uvs[slot][v[k]][0];
        uv[1] += shares[k] * (double)g.uvs[slot][v[k]][1];
    }
}

static void normalize(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) {
        v[k] /= length;
    }
}

/// Weights of a blended texture: squares of the normal in the frame of the object.
static void weigh(const alp_scene *scene, const alp_surface_info *surface, const uint32_t v[3],
                  const double shares[3], double weights[3])
{
    const alp_geometry g = alp_scene_get_geometry(scene);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; k++) {
        double m[3] = {0.0, 0.0, 0.0};
        for (int i = 0; i < 9; i++) {
            m[i / 3] += (double)g.normals[v[k]][i % 3] * (double)surface->axes[i / 3][i % 3];
        }
        normalize(m);
        for (int i = 0; i < 3; i++) {
            sum[i] += shares[k] * m[i];
        }
    }
    normalize(sum);
    for (int i = 0; i < 3; i++) {
        weights[i] = sum[i] * sum[i];
    }
}

static void look_up(const alp_scene *scene, const alp_surface_info *surface,
                    const alp_texture_info *t, const uint32_t v[3], const double shares[3],
                    double rgba[4])
{
    double uv[2], weights[3], part[4];
    bool blended = t->blended;
    for (int k = 0; k < 3; k++) {
        blended = blended && (surface->uv_slots >> t->slots[k] & 1u) != 0;
    }
    if (!blended) {
        interpolate(scene, t->uv_slot, v, shares, uv);
        sample(scene, t, uv, true, rgba);
        return;
    }
    weigh(scene, surface, v, shares, weights);
    memset(rgba, 0, 4 * sizeof *rgba);
    for (int k = 0; k < 3; k++) {
        interpolate(scene, t->slots[k], v, shares, uv);
        sample(scene, t, uv, true, part);
        for (int i = 0; i < 4; i++) {
            rgba[i] += weights[k] * part[i];
        }
    }
}

void host_shade(const alp_scene *scene, uint32_t triangle, double b1, double b2, double rgba[4])
{
    const alp_geometry g = alp_scene_get_geometry(scene);
    const alp_surface_info surface = alp_scene_get_surface(scene, g.triangle_surfaces[triangle]);
    const alp_material_info m = alp_scene_get_material(scene, surface.material_index);
    const double shares[3] = {1.0 - b1 - b2, b1, b2};
    double vertex[4] = {0.0, 0.0, 0.0, 0.0}, texel[4] = {1.0, 1.0, 1.0, 1.0};
    for (int k = 0; k < 3; k++) {
        const uint32_t v = g.triangles[triangle][k];
        for (int i = 0; i < 4; i++) {
            vertex[i] += shares[k] * (g.colors != NULL ? (double)g.colors[v][i] : 1.0);
        }
    }
    if (m.base_color_texture.image != ALP_NONE) {
        look_up(scene, &surface, &m.base_color_texture, g.triangles[triangle], shares, texel);
    }
    for (int i = 0; i < 4; i++) {
        rgba[i] = (double)m.base_color[i] * vertex[i] * texel[i];
        rgba[i] = i < 3 ? fmin(fmax(rgba[i], 0.0), 0.95) : rgba[i];
    }
}
