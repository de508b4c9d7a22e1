// SPDX-License-Identifier: MIT
#include "view_capture.h"

#include "gl/gl_cube.h"
#include "sh_values.h"

int capture_read(const command_line *a, const double origin[3], float point[3])
{
    double numbers[3];
    const char *text = a->values[OPTION_CAPTURE].text;
    const char *end = number_parse_list(text, numbers, 3);
    if (end == NULL || *end != '\0') {
        return usage_error(a->command, "--capture: '%s' is no point; give X,Y,Z in metres", text);
    }
    for (int k = 0; k < 3; k++) {
        point[k] = (float)(numbers[k] - origin[k]);
    }
    return EXIT_DONE;
}

static int capture(view_job *job, const gl_cube *cube)
{
    const alp_scene_info info = alp_scene_get_info(job->session.scene);
    const option_value *convention = &job->arguments->values[OPTION_CONVENTION];
    float point[3];
    alp_sh9 radiance;
    int code = capture_read(job->arguments, info.origin, point);
    if (code == EXIT_DONE) {
        job->drawing.background.sun_count = 0; // too small for texels
        gl_cube_draw(cube, &job->drawing, point);
        gl_cube_project(cube, &radiance);
        code = gl_context_check(&job->gl);
    }
    return code == EXIT_DONE
               ? session_end(&job->session,
                             sh_values_print(&radiance, (alp_sh_convention)convention->choice))
               : code;
}

int view_capture(view_job *job)
{
    gl_cube cube;
    int code = gl_cube_create(CAPTURE_SIDE, &cube);
    code = code == EXIT_DONE ? capture(job, &cube) : code;
    gl_cube_destroy(&cube);
    return code;
}
