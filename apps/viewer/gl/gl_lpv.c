// SPDX-License-Identifier: MIT
#include "gl/gl_lpv.h"

#include "gl/gl_program.h"
#include "options/options.h"
#include "passes/shader_list.h"
#include "printing/messages.h"

#include <alpenglow/shared_constants.h>

#include <math.h>
#include <stdio.h>

enum { TERMS = 12, CASCADE_STEPS = 8 };

static GLuint create_texture(const uint32_t size[3], uint32_t times)
{
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &texture);
    glTextureStorage3D(texture, 1, GL_RGBA32F, (GLsizei)size[0], (GLsizei)size[1],
                       (GLsizei)(size[2] * times));
    glClearTexImage(texture, 0, GL_RGBA, GL_FLOAT, NULL);
    return texture;
}

static GLuint create_buffer(const uint32_t size[3], uint32_t terms)
{
    const size_t count = (size_t)size[0] * size[1] * size[2] * terms;
    const GLint zero = 0;
    GLuint buffer = 0;
    glCreateBuffers(1, &buffer);
    glNamedBufferStorage(buffer, (GLsizeiptr)(count * sizeof(GLint)), NULL, GL_DYNAMIC_STORAGE_BIT);
    glClearNamedBufferData(buffer, GL_R32I, GL_RED_INTEGER, GL_INT, &zero);
    return buffer;
}

static int create_programs(gl_lpv *v)
{
    static const gl_shader *const shaders[GL_LPV_PASSES] = {
        [GL_LPV_LIGHT] = &shader_lpv_light_comp,       [GL_LPV_GATHER] = &shader_lpv_gather_comp,
        [GL_LPV_BLOCKERS] = &shader_lpv_blockers_comp, [GL_LPV_MERGE] = &shader_lpv_merge_comp,
        [GL_LPV_FACES] = &shader_lpv_faces_comp,       [GL_LPV_START] = &shader_lpv_start_comp,
        [GL_LPV_STEP] = &shader_lpv_step_comp};
    for (int i = 0; i < GL_LPV_PASSES; i++) {
        v->programs[i] = gl_program_create_compute(shaders[i]);
        if (v->programs[i] == 0) {
            return EXIT_FAILED;
        }
    }
    return EXIT_DONE;
}

/// Whether the card holds textures and buffers of this size. @return EXIT_DONE, or EXIT_FAILED
/// after a message
static int check_size(const alp_lpv_options *o)
{
    GLint side = 0, bytes = 0;
    uint64_t nodes = o->cascades;
    bool fits = true;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &side);
    glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    for (int k = 0; k < 3; k++) {
        const uint64_t times = k == 2 ? 3 * (uint64_t)o->cascades : 1;
        nodes *= o->size[k] + 1;
        fits = fits && (o->size[k] + 1) * times <= (uint64_t)side;
    }
    if (!fits || nodes * TERMS * sizeof(GLint) > (uint64_t)bytes) {
        char text[192];
        snprintf(text, sizeof text,
                 "the graphics card takes no volume of %u x %u x %u cells and %u cascades; give "
                 "fewer (--grid, --cascades), or --read vertex",
                 o->size[0], o->size[1], o->size[2], o->cascades);
        return failure(text);
    }
    return EXIT_DONE;
}

int gl_lpv_create(const alp_lpv_options *o, gl_lpv *v)
{
    const uint32_t cells[3] = {o->size[0], o->size[1], o->size[2] * o->cascades};
    const uint32_t nodes[3] = {o->size[0] + 1, o->size[1] + 1, (o->size[2] + 1) * o->cascades};
    *v = (gl_lpv){.options = *o};
    if (check_size(o) != EXIT_DONE) {
        return EXIT_FAILED;
    }
    v->counts = create_buffer(cells, TERMS);
    v->view = create_buffer(nodes, LPV_NODE_TERMS);
    v->opacities = create_texture(nodes, 1);
    v->albedos = create_texture(nodes, 1);
    v->faces = create_texture(nodes, 3);
    v->colors = create_texture(nodes, 3);
    v->light[0] = create_texture(cells, 3);
    v->light[1] = create_texture(cells, 3);
    v->injected = create_texture(cells, 3);
    v->sum = create_texture(cells, 3);
    return create_programs(v);
}

