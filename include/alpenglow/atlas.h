// SPDX-License-Identifier: MIT
// An atlas: the map from points of triangles to texels of pages.
#ifndef ALPENGLOW_ATLAS_H
#define ALPENGLOW_ATLAS_H

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// An atlas. Opaque; made by alp_atlas_create.
typedef struct alp_atlas alp_atlas;

typedef enum alp_atlas_mode {
    /// KEEP if the second UV set can hold a bake, and `block`, `mips` and `densities` are default;
    /// else CHARTS.
    ALP_ATLAS_AUTO = 0,
    /// The scene's second UV set (TEXCOORD_1); an error if it cannot hold a bake. Triangles may
    /// overlap on up to 1 % of its texels, with a warning (kept-overlap). Not with
    /// `block`, `mips` and `densities`.
    ALP_ATLAS_KEEP = 1,
    /// New charts, packed into pages.
    ALP_ATLAS_CHARTS = 2,
    /// No pages: values at the vertices. alp_bake only; the other atlas options are ignored.
    ALP_ATLAS_VERTEX = 3,
    /// Overlapping charts in three coordinate sets, one for each axis of the object. If the scene
    /// or the output has no objects, they are axes of the world. Set k holds the triangles whose
    /// normals are up to 87° from axis k, projected along it. A shader reads all three sets and
    /// blends them by the squares of the unit normal's components, which sum to 1:
    ///
    ///     value = Σ_k n_k² · L(uv_k),   n = the interpolated normal in the object's frame, unit
    ///
    /// So a chart has least weight at its border. A triangle that is not in set k has the
    /// coordinates of its strongest axis there. Each set alone is thus a complete map, with seams.
    /// It takes up to 1.5 times the texels of CHARTS. `max_angle` is ignored.
    /// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU,
    /// 2007, chapters 5.4, 7.3 and 7.5.
    ALP_ATLAS_BLEND = 4
} alp_atlas_mode;

/// Weights of the three values of ALP_ATLAS_BLEND.
typedef enum alp_blend {
    ALP_BLEND_NORMAL = 0, ///< the squares of the normal's components (default)
    ALP_BLEND_AVERAGE = 1 ///< equal for each chart that the triangle is in. For comparison only:
                          ///< steps appear at the borders of charts.
} alp_blend;

typedef struct alp_atlas_options {
    size_t struct_size;
    alp_atlas_mode mode;
    uint32_t size; ///< side of a page in texels, [1, 16384]; default 1024
    /// Texel density; 0 (default) = the highest at which everything fits on one page. Charts larger
    /// than a page are cut. If less than 3/4 of several pages is used and cuts save a page, other
    /// charts are cut too.
    double texels_per_metre;
    uint32_t padding; ///< free texels between neighbouring charts, [0, 64]; default 2
    /// Largest angle between a triangle and the plane of its projection, radians, (0, 1.2]; default
    /// π/4. At 0.35 or more, charts that meet on smooth surface, and tiny ones, are merged and
    /// unfolded together. Below 0.35 they stay as projected. KEEP ignores it.
    float max_angle;
    alp_progress_fn *progress;
    void *progress_user;
    /// Side of a block of texture compression in texels, [1, 64]; default 1: none. No block,
    /// counted from the corner of a page, holds texels of two charts, so they never share a block's
    /// palette. Use 4 for BC and ETC, 4 to 12 for ASTC.
    uint32_t block;
    /// Number of mip levels (means of 2 × 2) that must stay clean, [0, 8]; default 0. At levels 1
    /// to `mips`, a bilinear read at a point of a chart takes no texel that holds another chart.
    /// Reads are clamped to the page. `size` must be a multiple of 2^mips.
    ///
    /// Method: two free cells of 2^(mips − 1) texels lie between the cells of two charts. A cell is
    /// half a texel of level `mips`. A read takes its own texel and the neighbour on its own side.
    /// So it reaches two cells beyond its own; lower levels reach less far.
    uint32_t mips;
    /// Factors on the texel density of surfaces: "PATTERN=FACTOR" with commas between. Patterns are
    /// those of alp_bake_options.only; "material:PATTERN" matches names of materials. Factors of
    /// all matches are multiplied. Factors and products are in [0.001, 1000]. Each pattern must
    /// match. A chart holds surfaces of one factor. Instances that share a map have the factor of
    /// the one that is baked. NULL (default): 1 for all.
    const char *densities;
} alp_atlas_options;
ALP_API alp_atlas_options alp_atlas_options_default(void);

