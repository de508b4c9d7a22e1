// SPDX-License-Identifier: MIT
// In the browser: a white sphere in the light of a module of probes, into a picture of floats.
import * as THREE from 'three';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';

/// The class for WebGLRenderer has two names.
async function gridClass() {
  const name = parseInt(THREE.REVISION) < 186 ? 'LightProbeGrid' : 'LightProbeGridWebGL';
  return (await import(`three/addons/lighting/${name}.js`))[name];
}

/// Rows of the picture come from the bottom.
function flip(pixels, side) {
  const rows = [];
  for (let y = side - 1; y >= 0; y--) rows.push(...pixels.subarray(4 * side * y, 4 * side * (y + 1)));
  return rows;
}

window.show = async (kind, folder, file, side, given) => {
  const start = performance.now();
  const renderer = new THREE.WebGLRenderer({ antialias: false });
  renderer.setSize(side, side, false);
  const loader = new KTX2Loader().detectSupport(renderer);
  const { loadProbes } = await import(folder + file);
  const scene = new THREE.Scene();
  scene.add(await loadProbes(await gridClass(), loader, THREE.REVISION));
  const sphere = new THREE.Mesh(new THREE.SphereGeometry(given.sphere[3], 512, 256), new THREE.MeshLambertMaterial());
  sphere.position.set(...given.sphere.slice(0, 3));
  scene.add(sphere);
  const camera = new THREE.PerspectiveCamera((given.fov * 180) / Math.PI, 1, 0.01, 100);
  camera.position.fromArray(given.position);
  camera.lookAt(...given.target);
  const target = new THREE.WebGLRenderTarget(side, side, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = new Float32Array(4 * side * side);
  renderer.readRenderTargetPixels(target, 0, 0, side, side, pixels);
  return { pixels: flip(pixels, side), seconds: (performance.now() - start) / 1000 };
};
