// SPDX-License-Identifier: MIT
// Images in memory and in files.
#ifndef ALPENGLOW_IMAGE_H
#define ALPENGLOW_IMAGE_H

#include <alpenglow/context.h>

ALP_BEGIN_DECLS

/// What one component of a pixel is.
typedef enum alp_component {
    ALP_COMPONENT_U8 = 0,    ///< 0…255 stands for 0…1; colour is sRGB-encoded, data is linear
    ALP_COMPONENT_FLOAT = 1, ///< 32-bit float, linear
} alp_component;

/// Width × height pixels of 1 to 4 interleaved components, rows from the top (row 0 is v = 0),
/// no padding between rows.
typedef struct alp_image alp_image;

typedef struct alp_image_info {
    uint32_t width, height;
    uint32_t channels; ///< 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA
    alp_component component;
} alp_image_info;

/// A black image. Limits: each side in [1, 65536], 1 to 4 channels. Destroy with alp_image_destroy.
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_create(alp_context *context, alp_image_info info,
                                                  alp_image **image);
ALP_API void alp_image_destroy(alp_image *image); ///< NULL does nothing
ALP_API alp_image_info alp_image_get_info(const alp_image *image);

/// Pixels [height][width][channels]; the wrong component type gives NULL. Owned by the image.
ALP_API uint8_t *alp_image_bytes(alp_image *image);
ALP_API float *alp_image_floats(alp_image *image);

/// Reads a .png, .jpg, .exr or .hdr; the kind is known by its first bytes, not its name. PNG of 16
/// bits is rounded to 8; a palette is expanded. EXR: one part, channels R G B A or Y, half or
/// float, any compression but DWAA and DWAB. HDR (Radiance RGBE): flat or in runs, any orientation;
/// an EXPOSURE or COLORCORR of its header is taken out again, and so is the alpenglowScale of an
/// EXR that we wrote.
/// @return ALP_OK; IO; INVALID_DATA (not such a file, or broken); UNSUPPORTED (an EXR or HDR of
///         another kind, named); LIMIT (more than 2^28 pixels); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_load(alp_context *context, const char *path,
                                                alp_image **image);

/// Writes a .png (8-bit images only), .exr (float images only: scanline, ZIP, 32-bit float) or .hdr
/// (float images only: RGBE, to about 0.4 % of a pixel's largest channel, without alpha; negative
/// values become 0, with a warning, hdr-range), by the ending of `path`; written to a temporary
/// file that is renamed when complete.
/// @param overwrite false: an existing file is an error
/// @return ALP_OK; INVALID_ARGUMENT (ending or component does not fit); IO; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_save(const alp_image *image, const char *path,
                                                bool overwrite);

/// How two images differ, over the pixels that are covered (alpha > ½, or no alpha) in both.
typedef struct alp_image_difference {
    uint64_t pixels;      ///< compared
    uint64_t only_first;  ///< covered in the first image only
    uint64_t only_second; ///< covered in the second image only
    double rmse;          ///< √ mean of (s·a − b)² over pixels and colour channels
    double relative_rmse; ///< rmse / mean_second
    double bias;          ///< mean of s·a − b
    double mean_first, mean_second;
    double p99;                    ///< 99th percentile of |s·a − b|
    double maximum;                ///< largest |s·a − b|
    uint32_t maximum_x, maximum_y; ///< where
} alp_image_difference;

/// Compares a and b; a is multiplied by `scale` first. Grey is compared as R = G = B.
/// @param heatmap NULL, or out: an 8-bit RGB picture of |s·a − b| (black 0, white = p99 and above;
///        magenta: covered in one only; dark blue: in none), which the caller destroys
/// @return ALP_OK; INVALID_ARGUMENT (sizes or component types differ); INVALID_DATA (a NaN or
///         infinity, named by its pixel); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_compare(const alp_image *a, const alp_image *b,
                                                   double scale, alp_image_difference *difference,
                                                   alp_image **heatmap);

ALP_END_DECLS

#endif