/// Makes an atlas. The steps of CHARTS:
///   1. Triangles are joined by position, and grouped into clusters. Normals of a cluster
///      stay within max_angle of its plane; outlines are short and lie in creases.
///   2. Each cluster is projected onto its plane.
///   3. Clusters that meet are unfolded together, as rigidly as possible. No triangle may flip or
///      overlap another. None may have an L2 stretch above 1.75 (Sander et al. 2001, each chart
///      having the area of its triangles). Their box may not grow.
///   4. Charts are turned to the tightest box and packed by their shapes, into holes too. They are
///      turned by quarters and never mirrored.
///
/// The same scene and options give the same atlas for any number of workers.
/// @param scene must outlive the atlas
/// @param atlas out, which the caller destroys; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT; INVALID_DATA (nothing to bake; KEEP with coordinates that are
///         missing, out of [0,1] or overlapping on more than 1 % of the texels: the message names
///         triangles); LIMIT (more than 4096 pages; a triangle larger than a page: the message has
///         its numbers); OUT_OF_MEMORY; CANCELLED
/// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU,
/// 2007; M. Garland, A. Willmott, P. S. Heckbert. Hierarchical Face Clustering on Polygonal
/// Surfaces. I3D, 2001; L. Liu, L. Zhang, Y. Xu, C. Gotsman, S. J. Gortler. A Local/Global Approach
/// to Mesh Parameterization. SGP, 2008.
ALP_API ALP_NODISCARD alp_result alp_atlas_create(const alp_scene *scene,
                                                  const alp_atlas_options *options,
                                                  alp_atlas **atlas);
ALP_API void alp_atlas_destroy(alp_atlas *atlas); ///< NULL does nothing

/// Figures of an atlas. With VERTEX all but `mode` is 0.
typedef struct alp_atlas_info {
    alp_atlas_mode mode; ///< the mode used: KEEP, CHARTS, BLEND or VERTEX
    uint32_t pages, width, height;
    uint32_t charts;
    uint64_t texels; ///< covered texels: those with area of a chart inside
    /// Share of the texels of all pages that are in use. CHARTS: covered texels and free ones
    /// within `padding` rows and columns of a covered one. KEEP: covered texels. Every page counts
    /// whole, the last one too.
    double utilisation;
    double texels_per_metre;   ///< mean over the area, √(texel area / world area)
    uint32_t shared_triangles; ///< triangles too small or thin to hold the receiver of a texel
    /// L2 stretch √((Γ² + γ²) / 2) × texels_per_metre of the map from texels to the surface. Γ ≥ γ
    /// are its singular values. 1 is the mean density without shear. The mean is the root of the
    /// mean square over the area. Slivers are left out of both; without other triangles they are 1.
    /// With `densities`, a triangle of factor f is measured against f × the density of factor 1,
    /// √(texel area / Σ f² · area). The mean is then over f² · area.
    /// Based on: P. V. Sander et al. Texture Mapping Progressive Meshes. SIGGRAPH 2001.
    double stretch_mean, stretch_worst;
    /// Ratio of the 99th to the 1st percentile of triangles' texels per metre, by area. With
    /// `densities` these are divided by the factors, by f² · area.
    double density_spread;
    /// Triangles whose corners run clockwise on the page, or have no area there. CHARTS: always 0.
    /// KEEP: triangles of mirrored islands count too.
    uint32_t flipped_triangles;
    /// Triangles lower than 1/64 texel at their density: coordinates cannot hold their shape. They
    /// count as flipped only beyond their rounding.
    uint32_t sliver_triangles;
    uint64_t overlapping_texels; ///< texels in which triangles overlap; 0 but with KEEP, and for
                                 ///< 1-texel pages
} alp_atlas_info;
ALP_API alp_atlas_info alp_atlas_get_info(const alp_atlas *atlas);

/// Texture coordinates of the corners of every triangle, [triangles][3][2], v = 0 at row 0. An
/// unusable triangle has one point inside a chart. Owned by the atlas.
ALP_API const float *alp_atlas_corner_uvs(const alp_atlas *atlas);
/// Page of every triangle, [triangles]. UINT32_MAX for triangles that a bake of some surfaces
/// leaves out. Owned by the atlas.
ALP_API const uint32_t *alp_atlas_triangle_pages(const alp_atlas *atlas);
/// The three sets of ALP_ATLAS_BLEND, [triangles][set][corner][2], all three on the triangle's
/// page; NULL in other modes. alp_atlas_corner_uvs then holds the set of each triangle's strongest
/// axis. Owned by the atlas.
ALP_API const float *alp_atlas_blend_uvs(const alp_atlas *atlas);

/// Draws a page: every chart in its own colour on black.
/// @param image out, which the caller destroys
ALP_API ALP_NODISCARD alp_result alp_atlas_picture(const alp_atlas *atlas, uint32_t page,
                                                   alp_image **image);

ALP_END_DECLS

#endif
