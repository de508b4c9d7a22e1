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

const sets = ['alpenglowUv0', 'alpenglowUv1', 'alpenglowUv2'];
/// Of which entry of extras.alpenglow_blend.maps a map of three.js comes.
const origins = {
  aoMap: ['occlusionTexture'],
  lightMap: ['lightmap', 'MOZ_lightmap'],
  emissiveMap: ['emissiveTexture'],
};
const chunks = ['aomap_fragment', 'lights_fragment_maps', 'emissivemap_fragment'];

const vertexHead = `
${sets.map((name) => `attribute vec2 ${name};`).join('\n')}
${sets.map((_, k) => `varying vec2 vAlpenglowUv${k};`).join('\n')}
varying vec3 vAlpenglowNormal;
varying vec3 vAlpenglowPosition;
`;
const vertexBody = `
${sets.map((name, k) => `vAlpenglowUv${k} = ${name};`).join('\n')}
vAlpenglowNormal = normal;
vAlpenglowPosition = position;
`;
// A mesh without normals is flat: there the attribute is 0.
const fragmentHead = `
${sets.map((_, k) => `varying vec2 vAlpenglowUv${k};`).join('\n')}
varying vec3 vAlpenglowNormal;
varying vec3 vAlpenglowPosition;
${blendFunction}
vec4 alpenglowRead(sampler2D map) {
  vec3 flatNormal = cross(dFdx(vAlpenglowPosition), dFdy(vAlpenglowPosition));
  vec3 n = dot(vAlpenglowNormal, vAlpenglowNormal) > 0.0 ? vAlpenglowNormal : flatNormal;
  return alpenglowBlend(map, vAlpenglowUv0, vAlpenglowUv1, vAlpenglowUv2, n);
}
`;

/// The name that GLTFLoader gives an attribute: it knows the first four sets.
function loadedName(attribute) {
  const number = /^TEXCOORD_([0-3])$/.exec(attribute)?.[1];
  if (number === undefined) return attribute.toLowerCase();
  return number === '0' ? 'uv' : `uv${number}`;
}

/// Gives a geometry the three sets under the names that the shader reads; false where one is absent.
export function blendGeometry(geometry, description) {
  const found = description.sets.map((name) => geometry.getAttribute(loadedName(name)));
  if (found.length !== 3 || found.some((attribute) => attribute === undefined)) return false;
  found.forEach((attribute, k) => geometry.setAttribute(sets[k], attribute));
  return true;
}

/// Patches the shader of a material: maps that `description.maps` names are blended. `chunk` is
/// THREE.ShaderChunk.
export function blendMaterial(material, description, chunk) {
  const blended = Object.keys(origins).filter((map) => origins[map].some((from) => description.maps.includes(from)));
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
      .replace('#include <common>', `#include <common>\n${vertexHead}`)
      .replace('#include <begin_vertex>', `#include <begin_vertex>\n${vertexBody}`);
    let text = shader.fragmentShader.replace('#include <common>', `#include <common>\n${fragmentHead}`);
    for (const name of chunks) text = text.replace(`#include <${name}>`, chunk[name]);
    for (const map of blended) {
      text = text.replace(new RegExp(`texture2D\\( ${map}, v\\w+ \\)`, 'g'), `alpenglowRead( ${map} )`);
    }
    shader.fragmentShader = text;
  };
  material.customProgramCacheKey = () => `${key} alpenglow-blend ${blended.join(' ')}`;
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
