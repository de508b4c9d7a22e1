// SPDX-License-Identifier: MIT
// Everything: #include <alpenglow/alpenglow.h>
#ifndef ALPENGLOW_ALPENGLOW_H
#define ALPENGLOW_ALPENGLOW_H

#include <alpenglow/ambience.h>
#include <alpenglow/atlas.h>
#include <alpenglow/bake.h>
#include <alpenglow/checkpoint.h>
#include <alpenglow/compare.h>
#include <alpenglow/context.h>
#include <alpenglow/display.h>
#include <alpenglow/doctor.h>
#include <alpenglow/field.h>
#include <alpenglow/film.h>
#include <alpenglow/geometry.h>
#include <alpenglow/image.h>
#include <alpenglow/light.h>
#include <alpenglow/lightmap.h>
#include <alpenglow/lpv.h>
#include <alpenglow/occlusion.h>
#include <alpenglow/probes.h>
#include <alpenglow/ranks.h>
#include <alpenglow/render.h>
#include <alpenglow/report.h>
#include <alpenglow/result.h>
#include <alpenglow/scene.h>
#include <alpenglow/sh.h>
#include <alpenglow/shared_constants.h>
#include <alpenglow/version.h>

#endif