void gl_lpv_destroy(gl_lpv *v)
{
    if (v->counts == 0) {
        return;
    }
    const GLuint textures[] = {v->opacities, v->albedos,  v->faces,    v->colors,
                               v->light[0],  v->light[1], v->injected, v->sum};
    glDeleteBuffers(1, &v->counts);
    glDeleteBuffers(1, &v->view);
    glDeleteTextures(sizeof textures / sizeof *textures, textures);
    for (int i = 0; i < GL_LPV_PASSES; i++) {
        glDeleteProgram(v->programs[i]); // 0 does nothing
    }
    *v = (gl_lpv){0};
}

/// Sets what all shaders know: lpv_grid.glsl.
static void set_grid(const gl_lpv *v)
{
    const uint32_t *size = v->options.size;
    const bool accurate = v->options.mode == ALP_LPV_ACCURATE;
    const float along = (float)ALP_LPV_ALONG, aside = (float)ALP_LPV_ASIDE;
    glUniform3i(UNIFORM_LPV_SIZE, (GLint)size[0], (GLint)size[1], (GLint)size[2]);
    glUniform1i(UNIFORM_LPV_CASCADES, (GLint)v->options.cascades);
    glUniform3f(UNIFORM_LPV_READ, 1.0f, along, aside);
    glUniform2f(UNIFORM_LPV_GIVE, accurate ? along : 0.0f, accurate ? aside : 1.0f);
    glUniform1f(UNIFORM_LPV_OPACITY, accurate ? (float)ALP_LPV_OPACITY : 1.0f);
    glUniform1i(UNIFORM_LPV_BY_ANGLE, accurate);
}

/// Sets where the grids are: lpv_cascades.glsl.
static void set_places(const gl_lpv *v)
{
    glUniform1f(UNIFORM_LPV_CELL, (float)v->options.cell);
    glUniform3fv(UNIFORM_LPV_CORNERS, LPV_CASCADES_MOST, &v->corners[0][0]);
    glUniform3fv(UNIFORM_LPV_CENTRES, LPV_CASCADES_MOST, &v->centres[0][0]);
}

void gl_lpv_bind(const gl_lpv *v)
{
    set_grid(v);
    set_places(v);
    glBindTextureUnit(TEXTURE_LPV_SUM, v->sum);
}

/// Makes the program of a pass current.
static void use(const gl_lpv *v, int pass)
{
    glUseProgram(v->programs[pass]);
    set_grid(v);
}

static void dispatch(uint32_t wide, uint32_t high, uint32_t deep)
{
    glDispatchCompute((wide + LPV_GROUP_X - 1) / LPV_GROUP_X,
                      (high + LPV_GROUP_Y - 1) / LPV_GROUP_Y,
                      (deep + LPV_GROUP_Z - 1) / LPV_GROUP_Z);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_SHADER_STORAGE_BARRIER_BIT);
}

/// Runs the current program for each of size[0] × size[1] × size[2] × cascades elements.
static void run(const gl_lpv *v, uint32_t more)
{
    const uint32_t *size = v->options.size;
    dispatch(size[0] + more, size[1] + more, (size[2] + more) * v->options.cascades);
}

/// The same for all channels.
static void run_all(const gl_lpv *v)
{
    const uint32_t *size = v->options.size, deep = 3 * size[2] * v->options.cascades;
    dispatch(size[0], size[1], deep);
}

static void bind_image(GLuint unit, GLuint texture, GLenum access)
{
    glBindImageTexture(unit, texture, 0, GL_TRUE, 0, access, GL_RGBA32F);
}

// --- injection -----------------------------------------------------------------------------------

void gl_lpv_follow(gl_lpv *v, const double eye[3], const double forward[3])
{
    for (uint32_t c = 0; c < v->options.cascades; c++) {
        alp_lpv_placement place;
        alp_lpv_place(&v->options, c, eye, forward, &place);
        for (int k = 0; k < 3; k++) {
            v->corners[c][k] = (float)place.corner[k];
            v->centres[c][k] = (float)place.centre[k];
        }
    }
}

void gl_lpv_begin(const gl_lpv *v)
{
    // Clearing is an update, which must wait for what shaders have stored in the frame before.
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glClearTexImage(v->injected, 0, GL_RGBA, GL_FLOAT, NULL);
    glClearTexImage(v->opacities, 0, GL_RGBA, GL_FLOAT, NULL);
    glClearTexImage(v->albedos, 0, GL_RGBA, GL_FLOAT, NULL);
}

