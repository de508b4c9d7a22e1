// SPDX-License-Identifier: MIT
// Film: linear light of any strength as a screen can show it. Exposure, white balance, tone curve,
// encoding; and how exposure follows the light of a sequence.
#ifndef ALPENGLOW_FILM_H
#define ALPENGLOW_FILM_H

#include <alpenglow/image.h>

ALP_BEGIN_DECLS

/// How exposed light L becomes a display value in [0, 1], channel by channel.
typedef enum alp_tone {
    ALP_TONE_FILM = 0,     ///< 1 − e^(−L), as film answers: dark as it is, bright never cut off
    ALP_TONE_REINHARD = 1, ///< L (1 + L/w²) / (1 + L): the white point w becomes 1
    ALP_TONE_FILMIC = 2,   ///< Hable's curve with a toe: h(2L) / h(2w), see white_point
    ALP_TONE_NONE = 3      ///< L, cut off at 1
} alp_tone;

typedef enum alp_white_balance {
    ALP_WHITE_BALANCE_OFF = 0,    ///< the white of Rec. 709 (D65) stays white
    ALP_WHITE_BALANCE_KELVIN = 1, ///< light of `kelvin` becomes white
    ALP_WHITE_BALANCE_AUTO = 2    ///< the mean of the picture becomes grey
} alp_white_balance;

/// Rounding to 8 bits. Dithering keeps the mean of smooth areas exact in encoded values: a value
/// between two bytes becomes one of these two, so it is never off by one or more. Red, green and
/// blue share their threshold, so grey stays grey. The picture alone decides: no state, no seed.
typedef enum alp_dither {
    ALP_DITHER_NONE = 0,    ///< nearest
    ALP_DITHER_ORDERED = 1, ///< a threshold of Bayer's 8 × 8 pattern; packs well
    ALP_DITHER_HASHED = 2   ///< uniform in [−½, ½) byte, white noise keyed by the pixel
} alp_dither;

typedef struct alp_film_options {
    size_t struct_size;
    /// Exposure value, [−64, 64]: L = 2^exposure × radiance. At 0 (default) radiance 1 is L = 1,
    /// each +1 doubles. This factor is the k of 1 − e^(−k × radiance): there is no other.
    double exposure;
    /// true: `exposure` is chosen such that the picture's mean luminance (see alp_film_meter)
    /// becomes L = key, rounded to 1/100 so that a printed value gives the same picture again.
    /// Default false.
    bool auto_exposure;
    float key;                       ///< (0, 1]; default 0.18, middle grey
    float meter_low, meter_high;     ///< [0, 1], low < high; default 0.05 and 0.95
    alp_tone tone;                   ///< default NONE
    float white_point;               ///< w: the L that REINHARD and FILMIC show as white, > 0;
                                     ///< INFINITY: nothing is, and REINHARD is L / (1 + L);
                                     ///< 0 (default): 4 for REINHARD, 5.6 for FILMIC
    alp_white_balance white_balance; ///< default OFF
    float kelvin;                    ///< [1000, 25000]; default 6504 (D65)
    alp_dither dither;               ///< default NONE
} alp_film_options;
/// Shows values from 0 to 1 as they are: no exposure, no curve, no white balance, no dithering.
ALP_API alp_film_options alp_film_options_default(void);

/// 8-bit sRGB picture of a linear float image: white balance, exposure, tone curve, then mixed as
/// light over a grey background (byte 96) where alpha is below 1, then encoded (IEC 61966-2-1).
/// What is not a number, or −infinity, counts as 0, +infinity as the brightest there is; what is
/// negative after white balance shows as 0.
///
/// White balance scales the cone responses of Bradford's matrix so that the light becomes D65 of
/// the same luminance. KELVIN: the light is a black body below 4000 K, CIE daylight above 5000 K,
/// and between a mix of both; low kelvin makes the picture bluer. AUTO (grey world): the light is
/// the mean colour of what is metered, each cone response by a factor 4 at most.
/// @param options  NULL = defaults
/// @param display  out: 3 channels of 8 bits, which the caller destroys; NULL on failure
/// @param exposure NULL, or out: the exposure value used. A picture in which nothing can be
///        metered is exposed by 0
/// @return ALP_OK; INVALID_ARGUMENT (NULL, 8-bit image, options); OUT_OF_MEMORY
/// Based on: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda. Photographic tone reproduction for
/// digital images. SIGGRAPH 2002 (key and curve; the curve here by channel, not by luminance);
/// J. Hable. Filmic tonemapping operators. 2010; K. M. Lam. Metamerism and colour constancy.
/// University of Bradford 1985.
ALP_API ALP_NODISCARD alp_result alp_film_develop(const alp_image *linear,
                                                  const alp_film_options *options,
                                                  alp_image **display, double *exposure);

/// Mean of log2 of luminance (Rec. 709) after white balance, over the pixels that count: alpha
/// above 0, finite, luminance above 0; of these the darkest share `meter_low` and the brightest
/// 1 − `meter_high` are left out (by steps of 1/128 of a doubling). Twice the light is exactly 1
/// more.
/// @param log2_luminance out; unchanged when no pixel counts
/// @param pixels         NULL, or out: how many pixels count; 0 is not an error
/// @return as alp_film_develop
ALP_API ALP_NODISCARD alp_result alp_film_meter(const alp_image *linear,
                                                const alp_film_options *options,
                                                double *log2_luminance, uint64_t *pixels);

/// What a film (or an eye) has adapted to, carried from picture to picture of a sequence. Plain
/// data: copy it, or keep one for each view.
typedef struct alp_film_adaptation {
    size_t struct_size;
    double log2_luminance; ///< adapted to; has a meaning once `adapted` is true
    bool adapted;          ///< false (default): the first picture is adapted to at once
    double brighter_seconds, darker_seconds; ///< time constants towards brighter and darker
                                             ///< pictures, ≥ 0; default 0.4 and 1.2
} alp_film_adaptation;
/// Eyes take minutes to adapt to the dark and less to adapt to light; the default keeps that order
/// at the pace of a film. It is chosen, not measured.
ALP_API alp_film_adaptation alp_film_adaptation_default(void);

/// Lets `seconds` pass while the picture `linear` is seen:
///
///     a ← m + (a − m) e^(−seconds / T),   a adapted, m metered log2 luminance
///
/// with T for m above or below a. After T ln 2 seconds half the way is gone. However a time is cut
/// into steps, the result is the same to rounding, as long as the picture stays.
/// A picture in which nothing can be metered changes nothing.
/// @param seconds  since the picture before, ≥ 0
/// @param options  NULL = defaults; how to meter, and the key
/// @param exposure NULL, or out: the exposure value that makes what is adapted to L = key, held to
///        [−64, 64]; give it to alp_film_develop as `exposure`. 0 while nothing was ever metered
/// @return as alp_film_develop; INVALID_ARGUMENT also for a time that is negative or not a number
/// Compare: S. N. Pattanaik, J. Tumblin, H. Yee, D. P. Greenberg. Time-dependent visual adaptation
/// for fast realistic image display. SIGGRAPH 2000, whose model of the eye this is not.
ALP_API ALP_NODISCARD alp_result alp_film_adapt(alp_film_adaptation *state, const alp_image *linear,
                                                const alp_film_options *options, double seconds,
                                                double *exposure);

ALP_END_DECLS

#endif
