// SPDX-License-Identifier: MIT
// Randomness without state: every number is a function of (seed, receiver, sample), so results do
// not depend on who computes them or when.
//
// Owen-scrambled (0,2)-sequence in base 2: Sobol' dimensions 0 and 1, index shuffled and digits
// scrambled by a hash that acts like a nested uniform scramble.
// Based on: Brent Burley. Practical Hash-based Owen Scrambling. JCGT 10(4), 2020;
//           Samuli Laine, Tero Karras. Stratified Sampling for Stochastic Transparency. EGSR 2011.
#ifndef ALPI_BASE_RANDOM_H
#define ALPI_BASE_RANDOM_H

#include "base/vec.h"

#include <stdint.h>
#include <string.h>

/// A good 32-bit mix (lowbias32 of Chris Wellons' hash-prospector, found by search).
static inline uint32_t alpi_hash32(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/// Mix of 64 bits (the finalizer of SplitMix64, Steele, Lea, Flood 2014).
static inline uint64_t alpi_hash64(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// Key of one receiver's sequence; `stream` tells independent uses at one receiver apart.
static inline uint32_t alpi_random_key(uint64_t seed, uint64_t receiver, uint32_t stream)
{
    uint64_t mixed = alpi_hash64(alpi_hash64(alpi_hash64(seed) ^ receiver) ^ stream);
    return (uint32_t)(mixed >> 32);
}

static inline uint32_t alpi_reverse_bits(uint32_t x)
{
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}

/// A permutation in which bit i depends on bits below i only (Laine–Karras, constants by Burley's
/// successor Vegdahl: fewer correlated bits). Between two bit reversals it is an Owen scramble.
static inline uint32_t alpi_owen_hash(uint32_t x, uint32_t key)
{
    x ^= x * 0x3d20adeau;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

static inline uint32_t alpi_owen_scramble(uint32_t x, uint32_t key)
{
    return alpi_reverse_bits(alpi_owen_hash(alpi_reverse_bits(x), key));
}

/// Second Sobol' dimension, bits reversed (the first is the index itself, bits reversed). Its
/// matrix, of the primitive polynomial x + 1, is Pascal's triangle modulo 2; by Lucas bit j of the
/// product is the sum of all bits k of the index with j a subset of k, which five folds compute.
static inline uint32_t alpi_sobol_1_reversed(uint32_t index)
{
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    index ^= (index >> 16) & 0x0000ffffu;
    return index;
}

/// [0, 1) from 32 random bits: the upper 24, which a float holds exactly.
static inline float alpi_unit_float(uint32_t bits)
{
    return (float)(bits >> 8) * 0x1p-24f;
}

/// `pick` with more digits: 24 of them cannot tell 2^24 things apart, nor find one of less than a
/// 2^-24th. The new ones are a hash of u, which they leave as even as it was.
static inline double alpi_finer_pick(float pick, vec2 u)
{
    uint32_t x, y;
    memcpy(&x, &u.x, sizeof x);
    memcpy(&y, &u.y, sizeof y);
    return (double)pick + (double)alpi_hash32(alpi_hash32(x) ^ y) * 0x1p-56;
}

/// Point `sample` of the sequence of `key`: two coordinates in [0, 1). Any 2^k points that start at
/// a multiple of 2^k are one in each elementary interval of area 2^-k.
static inline vec2 alpi_sample_2d(uint32_t key, uint32_t sample)
{
    uint32_t shuffled = alpi_owen_scramble(sample, alpi_hash32(key ^ 0x68bc21ebu));
    // A scramble of a number whose bits are reversed already needs only the second reversal.
    uint32_t x = alpi_reverse_bits(alpi_owen_hash(shuffled, alpi_hash32(key ^ 0x02e5be93u)));
    uint32_t y = alpi_reverse_bits(
        alpi_owen_hash(alpi_sobol_1_reversed(shuffled), alpi_hash32(key ^ 0x967a889bu)));
    return (vec2){alpi_unit_float(x), alpi_unit_float(y)};
}

#endif
