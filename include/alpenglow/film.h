// SPDX-License-Identifier: MIT
// Film: linear light of any strength to display values. Exposure, white balance, tone curve and
// encoding; and adaptation of the exposure over a sequence.
#ifndef ALPENGLOW_FILM_H
#define ALPENGLOW_FILM_H

#include <alpenglow/image.h>

ALP_BEGIN_DECLS

/// Tone curve from exposed light L to a display value in [0, 1], channel by channel.
typedef enum alp_tone {
    ALP_TONE_FILM = 0, ///< 1 − e^(−L), like film: dark values stay, bright ones are never cut off
    ALP_TONE_REINHARD = 1, ///< L (1 + L/w²) / (1 + L): the white point w becomes 1
    ALP_TONE_FILMIC = 2,   ///< Hable's curve with a toe: h(2L) / h(2w), see white_point
    ALP_TONE_NONE = 3      ///< L, cut off at 1
} alp_tone;

typedef enum alp_white_balance {
    ALP_WHITE_BALANCE_OFF = 0,    ///< the white of Rec. 709 (D65) stays white
    ALP_WHITE_BALANCE_KELVIN = 1, ///< light of `kelvin` becomes white
    ALP_WHITE_BALANCE_AUTO = 2    ///< the mean of the picture becomes grey
} alp_white_balance;

/// Rounding to 8 bits. Dithering keeps the mean of smooth areas exact in encoded values. A value
/// between two bytes becomes one of these two. Red, green and blue share their threshold, so grey
/// stays grey. The result depends on the picture alone, without state or seed.
typedef enum alp_dither {
    ALP_DITHER_NONE = 0,    ///< nearest
    ALP_DITHER_ORDERED = 1, ///< a threshold of Bayer's 8 × 8 pattern; packs well
    ALP_DITHER_HASHED = 2   ///< uniform in [−½, ½) byte, white noise keyed by the pixel
} alp_dither;

typedef struct alp_film_options {
    size_t struct_size;
    /// Exposure value, [−64, 64]: L = 2^exposure × radiance. At 0 (default) radiance 1 is L = 1;
    /// each +1 doubles it. This factor is the only k in 1 − e^(−k × radiance).
    double exposure;
    /// true: the exposure is chosen so that the picture's mean luminance (see alp_film_meter)
    /// becomes L = key. It is rounded to 1/100, so that a printed value gives the same picture.
    /// Default false.
    bool auto_exposure;
    float key;                       ///< (0, 1]; default 0.18, middle grey
    float meter_low, meter_high;     ///< [0, 1], low < high; default 0.05 and 0.95
    alp_tone tone;                   ///< default NONE
    float white_point;               ///< w: the L that REINHARD and FILMIC make white, > 0.
                                     ///< INFINITY: none, and REINHARD is L / (1 + L).
                                     ///< 0 (default): 4 for REINHARD, 5.6 for FILMIC.
    alp_white_balance white_balance; ///< default OFF
    float kelvin;                    ///< [1000, 25000]; default 6504 (D65)
    alp_dither dither;               ///< default NONE
} alp_film_options;
/// Keeps values from 0 to 1: no exposure, no curve, no white balance, no dithering.
ALP_API alp_film_options alp_film_options_default(void);

/// Develops a linear float image into an 8-bit sRGB picture: white balance, exposure, tone curve,
/// encoding (IEC 61966-2-1). Before encoding, alpha below 1 mixes in a grey background (byte 96) as
/// light. NaN and −infinity count as 0, +infinity as the brightest value. Values that are negative
/// after white balance become 0.
///
/// White balance scales the cone responses of Bradford's matrix, so that the light becomes D65 of
/// the same luminance. KELVIN: the light is a black body below 4000 K, CIE daylight above 5000 K,
/// and a mix of both between. Low kelvin makes the picture bluer. AUTO (grey world): the light is
/// the mean colour of the metered pixels; each cone response changes by a factor of at most 4.
/// @param options  NULL = defaults
/// @param display  out: 3 channels of 8 bits, which the caller destroys; NULL on failure
/// @param exposure NULL, or out: the exposure value used; 0 if no pixel can be metered
/// @return ALP_OK; INVALID_ARGUMENT (NULL, 8-bit image, options); OUT_OF_MEMORY
/// Based on: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda. Photographic tone reproduction for
/// digital images. SIGGRAPH 2002 (key and curve; the curve here by channel, not by luminance);
/// J. Hable. Filmic tonemapping operators. 2010; K. M. Lam. Metamerism and colour constancy.
/// University of Bradford 1985.
ALP_API ALP_NODISCARD alp_result alp_film_develop(const alp_image *linear,
                                                  const alp_film_options *options,
                                                  alp_image **display, double *exposure);

