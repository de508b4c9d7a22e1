// SPDX-License-Identifier: MIT
// Dimmers: the light map of all materials becomes the sum of the maps of single lights, each times
// its strength. The sum is drawn into a texture whenever a strength changes.
import * as THREE from 'three';

const vertexShader = 'varying vec2 at; void main() { at = uv; gl_Position = vec4( position.xy, 0.0, 1.0 ); }';
const fragmentShader =
  'uniform sampler2D map; uniform float strength; varying vec2 at; void main() { gl_FragColor = vec4( strength * texture2D( map, at ).rgb, 1.0 ); }';

function quadOf() {
  const material = new THREE.ShaderMaterial({
    uniforms: { map: { value: null }, strength: { value: 0 } },
    vertexShader,
    fragmentShader,
    depthTest: false,
    transparent: true,
    blending: THREE.CustomBlending,
    blendSrc: THREE.OneFactor,
    blendDst: THREE.OneFactor,
    toneMapped: false,
  });
  const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
  quad.frustumCulled = false;
  return quad;
}

/// One texture for each page of the atlas and each coordinate set that materials read it with. Sets
/// beyond the fourth belong to blended maps, whose shader has its own coordinates.
/// @param scale what 1 of a texture stands for   @returns [{ page, target }]
function makeTargets(materials, pages, scale) {
  const targets = new Map();
  for (const material of materials.filter((m) => m.lightMap !== null)) {
    const channel = material.lightMap.channel > 3 ? 0 : material.lightMap.channel;
    const { page } = material.lightMap.userData;
    if (pages[page] === undefined) throw new Error(`the maps of single lights have no page ${page}`);
    const key = `${page} ${channel}`;
    if (!targets.has(key)) {
      const { width, height } = pages[page].image;
      const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType, depthBuffer: false });
      target.texture.channel = channel;
      targets.set(key, { page, target });
    }
    material.lightMap = targets.get(key).target.texture;
    material.lightMapIntensity = scale;
  }
  return [...targets.values()];
}

/// The strongest that a light can be dimmed to.
export const largestStrength = 2;

/// A power of two: with it as 1, the sum of all lights at their strongest fits half floats.
function scaleOf(layers) {
  const largest = ({ pages }) => pages.reduce((most, { image }) => image.data.reduce((a, b) => Math.max(a, b), most), 0);
  const sum = layers.reduce((total, layer) => total + largestStrength * largest(layer), 0);
  return 2 ** Math.max(0, Math.ceil(Math.log2(sum / 65504)));
}

/// Call it before the maps are switched or blended. @returns dim(index, strength)
export function makeLayers(layers, materials, renderer) {
  const scale = scaleOf(layers);
  const targets = makeTargets(materials, layers[0].pages, scale);
  for (const map of layers.flatMap(({ pages }) => pages)) { // not all devices filter floats
    map.minFilter = map.magFilter = THREE.NearestFilter;
  }
  const scene = new THREE.Scene();
  const quads = layers.map(quadOf);
  const dim = (index, strength) => (quads[index].material.uniforms.strength.value = strength / scale);
  scene.add(...quads);
  const camera = new THREE.Camera();
  const sum = () => {
    const clear = renderer.getClearColor(new THREE.Color());
    renderer.setClearColor(0x000000, 1);
    for (const { page, target } of targets) {
      quads.forEach((quad, i) => (quad.material.uniforms.map.value = layers[i].pages[page]));
      renderer.setRenderTarget(target);
      renderer.render(scene, camera);
    }
    renderer.setRenderTarget(null);
    renderer.setClearColor(clear, 1);
  };
  layers.forEach((layer, i) => dim(i, 1));
  sum();
  return (index, strength) => {
    dim(index, strength);
    sum();
  };
}
