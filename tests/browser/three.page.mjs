// SPDX-License-Identifier: MIT
// In the browser: a file through the loader that a user would take, into a picture of floats.
import * as THREE from 'three';
import { blendScene } from '/web/three-blend.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

async function load(kind, url) {
  if (kind === 'three') return new THREE.ObjectLoader().loadAsync(url);
  const scene = new THREE.Scene();
  scene.add((await new GLTFLoader().loadAsync(url)).scene);
  return scene;
}

/// White surfaces under light that makes a picture of the occlusion map alone; 'blend light' shows
/// it as a light map, 'blend earlier' as one that a later bake of light left in its own sets. Patched,
/// but for 'plain ao'.
function showMap(scene, kind) {
  const asLight = kind === 'blend light';
  scene.traverse((object) => {
    if (!object.isMesh) return;
    const { aoMap, userData } = object.material;
    object.material = new THREE.MeshLambertMaterial(asLight ? { lightMap: aoMap, lightMapIntensity: Math.PI } : { aoMap });
    object.material.userData = userData;
    if (asLight) object.material.userData.alpenglow_blend.maps = ['lightmap'];
    if (kind === 'blend earlier') {
      const { sets, maps } = userData.alpenglow_blend;
      userData.alpenglow_blend = { sets: [...sets].reverse(), maps: ['lightmap'], earlier: [{ sets, maps }] };
    }
  });
  for (const camera of scene.getObjectsByProperty('isCamera', true)) camera.removeFromParent(); // the given one is meant
  if (!asLight) scene.add(new THREE.AmbientLight(0xffffff, Math.PI));
  if (kind !== 'plain ao') blendScene(scene, THREE.ShaderChunk);
}

function firstCamera(scene, given) {
  const cameras = [];
  scene.traverse((object) => object.isCamera && cameras.push(object));
  if (cameras.length > 0) return cameras[0];
  const camera = new THREE.PerspectiveCamera((given.fov * 180) / Math.PI, 1, 0.001, 1000);
  camera.position.fromArray(given.position);
  camera.up.fromArray(given.up);
  camera.lookAt(...given.target);
  return camera;
}

/// Rows of the picture come from the bottom.
function flip(pixels, side) {
  const rows = [];
  for (let y = side - 1; y >= 0; y--) rows.push(...pixels.subarray(4 * side * y, 4 * side * (y + 1)));
  return rows;
}

window.show = async (kind, folder, file, side, given) => {
  const start = performance.now();
  const scene = await load(kind, folder + file);
  if (/^blend|^plain/.test(kind)) showMap(scene, kind);
  const camera = firstCamera(scene, given);
  camera.aspect = 1;
  camera.updateProjectionMatrix();
  const renderer = new THREE.WebGLRenderer({ antialias: false });
  renderer.setSize(side, side, false);
  const target = new THREE.WebGLRenderTarget(side, side, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = new Float32Array(4 * side * side);
  renderer.readRenderTargetPixels(target, 0, 0, side, side, pixels);
  return { pixels: flip(pixels, side), seconds: (performance.now() - start) / 1000 };
};