/// The numbers that develop a picture, for development elsewhere, such as in a shader: with the
/// linear colour c of a pixel, its display values before encoding are
///
///     min(curve(gain · balance · c), 1)
typedef struct alp_film_numbers {
    double exposure;      ///< exposure value
    double gain;          ///< 2^exposure
    double white;         ///< w of the tone curve
    double balance[3][3]; ///< matrix of white balance, rows; the identity without one
} alp_film_numbers;

/// Resolves what options leave to a picture: exposure, white point and white balance.
/// @param options NULL = defaults   @param numbers out
/// @return as alp_film_develop
ALP_API ALP_NODISCARD alp_result alp_film_resolve(const alp_image *linear,
                                                  const alp_film_options *options,
                                                  alp_film_numbers *numbers);

/// Measures the mean of log2 of luminance (Rec. 709) after white balance. A pixel counts if it is
/// finite and its alpha and luminance are above 0. The darkest share `meter_low` of these and the
/// brightest 1 − `meter_high` are left out, in steps of 1/128 of a doubling. Twice the light adds
/// exactly 1.
/// @param log2_luminance out; unchanged if no pixel counts
/// @param pixels         NULL, or out: number of pixels that count; 0 is not an error
/// @return as alp_film_develop
ALP_API ALP_NODISCARD alp_result alp_film_meter(const alp_image *linear,
                                                const alp_film_options *options,
                                                double *log2_luminance, uint64_t *pixels);

/// State of adaptation, carried from picture to picture of a sequence. Plain data: copy it, or keep
/// one for each view.
typedef struct alp_film_adaptation {
    size_t struct_size;
    double log2_luminance; ///< adapted luminance; valid once `adapted` is true
    bool adapted;          ///< false (default): adapts to the first picture at once
    double brighter_seconds, darker_seconds; ///< time constants towards brighter and darker
                                             ///< pictures, ≥ 0; default 0.4 and 1.2
} alp_film_adaptation;
/// Eyes take minutes to adapt to the dark and less to adapt to light. The default keeps that order
/// at the pace of a film. It is chosen, not measured.
ALP_API alp_film_adaptation alp_film_adaptation_default(void);

/// Adapts to the picture `linear` for `seconds`:
///
///     a ← m + (a − m) e^(−seconds / T),   a adapted, m metered log2 luminance
///
/// T is brighter_seconds if m > a, else darker_seconds. Half the change takes T ln 2 seconds. While
/// the picture stays, the number of steps changes the result only by rounding. A picture without a
/// pixel that can be metered changes nothing.
/// @param seconds  since the picture before, ≥ 0
/// @param options  NULL = defaults; the metering and the key
/// @param exposure NULL, or out: the exposure value that makes the adapted luminance L = key, held
///        to [−64, 64]; pass it to alp_film_develop as `exposure`. 0 while nothing was ever
///        metered.
/// @return as alp_film_develop; INVALID_ARGUMENT also for a time that is negative or not a number
/// Compare: S. N. Pattanaik, J. Tumblin, H. Yee, D. P. Greenberg. Time-dependent visual adaptation
/// for fast realistic image display. SIGGRAPH 2000. (Its model of the eye is not used here.)
ALP_API ALP_NODISCARD alp_result alp_film_adapt(alp_film_adaptation *state, const alp_image *linear,
                                                const alp_film_options *options, double seconds,
                                                double *exposure);

ALP_END_DECLS

#endif
