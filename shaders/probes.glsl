// SPDX-License-Identifier: MIT
// Irradiance from baked probes. GLSL ES 3.00 and later, GLSL 3.30 and later.
//
// Put this text behind the #version line and the default precision of floats. For each point call
//
//     vec3 e = alpenglowProbeIrradiance(position, normal); // W/m²
//
// position: metres, in the space of alpenglowProbeOrigin. normal: of length 1, in the same space.
// A matte surface of albedo a reflects the radiance a e / pi.
//
// The files are OUT.probes.json and two KTX2 textures, as docs/manual/probe-format.md states. Only
// grids are read. Layers count fully, and gradients are left out.
//
//     uniform                  value
//     alpenglowProbeLight      OUT.probes.ktx2: 3D, RGBA16F, no mip levels
//     alpenglowProbeMoments    OUT.probes.moments.ktx2: 3D, RG16F, no mip levels
//     alpenglowProbeSize       "size"
//     alpenglowProbeOrigin     "origin"
//     alpenglowProbeSpacing    "spacing"
//     alpenglowProbeScale      "scale", or 1 without it
//     alpenglowProbeReach      "textures"."moments"."reach", or 0 without that texture
//
// Define ALPENGLOW_PROBE_COEFFICIENTS before this text for a basis other than sh9.
//
// The eight probes round the point p are weighed by
//
//     w = trilinear * crush(visibility * (((dot(n, o) + 1) / 2)^2 + .2)),   o: from p to the probe
//
//     visibility = 1 at distances d <= m1, else max(.05, (v / (v + (d - m1)^2))^3), v = |m2 - m1^2|
//     crush(w)   = w^3 / .04 below .2, else w
//
// m1 and m2 are the mean distance that the probe met towards p, and the mean of its square. Without
// distances the weights are trilinear alone. Probes in solids count only where no other does.
// Based on: Z. Majercik, J.-P. Guertin, D. Nowrouzezahrai, M. McGuire. Dynamic Diffuse Global
//           Illumination with Ray-Traced Irradiance Fields. JCGT 8(2), 2019.
#ifndef ALPENGLOW_PROBE_COEFFICIENTS
#define ALPENGLOW_PROBE_COEFFICIENTS 9 // sh9; 4: sh4; 6: ambient-cube
#endif

uniform highp sampler3D alpenglowProbeLight;
uniform highp sampler3D alpenglowProbeMoments;
uniform highp ivec3 alpenglowProbeSize;
uniform highp vec3 alpenglowProbeOrigin, alpenglowProbeSpacing;
uniform highp float alpenglowProbeScale, alpenglowProbeReach;

// A texel of a probe: its slabs lie one behind the other.
highp vec4 alpenglowProbeTexel(highp ivec3 probe, int slab) {
  return texelFetch(alpenglowProbeLight, probe + ivec3(0, 0, slab * alpenglowProbeSize.z), 0);
}

// Weights times four coefficients of three channels, which fill three texels.
highp vec3 alpenglowProbeFour(highp ivec3 probe, int slab, highp vec4 w) {
  highp vec4 a = alpenglowProbeTexel(probe, slab);
  highp vec4 b = alpenglowProbeTexel(probe, slab + 1);
  highp vec4 c = alpenglowProbeTexel(probe, slab + 2);
  return w.x * a.xyz + w.y * vec3(a.w, b.xy) + w.z * vec3(b.zw, c.x) + w.w * c.yzw;
}

// Irradiance by one probe, over the scale.
highp vec3 alpenglowProbeLightOf(highp ivec3 probe, highp vec3 n) {
#if ALPENGLOW_PROBE_COEFFICIENTS == 6
  highp vec3 square = n * n;
  highp vec3 plus = mix(vec3(0.0), square, greaterThan(n, vec3(0.0)));
  highp vec3 minus = square - plus;
  highp vec4 a = alpenglowProbeTexel(probe, 3);
  highp vec4 b = alpenglowProbeTexel(probe, 4);
  return alpenglowProbeFour(probe, 0, vec4(plus.x, minus.x, plus.y, minus.y)) + plus.z * a.xyz +
         minus.z * vec3(a.w, b.xy);
#else
  // A Y: pi, 2 pi / 3 and pi / 4 times the spherical harmonics.
  highp vec3 e = alpenglowProbeFour(probe, 0, vec4(0.88622693, 1.0233267 * n.y, 1.0233267 * n.z,
                                                   1.0233267 * n.x));
#if ALPENGLOW_PROBE_COEFFICIENTS == 9
  e += alpenglowProbeFour(probe, 3, vec4(0.85808553 * n.x * n.y, 0.85808553 * n.y * n.z,
                                         0.24770796 * (3.0 * n.z * n.z - 1.0),
                                         0.85808553 * n.x * n.z));
  e += 0.42904276 * (n.x * n.x - n.y * n.y) * alpenglowProbeTexel(probe, 6).xyz;
#endif
  return e;
#endif
}

