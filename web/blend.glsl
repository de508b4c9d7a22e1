// SPDX-License-Identifier: MIT
// Reads a map that `alpenglow bake --atlas blend` made: three charts that overlap, blended by the
// normal, value = Σ n_k² · L(uv_k). GLSL 3.30 and later, GLSL ES 3.00 and later.
//
// normal: interpolated between the vertices, in the frame of the mesh as the file has it (the
// attribute NORMAL, before any matrix); its length does not matter. Of meshes without normals, that
// of the triangle: cross(dFdx(p), dFdy(p)) of the interpolated attribute POSITION.
// uv0, uv1, uv2: the sets that extras.alpenglow_blend.sets of the material name, in that order; of a
// map that .earlier[i].maps names, those of .earlier[i].sets.
// Textures linear, clamped, without mip levels.
// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU, 2007,
// chapter 7.5.
vec3 alpenglowBlendWeights(vec3 normal) {
  vec3 n = normalize(normal);
  return n * n; // they sum to 1
}

vec4 alpenglowBlend(sampler2D map, vec2 uv0, vec2 uv1, vec2 uv2, vec3 normal) {
  vec3 weights = alpenglowBlendWeights(normal);
  return weights.x * texture(map, uv0) + weights.y * texture(map, uv1) + weights.z * texture(map, uv2);
}
