// SPDX-License-Identifier: MIT
// An atlas: which texel of which page belongs to which point of which triangle.
#ifndef ALPENGLOW_ATLAS_H
#define ALPENGLOW_ATLAS_H

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

typedef struct alp_atlas alp_atlas;

typedef enum alp_atlas_mode {
    ALP_ATLAS_AUTO = 0, ///< keep a valid second UV set, else (and where block, mips or densities
                        ///< ask for them) charts
    ALP_ATLAS_KEEP =
        1, ///< the scene's second UV set (TEXCOORD_1); an error when it cannot hold a bake
    ALP_ATLAS_CHARTS = 2, ///< new charts, packed into pages
    /// No pages: values at the vertices. alp_bake only; the other atlas options have no meaning.
    ALP_ATLAS_VERTEX = 3,
    /// Overlapping charts and three coordinate sets, one for each axis of the object (of the world,
    /// where the scene or what is written has no objects): set k has the triangles whose normals
    /// have a part of axis k, up to 87° from it, projected along it. A shader reads all three and
    /// adds them up weighted by the squares of the unit normal's components, which sum to 1
    ///
    ///     value = Σ_k n_k² · L(uv_k),   n = the interpolated normal in the object's frame, unit
    ///
    /// so that a chart is seen least where it ends. Where a triangle is none of set k it has there
    /// the coordinates of its strongest axis: each set alone is a map of everything, with seams.
    /// Texels: up to three halves of those of CHARTS. KEEP's and CHARTS' max_angle is not read.
    /// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU,
    /// 2007, chapters 5.4, 7.3 and 7.5.
    ALP_ATLAS_BLEND = 4
} alp_atlas_mode;

/// How the three values of ALP_ATLAS_BLEND become one.
typedef enum alp_blend {
    ALP_BLEND_NORMAL = 0, ///< by the squares of the normal's components (default)
    ALP_BLEND_AVERAGE = 1 ///< each chart that the triangle is in counts alike: for comparison, it
                          ///< shows steps where charts end
} alp_blend;

typedef struct alp_atlas_options {
    size_t struct_size;
    alp_atlas_mode mode;
    uint32_t size; ///< side of a page in texels, [1, 16384]; default 1024
    /// Texel density; 0 (default) = the highest at which all fits one page. Charts larger than a
    /// page are cut, and where less than 3/4 of several pages is used and cuts save one, others.
    double texels_per_metre;
    uint32_t padding; ///< free texels between neighbouring charts, [0, 64]; default 2
    /// Radians between a triangle and the plane that it is projected on, (0, 1.2]; default π/4.
    /// Below 0.35 charts stay as they are projected; else those that meet where the surface is
    /// smooth, and tiny ones, are merged and unfolded together.
    float max_angle;
    alp_progress_fn *progress;
    void *progress_user;
    /// Side of the blocks of a texture compression, [1, 64]; default 1: none. No block of
    /// block × block texels, counted from the corner of a page, holds texels of two charts: their
    /// colours never share a block's palette. 4 for BC and ETC, 4 to 12 for ASTC.
    uint32_t block;
    /// Mip levels (means of 2 × 2) that must stay clean, [0, 8]; default 0. At levels 1 … mips no
    /// bilinear look-up at a point of a chart, held at the page's border, reads a mip texel that
    /// texels of another chart went into. With cells of 2^(mips − 1) texels, halves of that level's
    /// texels, two free cells between the cells of two charts are what that takes: a look-up reads
    /// its own texel and the next one on the side of its own half, so two halves beyond its half,
    /// and each lower level reads less. `size` must be a multiple of 2^mips.
    uint32_t mips;
    /// Factors by which surfaces have more texels per metre: "PATTERN=FACTOR" with commas between,
    /// patterns as in alp_bake_options.only, "material:PATTERN" for names of materials; where
    /// several match, their product. Factors and products in [0.001, 1000]; each pattern must match
    /// something.
    /// Charts hold surfaces of one factor. NULL (default): all alike. Instances that share a map
    /// have the factor of the one that is baked.
    const char *densities;
} alp_atlas_options;
ALP_API alp_atlas_options alp_atlas_options_default(void);

