// SPDX-License-Identifier: MIT
// Rows of the table of options: light in space, by probes and other fields.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_WITH,
     .commands = IN_SAMPLE,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--with",
     .value = "reference|probes|ambience|lpv|constant|hemisphere|ground-map|ambient-cube|"
              "environment",
     .choices = "constant|hemisphere|ground-map|ambient-cube|environment|probes|reference|ambience|"
                "lpv",
     .help = "Model of the light, required.\n"
             "reference: path tracing, the truth.\n"
             "probes: a grid of light probes, from --probes FILE or baked with --spacing.\n"
             "ambience: the live volume after a flight (--path, --time).\n"
             "lpv: light propagated through a grid of cells, without precomputation (--grid).\n"
             "constant: one colour for the whole scene.\n"
             "hemisphere: one colour from above and one from below.\n"
             "ground-map: the same, and the light that the ground below sends up.\n"
             "ambient-cube: six colours, one for each axis direction.\n"
             "environment: nine spherical harmonics for the whole scene.\n"
             "The classic models are fitted to the scene's light by least squares at "
             "random free points."},
    {.id = OPTION_AT,
     .commands = IN_SAMPLE,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--at",
     .value = "POINTS.csv",
     .help = "Points, required: a line x,y,z,nx,ny,nz each, position in metres and "
             "normal. The first line may be names. - is standard input."},
    {.id = OPTION_PROBES,
     .commands = IN_SAMPLE | IN_RENDER | IN_VIEW,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--probes",
     .value = "FILE.probes.json",
     .help = "Probes of --with probes, as alpenglow probes writes them. A warning says "
             "when they were baked in another scene."},
    {.id = OPTION_PROBES,
     .commands = IN_INFO,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--probes",
     .value = "FILE.probes.json",
     .help = "Also print what these probes hold, and whether they were baked in SCENE."},
    {.id = OPTION_AT,
     .commands = IN_PROBES,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--at",
     .value = "POINTS.csv",
     .help = "Probes at these places instead of a grid: a line x,y,z each, in metres; "
             "further columns are ignored. The first line may be names. - is standard "
             "input."},
    {.id = OPTION_SPACING,
     .commands = IN_PROBES | IN_SAMPLE | RAY_COMMANDS | IN_VIEW,
     .group = GROUP_WHAT,
     .kind = KIND_REAL,
     .name = "--spacing",
     .value = "M|auto",
     .choices = "auto",
     .minimum = 1e-6,
     .maximum = 1e9,
     .unit = "metres",
     .initial = "auto",
     .help = "Distance of neighbouring probes of a grid. auto: about 4096 probes in the "
             "bounds."},
    {.id = OPTION_BOUNDS,
     .commands = IN_PROBES | IN_SAMPLE | RAY_COMMANDS | IN_VIEW,
     .group = GROUP_WHAT,
     .kind = KIND_TEXT,
     .name = "--bounds",
     .value = "X0,Y0,Z0,X1,Y1,Z1",
     .help = "Two corners of the grid, in metres. Default: the bounds of the scene. "
             "Outer probes lie up to half a cell inside."},
    {.id = OPTION_BASIS,
     .commands = IN_PROBES,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--basis",
     .value = "sh9|sh4|ambient-cube",
     .choices = "sh9|sh4|ambient-cube",
     .initial = "sh9",
     .help = "Functions of direction that a probe holds: nine or four spherical "
             "harmonics of radiance, or irradiance along six axes."},
    {.id = OPTION_VISIBILITY,
     .commands = IN_PROBES,
     .group = GROUP_WHAT,
     .kind = KIND_CHOICE,
     .name = "--visibility",
     .value = "on|off",
     .choices = "off|on",
     .initial = "on",
     .help = "Store the distances to surfaces around each probe. The look-up then keeps "
             "light from leaking through walls."},
    {.id = OPTION_GRADIENTS,
     .commands = IN_PROBES,
     .group = GROUP_WHAT,
     .kind = KIND_FLAG,
     .name = "--gradients",
     .help = "Store the change of light along each axis, by central differences. Seven "
             "times the rays, four times the coefficients."},
    {.id = OPTION_LAYERS,
     .commands = IN_PROBES,
     .group = GROUP_LIGHT,
     .kind = KIND_FLAG,
     .name = "--layers",
     .help = "Store the light of each lamp and sun apart, so that a host can switch and "
             "dim it."},
    {.id = OPTION_EXPORT,
     .commands = IN_PROBES,
     .group = GROUP_OUTPUT,
     .kind = KIND_CHOICE,
     .name = "--export",
     .value = "three",
     .choices = "three",
     .later_choices = "bevy|godot",
     .help = "Also write the grid for another program.\n"
             "three: OUT.three.mjs, a module for LightProbeGrid of three.js r184 to r187, and "
             "its texture OUT.three.ktx2. --basis ambient-cube and --at have none."},
    {.id = OPTION_EXPORT_SCALE,
     .commands = IN_PROBES,
     .group = GROUP_OUTPUT,
     .kind = KIND_REAL,
     .name = "--export-scale",
     .value = "S",
     .minimum = 1e-12,
     .maximum = 1e12,
     .initial = "1",
     .help = "Factor on the light of --export, where it exceeds half floats. Multiply by 1 / S "
             "in the program."},
    {.id = OPTION_SAMPLES,
     .commands = IN_PROBES,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--samples",
     .value = "N",
     .minimum = 384,
     .maximum = 1572864,
     .unit = "rays per probe",
     .initial = "1536",
     .help = "Rays of each probe, rounded up to four cubes of 6 x (4 k)^2."},
    {.id = OPTION_SAMPLES,
     .commands = IN_SAMPLE,
     .group = GROUP_LIGHT,
     .kind = KIND_WHOLE,
     .name = "--samples",
     .value = "N",
     .minimum = 1,
     .maximum = 1048576,
     .unit = "paths per point",
     .initial = "1024",
     .help = "Paths of each point of --with reference, rounded up to a multiple of 16."},
    {.id = OPTION_DIRECT,
     .commands = IN_PROBES | IN_SAMPLE | IN_AMBIENCE,
     .group = GROUP_LIGHT,
     .kind = KIND_CHOICE,
     .name = "--direct",
     .value = "on|off",
     .choices = "off|on",
     .initial = "off",
     .help = "Light straight from lamps and suns.\n"
             "off: left out, because a host adds it with its own shadows. Their reflected "
             "light, the sky and emissive surfaces are in.\n"
             "on: all light."},
};

const option_part option_part_space = {rows, sizeof rows / sizeof *rows};
