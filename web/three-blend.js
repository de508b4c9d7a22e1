// SPDX-License-Identifier: MIT
// Makes three.js show what `alpenglow bake --atlas blend` wrote: the maps of a material are read
// with three coordinate sets and blended by the normal, so that charts have no borders to be seen.
//
//   import { blendScene } from './three-blend.js';
//   const gltf = await new GLTFLoader().loadAsync('baked.glb');
//   blendScene(gltf.scene, THREE.ShaderChunk);
//
// For the built-in materials of WebGLRenderer. Without it the same file shows one set, with seams.

/// web/blend.glsl, less its comments.
export const blendFunction = `vec3 alpenglowBlendWeights(vec3 normal) {
  vec3 n = normalize(normal);
  return n * n;
}

vec4 alpenglowBlend(sampler2D map, vec2 uv0, vec2 uv1, vec2 uv2, vec3 normal) {
  vec3 weights = alpenglowBlendWeights(normal);
  return weights.x * texture(map, uv0) + weights.y * texture(map, uv1) + weights.z * texture(map, uv2);
}
`;

/// Of which entry of extras.alpenglow_blend.maps a map of three.js comes.
const origins = {
  aoMap: ['occlusionTexture'],
  lightMap: ['lightmap', 'MOZ_lightmap'],
  emissiveMap: ['emissiveTexture'],
};
const chunks = ['aomap_fragment', 'lights_fragment_maps', 'emissivemap_fragment'];

/// The sets and maps of each bake, the last one first.
const bakesOf = (description) => [description, ...(description.earlier ?? [])];
const sets = [0, 1, 2];
const attributeName = (bake, k) => `alpenglowUv${bake}${k}`;
const lines = (bakes, line) => bakes.flatMap((bake) => sets.map((k) => line(bake, k))).join('\n');

const vertexHead = (bakes) => `
${lines(bakes, (bake, k) => `attribute vec2 ${attributeName(bake, k)};`)}
${lines(bakes, (bake, k) => `varying vec2 vAlpenglowUv${bake}${k};`)}
varying vec3 vAlpenglowNormal;
varying vec3 vAlpenglowPosition;
`;
const vertexBody = (bakes) => `
${lines(bakes, (bake, k) => `vAlpenglowUv${bake}${k} = ${attributeName(bake, k)};`)}
vAlpenglowNormal = normal;
vAlpenglowPosition = position;
`;
// A mesh without normals is flat: there the attribute is 0.
const fragmentHead = (bakes) => `
${lines(bakes, (bake, k) => `varying vec2 vAlpenglowUv${bake}${k};`)}
varying vec3 vAlpenglowNormal;
varying vec3 vAlpenglowPosition;
${blendFunction}
vec4 alpenglowRead(sampler2D map, vec2 uv0, vec2 uv1, vec2 uv2) {
  vec3 flatNormal = cross(dFdx(vAlpenglowPosition), dFdy(vAlpenglowPosition));
  vec3 n = dot(vAlpenglowNormal, vAlpenglowNormal) > 0.0 ? vAlpenglowNormal : flatNormal;
  return alpenglowBlend(map, uv0, uv1, uv2, n);
}
`;

/// The name that GLTFLoader gives an attribute: it knows the first four sets.
function loadedName(attribute) {
  const number = /^TEXCOORD_([0-3])$/.exec(attribute)?.[1];
  if (number === undefined) return attribute.toLowerCase();
  return number === '0' ? 'uv' : `uv${number}`;
}

/// Gives a geometry the sets of all bakes under the names that the shader reads; false where one is
/// absent.
export function blendGeometry(geometry, description) {
  const bakes = bakesOf(description).map((bake) => bake.sets.map((name) => geometry.getAttribute(loadedName(name))));
  // All of them or none: one shader serves the whole mesh.
  if (bakes.some((found) => found.length !== 3 || found.some((attribute) => attribute === undefined))) return false;
  bakes.forEach((found, bake) => found.forEach((attribute, k) => geometry.setAttribute(attributeName(bake, k), attribute)));
  return true;
}

/// Patches the shader of a material: maps that `description.maps` names, or that of a bake before,
/// are blended. `chunk` is THREE.ShaderChunk.
export function blendMaterial(material, description, chunk) {
  const bakes = bakesOf(description);
  const bakeOf = (map) => bakes.findIndex((bake) => origins[map].some((from) => bake.maps.includes(from)));
  const blended = Object.keys(origins).filter((map) => bakeOf(map) >= 0);
  const used = [...new Set(blended.map(bakeOf))];
  // The shader reads the three sets; a set beyond the fourth, that the file names, three.js does not
  // know. Textures are shared with other materials.
  for (const map of blended.filter((name) => material[name]?.channel > 3)) {
    material[map] = material[map].clone();
    material[map].channel = 0;
  }
  const before = material.onBeforeCompile;
  const key = material.customProgramCacheKey();
  material.onBeforeCompile = function compile(shader, renderer) {
    before.call(this, shader, renderer);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${vertexHead(used)}`)
      .replace('#include <begin_vertex>', `#include <begin_vertex>\n${vertexBody(used)}`);
    let text = shader.fragmentShader.replace('#include <common>', `#include <common>\n${fragmentHead(used)}`);
    for (const name of chunks) text = text.replace(`#include <${name}>`, chunk[name]);
    for (const map of blended) {
      const uvs = sets.map((k) => `vAlpenglowUv${bakeOf(map)}${k}`).join(', ');
      text = text.replace(new RegExp(`texture2D\\( ${map}, v\\w+ \\)`, 'g'), `alpenglowRead( ${map}, ${uvs} )`);
    }
    shader.fragmentShader = text;
  };
  material.customProgramCacheKey = () => `${key} alpenglow-blend ${blended.map((map) => map + bakeOf(map)).join(' ')}`;
  material.needsUpdate = true;
}

/// Patches all materials below `root` whose extras say that they are blended, and their geometries.
/// Call it once, when the file is loaded. @returns how many meshes are blended
export function blendScene(root, chunk) {
  const patched = new Set();
  let count = 0;
  root.traverse((object) => {
    const description = object.isMesh ? object.material.userData?.alpenglow_blend : undefined;
    if (description === undefined || !blendGeometry(object.geometry, description)) return;
    if (!patched.has(object.material)) blendMaterial(object.material, description, chunk);
    patched.add(object.material);
    count += 1;
  });
  return count;
}
