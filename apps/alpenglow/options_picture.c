// SPDX-License-Identifier: MIT
// Rows of the table of options: what a picture shows, and how.
#include "option_parts.h"

static const option rows[] = {
    {.id = OPTION_WITH,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--with",
     .value = "reference|radiosity|lightmap|ao|constant|hemisphere",
     .choices = "ao|constant|hemisphere|reference|lightmap|radiosity",
     .later_choices = "probes|ambience|lpv|cube",
     .help =
         "reference: all light by path tracing. radiosity: direct light at each pixel, and what "
         "surfaces reflect gathered from a radiosity on texels; less noise than reference in "
         "as many --samples. lightmap: bakes --maps light and shows it as a viewer does, emission "
         "+ albedo / pi x irradiance, with its texels; the backs of double-sided surfaces show "
         "their fronts' map. These three see through blended and transmissive surfaces, which "
         "the others cut at an alpha of one half or take for opaque. ao: accessibility, "
         "from the scene's occlusion maps, and by rays where it has none. constant: uniform "
         "light of radiance 1, which shows the albedo: base colour x (1 - metallic), at most "
         "0.95. hemisphere: the two colours of --sky (without it 1,1,1 above and 0,0,0 below), "
         "nothing in their way. Needed."},
    {.id = OPTION_CAMERA,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--camera",
     .value = "N|auto|PX,PY,PZ,TX,TY,TZ,VFOV",
     .initial = "0",
     .help =
         "Camera of the scene, from 0; or position and target in metres and the vertical "
         "field of view in degrees, 0.001 to 179. auto (and a scene without cameras): a view of "
         "everything."},
    {.id = OPTION_RESOLUTION,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_TEXT,
     .name = "--resolution",
     .value = "WxH",
     .initial = "960x540",
     .help = "Size of the picture in pixels, each side 1 to 16384."},
    {.id = OPTION_SAMPLES,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_WHOLE,
     .name = "--samples",
     .value = "N",
     .minimum = 1,
     .maximum = 65536,
     .unit = "camera rays per pixel",
     .initial = "16",
     .help = "More smooth the edges; time grows with N. With reference and radiosity each is a "
             "path, N is rounded up to a multiple of 16, and the noise falls as 1 over the root of "
             "N."},
    {.id = OPTION_EXPOSURE,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--exposure",
     .value = "EV|auto",
     .choices = "auto",
     .minimum = -64,
     .maximum = 64,
     .unit = "EV",
     .help = "What a .png shows: values times 2^EV; 0 shows 1 as 1, each +1 is twice as bright. "
             "auto: the geometric mean of the brightness of pixels that are not black, without "
             "the darkest and brightest 5 % of them, becomes 18 % grey; the EV used is printed. "
             "Default 0 for ao and constant, else auto."},
    {.id = OPTION_TONE,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_CHOICE,
     .name = "--tone",
     .value = "film|reinhard|filmic|none",
     .choices = "film|reinhard|filmic|none",
     .help = "Curve from exposed light L to a .png. film: 1 - e^-L. reinhard: L (1 + L/16) / "
             "(1 + L), white at 4. filmic: Hable's, more contrast, white at 5.6. none: cut off at "
             "1. Default none for ao and constant, else film."},
    {.id = OPTION_WHITE_BALANCE,
     .commands = IN_RENDER,
     .group = GROUP_PICTURE,
     .kind = KIND_REAL,
     .name = "--white-balance",
     .value = "K|auto|off",
     .choices = "auto|off",
     .minimum = 1000,
     .maximum = 25000,
     .unit = "kelvin",
     .initial = "off",
     .help = "Which light is white in a .png. K: light of this colour temperature; low ones make "
             "the picture bluer. auto: the mean of the picture. off: D65, as it is."},
};

const option_part option_part_picture = {rows, sizeof rows / sizeof *rows};
