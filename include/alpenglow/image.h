// SPDX-License-Identifier: MIT
// Images in memory and in files.
#ifndef ALPENGLOW_IMAGE_H
#define ALPENGLOW_IMAGE_H

#include <alpenglow/context.h>

ALP_BEGIN_DECLS

/// Type of one component of a pixel.
typedef enum alp_component {
    ALP_COMPONENT_U8 = 0,    ///< 0…255 stands for 0…1; colour is sRGB-encoded, data is linear
    ALP_COMPONENT_FLOAT = 1, ///< 32-bit float, linear
} alp_component;

/// An image: width × height pixels of 1 to 4 interleaved components. Rows run from the top (row 0
/// is v = 0), without padding.
typedef struct alp_image alp_image;

typedef struct alp_image_info {
    uint32_t width, height;
    uint32_t channels; ///< 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA
    alp_component component;
} alp_image_info;

/// Makes a black image. Each side is in [1, 65536] pixels, with 1 to 4 channels.
/// @param image out, which the caller destroys
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_create(alp_context *context, alp_image_info info,
                                                  alp_image **image);
ALP_API void alp_image_destroy(alp_image *image); ///< NULL does nothing
ALP_API alp_image_info alp_image_get_info(const alp_image *image);

/// Pixels [height][width][channels], owned by the image. NULL for an image of the other component
/// type.
ALP_API uint8_t *alp_image_bytes(alp_image *image);
ALP_API float *alp_image_floats(alp_image *image);
/// The same pixels of either component type, to read. NULL for NULL.
ALP_API const void *alp_image_pixels(const alp_image *image);

/// Adds a text to an image, such as how it was made. A .png carries it as an iTXt chunk; other
/// files do not. An image has as many as were added, in that order.
/// @param key  1 to 79 printable ASCII characters, no blank at either end
/// @param text UTF-8, copied
/// @return ALP_OK; INVALID_ARGUMENT (NULL, a key of another kind); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_add_text(alp_image *image, const char *key,
                                                    const char *text);

/// Reads an image from a .png, .jpg, .exr or .hdr file. The first bytes decide the format, not the
/// name.
///   PNG   16 bits are rounded to 8; a palette is expanded.
///   EXR   one part, channels R G B A or Y, half or float, any compression but DWAA and DWAB. Our
///         own attribute alpenglowScale is applied.
///   HDR   Radiance RGBE, flat or run-length encoded, any orientation. EXPOSURE and COLORCORR in
///         the header are divided out.
/// @return ALP_OK; IO; INVALID_DATA (another format, or broken); UNSUPPORTED (an EXR or HDR of
///         another kind, named); LIMIT (more than 2^28 pixels); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_load(alp_context *context, const char *path,
                                                alp_image **image);

/// Writes an image in the format that the ending of `path` names. The file is written under a
/// temporary name and renamed when complete.
///   .png  8-bit images only
///   .exr  float images only: scanlines, ZIP, 32-bit float
///   .hdr  float images only: RGBE, accurate to about 0.4 % of a pixel's largest channel, without
///         alpha. Negative values become 0, with a warning (hdr-range).
/// @param overwrite false: an existing file is an error
/// @return ALP_OK; INVALID_ARGUMENT (ending or component does not fit); IO; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_save(const alp_image *image, const char *path,
                                                bool overwrite);

/// Differences between two images, over the pixels that are covered in both. Covered means alpha
/// above ½, or no alpha.
typedef struct alp_image_difference {
    uint64_t pixels;      ///< number of pixels compared
    uint64_t only_first;  ///< pixels covered in the first image only
    uint64_t only_second; ///< pixels covered in the second image only
    double rmse;          ///< √(mean of (s·a − b)²) over pixels and colour channels
    double relative_rmse; ///< rmse / mean_second
    double bias;          ///< mean of s·a − b
    double mean_first, mean_second;
    double p99;                    ///< 99th percentile of |s·a − b|
    double maximum;                ///< largest |s·a − b|
    uint32_t maximum_x, maximum_y; ///< the pixel of it
} alp_image_difference;

/// Compares two images of one size and component type. Grey is compared as R = G = B.
/// @param scale   s: image a is multiplied by it first
/// @param heatmap NULL, or out: an 8-bit RGB picture of |s·a − b|, which the caller destroys. Black
///        is 0, white is p99 and above. Magenta is covered in one image only, dark blue in none.
/// @return ALP_OK; INVALID_ARGUMENT (sizes or component types differ); INVALID_DATA (a NaN or
///         infinity; the message names its pixel); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_image_compare(const alp_image *a, const alp_image *b,
                                                   double scale, alp_image_difference *difference,
                                                   alp_image **heatmap);

ALP_END_DECLS

#endif
