#version 450 core
// Development as of alp_film_develop: white balance, exposure, tone curve, sRGB, rounding.
#include "bindings.h"
#include "shared_constants.h"

layout(location = UNIFORM_GAIN) uniform float gain;
layout(location = UNIFORM_TONE) uniform int tone;
layout(location = UNIFORM_WHITE) uniform float white;
layout(location = UNIFORM_BALANCE) uniform mat3 balance;
layout(location = UNIFORM_DITHER) uniform bool dither;
layout(binding = TEXTURE_PICTURE) uniform sampler2D light_picture;

layout(location = 0) out vec4 picture;

// An alp_tone.
const int TONE_FILM = 0, TONE_REINHARD = 1, TONE_FILMIC = 2;

/// Hable's curve.
vec3 filmic(vec3 light)
{
    vec3 x = ALP_FILMIC_GAIN * light;
    return x * ((ALP_FILMIC_F - ALP_FILMIC_E) * ALP_FILMIC_A * x +
                ALP_FILMIC_B * (ALP_FILMIC_C * ALP_FILMIC_F - ALP_FILMIC_E)) /
           (ALP_FILMIC_F * (x * (ALP_FILMIC_A * x + ALP_FILMIC_B) + ALP_FILMIC_D * ALP_FILMIC_F));
}

vec3 curve(vec3 exposed)
{
    vec3 l = clamp(exposed, 0.0, ALP_TONE_BRIGHTEST);
    switch (tone) {
    case TONE_FILM:
        return 1.0 - exp(-l);
    case TONE_REINHARD:
        return l * (1.0 + l / (white * white)) / (1.0 + l);
    case TONE_FILMIC:
        return filmic(l) / filmic(vec3(white));
    default:
        return l;
    }
}

/// Linear to encoded, IEC 61966-2-1.
vec3 encode(vec3 linear)
{
    vec3 l = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(l, vec3(1.0 / 2.4)) - 0.055, 12.92 * l,
               lessThanEqual(l, vec3(0.0031308)));
}

float decode(float encoded)
{
    return pow((encoded + 0.055) / 1.055, 2.4);
}

// Whole numbers of 64 bits: x the lower half, y the upper one.
uvec2 multiply(uvec2 a, uvec2 b)
{
    uint high, low;
    umulExtended(a.x, b.x, high, low);
    return uvec2(low, high + a.x * b.y + a.y * b.x);
}

uvec2 shift_right(uvec2 a, int bits)
{
    return uvec2(a.x >> bits | a.y << (32 - bits), a.y >> bits);
}

/// alpi_hash64: the finalizer of SplitMix64.
uvec2 hash(uvec2 x)
{
    uint carry;
    x.x = uaddCarry(x.x, 0x7f4a7c15u, carry);
    x.y += 0x9e3779b9u + carry;
    x = multiply(x ^ shift_right(x, 30), uvec2(0x1ce4e5b9u, 0xbf58476du));
    x = multiply(x ^ shift_right(x, 27), uvec2(0x133111ebu, 0x94d049bbu));
    return x ^ shift_right(x, 31);
}

/// Added before the fraction is cut off, [0, 1): 24 bits of those of ALP_DITHER_HASHED.
float threshold(uvec2 pixel)
{
    uvec2 seed = hash(uvec2(0u));
    return dither ? float(hash(hash(seed ^ pixel)).y >> 8) * (1.0 / 16777216.0) : 0.5;
}

void main()
{
    vec4 light = texelFetch(light_picture, ivec2(gl_FragCoord.xy), 0);
    float background = decode(ALP_FILM_BACKGROUND / 255.0);
    vec3 values = min(curve(gain * (balance * light.rgb)), 1.0);
    vec3 mixed = mix(vec3(background), values, clamp(light.a, 0.0, 1.0));
    vec3 bytes = floor(encode(mixed) * 255.0 + threshold(uvec2(gl_FragCoord.xy)));
    picture = vec4(light.a > 0.0 ? bytes / 255.0 : vec3(ALP_FILM_BACKGROUND / 255.0), 1.0);
}