/// Makes an atlas: adjacency by position → clusters whose normals stay within max_angle of their
/// plane, with short outlines that lie in creases → planar projection → clusters that meet are
/// unfolded together, as rigid as possible, where no triangle flips or lies over another, none has
/// an L2 stretch above 1.75 (Sander et al. 2001, each chart having the area of its triangles) and
/// their box does not grow → turned to the tightest box → packed pages. Charts are packed by their
/// shapes, turned by quarters and never mirrored, into holes too. The same scene and options give
/// the same atlas on any number of workers.
/// @param scene must outlive the atlas
/// @return ALP_OK; INVALID_ARGUMENT; INVALID_DATA (nothing to bake; KEEP with coordinates that are
///         missing, out of [0,1] or overlapping: the message names triangles); LIMIT (more than
///         4096 pages; a triangle that is larger than a page: the message has its numbers);
///         OUT_OF_MEMORY; CANCELLED
/// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU,
/// 2007; M. Garland, A. Willmott, P. S. Heckbert. Hierarchical Face Clustering on Polygonal
/// Surfaces. I3D, 2001; L. Liu, L. Zhang, Y. Xu, C. Gotsman, S. J. Gortler. A Local/Global Approach
/// to Mesh Parameterization. SGP, 2008.
ALP_API ALP_NODISCARD alp_result alp_atlas_create(const alp_scene *scene,
                                                  const alp_atlas_options *options,
                                                  alp_atlas **atlas);
ALP_API void alp_atlas_destroy(alp_atlas *atlas); ///< NULL does nothing

typedef struct alp_atlas_info {
    alp_atlas_mode mode; ///< what was done: KEEP, CHARTS or BLEND; VERTEX: all else is 0
    uint32_t pages, width, height;
    uint32_t charts;
    uint64_t texels; ///< covered: with area of a chart inside
    /// Share of all pages' texels that are in use. CHARTS: covered texels and free ones within
    /// `padding` texels of a covered one, rows and columns counted alike. KEEP: covered texels.
    /// Every page counts whole, the last one too, however little it holds.
    double utilisation;
    double texels_per_metre;   ///< mean over the area, √(texel area / world area)
    uint32_t shared_triangles; ///< too small or thin to have a texel's receiver on them
    /// L2 stretch √((Γ² + γ²) / 2) of the map from texels to the surface, Γ ≥ γ its singular
    /// values, times texels_per_metre: 1 = the mean density without shear. The mean is the root of
    /// the mean square over the area; both leave slivers out, and are 1 without others. Based on:
    /// P. V. Sander et al. Texture Mapping Progressive Meshes. SIGGRAPH 2001. With `densities` a
    /// triangle of factor f is measured against what is asked of it, f times the density of factor
    /// 1, √(texel area / Σ f² · area); and the mean is over f² · area.
    double stretch_mean, stretch_worst;
    /// 99th over 1st percentile, by area, of triangles' texels per metre; with `densities` over
    /// their factors, by f² · area.
    double density_spread;
    /// Whose corners run clockwise on the page, or which have no area there. CHARTS: none, ever.
    /// KEEP: of islands that are mirrored too.
    uint32_t flipped_triangles;
    /// Lower than 1/64 of a texel at the density asked of them, so that coordinates do not hold
    /// their shape: they count as flipped only beyond their rounding.
    uint32_t sliver_triangles;
    uint64_t overlapping_texels; ///< in which triangles cover one place; 0 but of pages of 1 texel
} alp_atlas_info;
ALP_API alp_atlas_info alp_atlas_get_info(const alp_atlas *atlas);

/// Texture coordinates [triangles][3][2] of every triangle's corners, v = 0 at row 0; and page
/// [triangles]. Unusable triangles have coordinates too (one point inside a chart). In the atlas of
/// a bake of some surfaces only, triangles of the others have page UINT32_MAX. Owned by the atlas.
ALP_API const float *alp_atlas_corner_uvs(const alp_atlas *atlas);
ALP_API const uint32_t *alp_atlas_triangle_pages(const alp_atlas *atlas);
/// The three sets of ALP_ATLAS_BLEND, [triangles][set][corner][2], all three of a triangle on its
/// page; else NULL. alp_atlas_corner_uvs are then those of each triangle's strongest axis. Owned by
/// the atlas.
ALP_API const float *alp_atlas_blend_uvs(const alp_atlas *atlas);

/// A picture of one page: every chart in a colour of its own on black.
ALP_API ALP_NODISCARD alp_result alp_atlas_picture(const alp_atlas *atlas, uint32_t page,
                                                   alp_image **image);

ALP_END_DECLS

#endif
