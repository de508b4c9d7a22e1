// SPDX-License-Identifier: MIT
#include "gl/gl_field.h"

#include "field_objects.h"
#include "field_points.h"
#include "gl/gl_buffer.h"
#include "options/options.h"
#include "printing/messages.h"
#include "shaders/bindings.h"

#include <alpenglow/geometry.h>

#include <stdlib.h>

enum { SIDES = 2 };

static int make_buffers(const alp_scene *scene, gl_field *d)
{
    const alp_scene_info info = alp_scene_get_info(scene);
    const size_t vertices = d->read == READ_VERTEX ? alp_scene_get_geometry(scene).vertex_count : 0;
    const size_t objects = d->read == READ_OBJECT ? info.surfaces : 0;
    const int code =
        gl_buffer_load("the field", NULL, SIDES * vertices * sizeof(float[3]), &d->vertices);
    return code == EXIT_DONE
               ? gl_buffer_load("the field", NULL,
                                objects * FIELD_OBJECT_COEFFICIENTS * sizeof(float[4]), &d->objects)
               : code;
}

int gl_field_create(const alp_scene *scene, GLint read, uint32_t width, uint32_t height,
                    gl_field *d)
{
    const bool pixels = read == READ_PIXEL;
    *d = (gl_field){.read = read, .workers = 1};
    glCreateTextures(GL_TEXTURE_2D, 1, &d->pixels);
    glTextureStorage2D(d->pixels, 1, GL_RGBA32F, pixels ? (GLsizei)width : 1,
                       pixels ? (GLsizei)height : 1);
    return make_buffers(scene, d);
}

void gl_field_destroy(gl_field *d)
{
    if (d->pixels != 0) {
        glDeleteBuffers(1, &d->vertices);
        glDeleteBuffers(1, &d->objects);
        glDeleteTextures(1, &d->pixels);
        gl_probes_destroy(&d->probes);
    }
    *d = (gl_field){0};
}

void gl_field_create_reader(const alp_scene *scene, const gl_field *of, gl_field *reader)
{
    *reader = *of;
    (void)make_buffers(scene, reader); // objects are too small to be refused
    reader->changed = true;
}

void gl_field_follow(gl_field *reader, const gl_field *of)
{
    const GLuint vertices = reader->vertices, objects = reader->objects;
    const bool changed = reader->changed || of->changed;
    *reader = *of;
    reader->vertices = vertices;
    reader->objects = objects;
    reader->changed = changed;
}

void gl_field_destroy_reader(gl_field *d)
{
    if (d->vertices != 0) {
        glDeleteBuffers(1, &d->vertices);
        glDeleteBuffers(1, &d->objects);
    }
    *d = (gl_field){0};
}

void gl_field_set(gl_field *d, const alp_field *field)
{
    d->field = field;
    d->changed = true;
}

void gl_field_set_probes(gl_field *d, const alp_probes *probes, const double origin[3])
{
    if (d->read == READ_PIXEL && gl_probes_can_read(probes)) {
        gl_probes_create(probes, origin, &d->probes);
        d->read = READ_PROBES;
    }
}

void gl_field_set_volume(gl_field *d, const gl_lpv *volume, bool gloss)
{
    d->volume = volume;
    d->gloss = gloss;
    d->read = READ_LPV;
}

// --- vertices ------------------------------------------------------------------------------------

static bool has_double_sided(const alp_scene *scene)
{
    const uint32_t count = alp_scene_get_info(scene).surfaces;
    bool found = false;
    for (uint32_t i = 0; i < count && !found; i++) {
        found = alp_scene_get_surface(scene, i).double_sided;
    }
    return found;
}

/// Normals of the backs.
static void turn(const alp_geometry *g, float (*normals)[3])
{
    for (uint32_t i = 0; i < g->vertex_count; i++) {
        for (int k = 0; k < 3; k++) {
            normals[i][k] = -g->normals[i][k];
        }
    }
}

static void read_vertices(const gl_field *d, const alp_scene *scene)
{
    const alp_geometry g = alp_scene_get_geometry(scene);
    const size_t size = (size_t)g.vertex_count * sizeof(float[3]);
    float(*irradiance)[3] = allocate_or_exit(NULL, size + 1), (*backs)[3] = NULL;
    field_points_read(d->field, d->workers, g.vertex_count, g.positions, g.normals, irradiance);
    glNamedBufferSubData(d->vertices, 0, (GLsizeiptr)size, irradiance);
    if (has_double_sided(scene)) {
        backs = allocate_or_exit(NULL, size + 1);
        turn(&g, backs);
        field_points_read(d->field, d->workers, g.vertex_count, g.positions,
                          (const float(*)[3])backs, irradiance);
        glNamedBufferSubData(d->vertices, (GLintptr)size, (GLsizeiptr)size, irradiance);
    }
    free(backs);
    free(irradiance);
}

// --- objects -------------------------------------------------------------------------------------

static void read_objects(const gl_field *d, const alp_scene *scene)
{
    const size_t count = alp_scene_get_info(scene).surfaces;
    float(*coefficients)[FIELD_OBJECT_COEFFICIENTS][4] =
        allocate_or_exit(NULL, count * sizeof *coefficients + 1);
    field_objects_read(d->field, d->workers, scene, coefficients);
    glNamedBufferSubData(d->objects, 0, (GLsizeiptr)(count * sizeof *coefficients), coefficients);
    free(coefficients);
}

void gl_field_update(gl_field *d, const alp_scene *scene)
{
    if (d->changed && d->read == READ_VERTEX) {
        read_vertices(d, scene);
    }
    if (d->changed && d->read == READ_OBJECT) {
        read_objects(d, scene);
    }
    d->changed = false;
}

void gl_field_bind(const gl_field *d, GLuint program)
{
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_FIELD_VERTICES, d->vertices);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_FIELD_OBJECTS, d->objects);
    glBindTextureUnit(TEXTURE_FIELD, d->pixels);
    glUniform1i(UNIFORM_FIELD_READ, d->read);
    gl_probes_bind(&d->probes, program);
    glUniform1i(UNIFORM_LPV_GLOSS, d->gloss);
    if (d->volume != NULL) {
        gl_lpv_bind(d->volume);
    }
}
