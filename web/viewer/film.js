// SPDX-License-Identifier: MIT
// Exposure and tone curve, those of alpenglow render: film (1 − e^−L) for light, none (cut off at 1)
// for plain light.
import * as THREE from 'three';

THREE.ShaderChunk.tonemapping_pars_fragment = THREE.ShaderChunk.tonemapping_pars_fragment.replace(
  'vec3 CustomToneMapping( vec3 color ) { return color; }',
  'vec3 CustomToneMapping( vec3 color ) { return 1.0 - exp( - toneMappingExposure * max( color, vec3( 0.0 ) ) ); }',
);

export function setFilm(renderer, lit, exposure) {
  renderer.toneMapping = lit ? THREE.CustomToneMapping : THREE.LinearToneMapping;
  renderer.toneMappingExposure = 2 ** exposure;
}

const side = 128;

/// The radiance of a picture of the scene, [128][128][4], without the exposure.
function readRadiance(renderer, scene, camera) {
  const target = new THREE.WebGLRenderTarget(side, side, { type: THREE.FloatType });
  const pixels = new Float32Array(4 * side * side);
  const clear = renderer.getClearColor(new THREE.Color());
  renderer.setClearColor(0x000000, 0);
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.render(scene, camera);
  renderer.readRenderTargetPixels(target, 0, 0, side, side, pixels);
  renderer.setRenderTarget(null);
  renderer.setClearColor(clear, 1);
  target.dispose();
  return pixels;
}

/// Mean difference of pictures of the scene before and after a change, over the mean of the first.
export function measureChange(renderer, scene, camera, change) {
  const before = readRadiance(renderer, scene, camera);
  change();
  const after = readRadiance(renderer, scene, camera);
  let [apart, total] = [0, 0];
  for (let i = 0; i < before.length; i++) {
    if (i % 4 === 3) continue;
    apart += Math.abs(after[i] - before[i]);
    total += before[i];
  }
  return total > 0 ? apart / total : 0;
}

/// The exposure value that makes the picture's mean luminance 18 % grey: the geometric mean without
/// black pixels and the darkest and brightest 5 %. 0 for a black picture.
export function meter(renderer, scene, camera) {
  const pixels = readRadiance(renderer, scene, camera);
  const values = [];
  for (let i = 0; i < pixels.length; i += 4) {
    const luminance = 0.2126 * pixels[i] + 0.7152 * pixels[i + 1] + 0.0722 * pixels[i + 2];
    if (luminance > 0 && Number.isFinite(luminance)) values.push(Math.log2(luminance));
  }
  values.sort((a, b) => a - b);
  const kept = values.slice(Math.floor(0.05 * values.length), Math.ceil(0.95 * values.length));
  if (kept.length === 0) return 0;
  return Math.log2(0.18) - kept.reduce((sum, value) => sum + value, 0) / kept.length;
}