// Distances of a probe in a texel of its tile. Beyond an edge the map goes on, mirrored along it.
highp vec2 alpenglowProbeDistances(highp ivec3 probe, highp ivec2 t) {
  if (t.y < 0 || t.y > 7) {
    t = ivec2(7 - t.x, t.y < 0 ? 0 : 7);
  }
  if (t.x < 0 || t.x > 7) {
    t = ivec2(t.x < 0 ? 0 : 7, 7 - t.y);
  }
  highp vec2 shares = texelFetch(alpenglowProbeMoments, ivec3(8 * probe.xy + t, probe.z), 0).xy;
  return shares * vec2(alpenglowProbeReach, alpenglowProbeReach * alpenglowProbeReach);
}

// Share of a probe's light that is not hidden at the end of a way from it, metres.
highp float alpenglowProbeVisibility(highp ivec3 probe, highp vec3 way, highp float distance) {
  highp vec3 d = way / (abs(way.x) + abs(way.y) + abs(way.z));
  highp vec2 q = d.xy;
  if (d.z < 0.0) {
    q = (1.0 - abs(d.yx)) * vec2(d.x >= 0.0 ? 1.0 : -1.0, d.y >= 0.0 ? 1.0 : -1.0);
  }
  highp vec2 at = 4.0 * q + 3.5; // between the centres of texels
  highp ivec2 t = ivec2(floor(at));
  highp vec2 part = at - vec2(t);
  highp vec2 m = mix(mix(alpenglowProbeDistances(probe, t),
                         alpenglowProbeDistances(probe, t + ivec2(1, 0)), part.x),
                     mix(alpenglowProbeDistances(probe, t + ivec2(0, 1)),
                         alpenglowProbeDistances(probe, t + ivec2(1, 1)), part.x),
                     part.y);
  highp float variance = abs(m.y - m.x * m.x) + 1e-12;
  highp float beyond = max(distance - m.x, 0.0);
  highp float share = variance / (variance + beyond * beyond);
  return max(share * share * share, 0.05);
}

// Factor on a probe's weight. way: from the point to the probe
highp float alpenglowProbeWeight(highp ivec3 probe, highp vec3 way, highp vec3 normal) {
  highp float distance = length(way);
  highp float facing = 0.5 * (dot(normal, way) / max(distance, 1e-12) + 1.0);
  highp float w = facing * facing + 0.2;
  if (distance > 0.0) {
    w *= alpenglowProbeVisibility(probe, -way, distance);
  }
  return w < 0.2 ? w * w * w * 25.0 : w;
}

highp vec3 alpenglowProbeIrradiance(highp vec3 position, highp vec3 normal) {
  highp vec3 last = vec3(alpenglowProbeSize - 1);
  highp vec3 cells = clamp((position - alpenglowProbeOrigin) / alpenglowProbeSpacing, vec3(0.0), last);
  highp ivec3 low = min(ivec3(cells), max(alpenglowProbeSize - 2, ivec3(0)));
  highp vec3 part = cells - vec3(low);
  const int slabs = (3 * ALPENGLOW_PROBE_COEFFICIENTS + 3) / 4;
  highp vec4 seen = vec4(0.0);  // by probes outside solids: weight times irradiance, weight
  highp vec4 every = vec4(0.0); // by all that are not black
  for (int corner = 0; corner < 8; corner++) {
    highp ivec3 upper = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    highp ivec3 probe = low + upper;
    highp vec3 three = mix(1.0 - part, part, vec3(upper));
    highp float w = three.x * three.y * three.z;
    if (!(w > 0.0)) {
      continue;
    }
    highp vec4 move = alpenglowProbeTexel(probe, slabs); // and the state
    int state = int(move.w + 0.5);
    if (state == 3) {
      continue;
    }
    highp vec4 light = vec4(alpenglowProbeLightOf(probe, normal), 1.0);
    every += w * light;
    if (state < 2 && alpenglowProbeReach > 0.0) {
      highp vec3 place = alpenglowProbeOrigin + alpenglowProbeSpacing * vec3(probe) + move.xyz;
      seen += w * alpenglowProbeWeight(probe, place - position, normal) * light;
    }
  }
  highp vec4 sum = seen.w > 0.0 ? seen : every;
  return sum.w > 0.0 ? max(sum.xyz / sum.w, vec3(0.0)) * alpenglowProbeScale : vec3(0.0);
}
