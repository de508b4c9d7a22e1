// SPDX-License-Identifier: MIT
// An atlas: which texel of which page belongs to which point of which triangle.
#ifndef ALPENGLOW_ATLAS_H
#define ALPENGLOW_ATLAS_H

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

typedef struct alp_atlas alp_atlas;

typedef enum alp_atlas_mode {
    ALP_ATLAS_AUTO = 0, ///< keep a valid second UV set, else charts
    ALP_ATLAS_KEEP =
        1, ///< the scene's second UV set (TEXCOORD_1); an error when it cannot hold a bake
    ALP_ATLAS_CHARTS = 2, ///< new charts, packed into pages
    /// No pages: values at the vertices. alp_bake only; the other atlas options have no meaning.
    ALP_ATLAS_VERTEX = 3
} alp_atlas_mode;

typedef struct alp_atlas_options {
    size_t struct_size;
    alp_atlas_mode mode;
    uint32_t size; ///< side of a page in texels, [1, 16384]; default 1024
    double
        texels_per_metre; ///< texel density; 0 (default) = the highest at which all fits one page
    uint32_t padding;     ///< free texels between neighbouring charts, [0, 64]; default 2
    /// Radians between a triangle and the plane that it is projected on, (0, 1.2]; default π/4.
    /// Below 0.35 charts stay as they are projected; else those that meet where the surface is
    /// smooth, and tiny ones, are merged and unfolded together.
    float max_angle;
    alp_progress_fn *progress;
    void *progress_user;
} alp_atlas_options;
ALP_API alp_atlas_options alp_atlas_options_default(void);

/// Makes an atlas: adjacency by position → clusters whose normals stay within max_angle of their
/// plane, with short outlines that lie in creases → planar projection → clusters that meet are
/// unfolded together, as rigid as possible, where no triangle flips or lies over another, none has
/// an L2 stretch above 1.75 (Sander et al. 2001, each chart having the area of its triangles) and
/// their box does not grow → turned to the tightest box → packed pages. The same scene and options
/// give the same atlas on any number of workers.
/// @param scene must outlive the atlas
/// @return ALP_OK; INVALID_ARGUMENT; INVALID_DATA (nothing to bake; KEEP with coordinates that are
///         missing, out of [0,1] or overlapping: the message names triangles); LIMIT (more than
///         4096 pages); OUT_OF_MEMORY; CANCELLED
/// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU,
/// 2007; M. Garland, A. Willmott, P. S. Heckbert. Hierarchical Face Clustering on Polygonal
/// Surfaces. I3D, 2001; L. Liu, L. Zhang, Y. Xu, C. Gotsman, S. J. Gortler. A Local/Global Approach
/// to Mesh Parameterization. SGP, 2008.
ALP_API ALP_NODISCARD alp_result alp_atlas_create(const alp_scene *scene,
                                                  const alp_atlas_options *options,
                                                  alp_atlas **atlas);
ALP_API void alp_atlas_destroy(alp_atlas *atlas); ///< NULL does nothing

typedef struct alp_atlas_info {
    alp_atlas_mode mode; ///< what was done: KEEP or CHARTS; VERTEX: all else is 0
    uint32_t pages, width, height;
    uint32_t charts;
    uint64_t texels; ///< covered: with area of a chart inside
    /// Share of all pages' texels that are in use. CHARTS: covered texels and free ones within
    /// `padding` texels of a covered one, rows and columns counted alike. KEEP: covered texels.
    double utilisation;
    double texels_per_metre;   ///< mean over the area, √(texel area / world area)
    uint32_t shared_triangles; ///< too small or thin to have a texel's receiver on them
} alp_atlas_info;
ALP_API alp_atlas_info alp_atlas_get_info(const alp_atlas *atlas);

/// Texture coordinates [triangles][3][2] of every triangle's corners, v = 0 at row 0; and page
/// [triangles]. Unusable triangles have coordinates too (one point inside a chart). In the atlas of
/// a bake of some surfaces only, triangles of the others have page UINT32_MAX. Owned by the atlas.
ALP_API const float *alp_atlas_corner_uvs(const alp_atlas *atlas);
ALP_API const uint32_t *alp_atlas_triangle_pages(const alp_atlas *atlas);

/// A picture of one page: every chart in a colour of its own on black.
ALP_API ALP_NODISCARD alp_result alp_atlas_picture(const alp_atlas *atlas, uint32_t page,
                                                   alp_image **image);

ALP_END_DECLS

#endif