static void use_map(const gl_lpv *v, int pass, const gl_lpv_map *map)
{
    use(v, pass);
    set_places(v);
    glUniform1i(UNIFORM_LPV_MAP, map->cascade);
    glBindTextureUnit(0, map->positions);
    glBindTextureUnit(1, map->normals);
}

static void run_map(const gl_lpv_map *map)
{
    glDispatchCompute((map->width + LPV_MAP_GROUP - 1) / LPV_MAP_GROUP,
                      (map->height + LPV_MAP_GROUP - 1) / LPV_MAP_GROUP, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/// Adds what was counted to the light of the maps before.
static void gather(const gl_lpv *v, const float units[3])
{
    use(v, GL_LPV_GATHER);
    glUniform3fv(UNIFORM_LPV_UNITS, 1, units);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_LPV_COUNTS, v->counts);
    bind_image(0, v->injected, GL_READ_WRITE);
    run(v, 0);
}

void gl_lpv_add_light(const gl_lpv *v, const gl_lpv_map *map, const float flux[3])
{
    float units[3];
    for (int k = 0; k < 3; k++) { // a term is at most flux / 2π
        units[k] = fmaxf(flux[k], 1e-30f) / 6.2831853f / 0x1p30f;
    }
    use_map(v, GL_LPV_LIGHT, map);
    glUniform3fv(UNIFORM_LPV_UNITS, 1, units);
    glBindTextureUnit(2, map->flux);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_LPV_COUNTS, v->counts);
    run_map(map);
    gather(v, units);
}

void gl_lpv_add_blockers(const gl_lpv *v, const gl_lpv_map *map, bool only)
{
    use_map(v, GL_LPV_BLOCKERS, map);
    glUniform1i(UNIFORM_LPV_ONLY, only);
    glBindTextureUnit(3, map->albedos);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_LPV_VIEW, v->view);
    run_map(map);
}

void gl_lpv_end_view(const gl_lpv *v)
{
    use(v, GL_LPV_MERGE);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_LPV_VIEW, v->view);
    bind_image(0, v->opacities, GL_READ_WRITE);
    bind_image(1, v->albedos, GL_READ_WRITE);
    run(v, 1);
}

// --- propagation ---------------------------------------------------------------------------------

static uint32_t count_steps(const alp_lpv_options *o)
{
    const uint32_t xy = o->size[0] > o->size[1] ? o->size[0] : o->size[1];
    const uint32_t longest = xy > o->size[2] ? xy : o->size[2];
    return o->iterations > 0 ? o->iterations : o->cascades > 1 ? CASCADE_STEPS : longest;
}

void gl_lpv_propagate(gl_lpv *v)
{
    const uint32_t steps = count_steps(&v->options);
    if (v->options.blockers) {
        use(v, GL_LPV_FACES);
        glBindTextureUnit(0, v->opacities);
        glBindTextureUnit(1, v->albedos);
        bind_image(0, v->faces, GL_WRITE_ONLY);
        bind_image(1, v->colors, GL_WRITE_ONLY);
        run(v, 1);
    }
    use(v, GL_LPV_START);
    glBindTextureUnit(0, v->injected);
    bind_image(0, v->light[0], GL_WRITE_ONLY);
    bind_image(1, v->sum, GL_WRITE_ONLY);
    run_all(v);
    use(v, GL_LPV_STEP);
    glBindTextureUnit(1, v->faces);
    glBindTextureUnit(2, v->colors);
    bind_image(1, v->sum, GL_READ_WRITE);
    for (uint32_t i = 0; i < steps; i++) {
        // Blockers of the surface that light leaves would stop it in the first step.
        const bool blocked = v->options.blockers && i > 0;
        const GLuint now = v->light[0];
        glUniform1i(UNIFORM_LPV_BLOCKED, blocked);
        glUniform1i(UNIFORM_LPV_REFLECTS, blocked && v->options.bounces != 1);
        glBindTextureUnit(0, now);
        bind_image(0, v->light[1], GL_WRITE_ONLY);
        run(v, 0);
        v->light[0] = v->light[1];
        v->light[1] = now;
    }
}
