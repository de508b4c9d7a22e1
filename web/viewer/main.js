// SPDX-License-Identifier: MIT
// The page of alpenglow web: loads its scene, builds the panel and draws when something changes.
import * as THREE from 'three';
import { blendScene } from 'alpenglow/three-blend.js';
import { makeCamera } from 'alpenglow/camera.js';
import { measureChange, meter, setFilm } from 'alpenglow/film.js';
import { findMaps, makeSwitch, replaceMaterials } from 'alpenglow/maps.js';
import { buildPanel } from 'alpenglow/panel.js';
import { makeLayers } from 'alpenglow/layers.js';
import { makeSphere } from 'alpenglow/probes.js';
import { loadScene } from 'alpenglow/scene.js';
import { makeSlices } from 'alpenglow/slices.js';

const canvas = document.getElementById('view');
const message = document.getElementById('message');

function stop(text) {
  canvas.hidden = true;
  document.getElementById('panel').hidden = true;
  message.hidden = false;
  message.textContent = text;
}

/// A renderer, or null after a message.
function makeRenderer() {
  if (document.createElement('canvas').getContext('webgl2') === null) {
    stop('This browser has no WebGL 2, which the scene needs. Open the page in another browser, or switch hardware acceleration on.');
    return null;
  }
  canvas.addEventListener('webglcontextlost', () => stop('The browser took the graphics memory of the scene away. Load the page again.'));
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
  renderer.setClearColor(0x26292d);
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  return renderer;
}

/// Light of the same strength from all sides: a white surface becomes 1. A scene without maps has
/// some from above too, so that its form can be seen.
function plainLight(found) {
  const group = new THREE.Group();
  if (found.occlusion || found.light !== null) group.add(new THREE.AmbientLight(0xffffff, Math.PI));
  else group.add(new THREE.HemisphereLight(0xffffff, 0x404040, Math.PI));
  return group;
}

/// Lamps of the file light nothing unless the bake left their direct light to the viewer.
function removeLamps(root, bake) {
  if (bake?.light?.direct === 'off') return;
  for (const lamp of root.getObjectsByProperty('isLight', true)) lamp.removeFromParent();
}

function resize(renderer, view) {
  const { clientWidth, clientHeight } = canvas;
  if (clientWidth === 0 || clientHeight === 0) return;
  renderer.setSize(clientWidth, clientHeight, false);
  view.fit(clientWidth, clientHeight);
}

/// Dimmers for the lights, and how far the sum of their maps is from the light of the file.
function addLayers(layers, materials, renderer, scene, camera) {
  if (layers.length === 0) return { dim: null, apart: 0 };
  let dim = null;
  const apart = measureChange(renderer, scene, camera, () => (dim = makeLayers(layers, materials, renderer)));
  return { dim, apart };
}

/// Draws the scene, and overlays in it: its depth hides those behind it.
function drawAll(renderer, camera, scene, overlays) {
  renderer.render(scene, camera);
  renderer.autoClear = false;
  for (const overlay of overlays) {
    if (overlay?.scene.visible) renderer.render(overlay.scene, camera);
  }
  renderer.autoClear = true;
}

async function start(renderer) {
  const { gltf, name, camera, layers, probes, grids } = await loadScene(renderer);
  const bake = gltf.asset?.extras?.alpenglow;
  const scene = new THREE.Scene();
  scene.add(gltf.scene);
  removeLamps(gltf.scene, bake);
  const view = makeCamera(gltf, camera, canvas);
  const materials = replaceMaterials(gltf.scene);
  const { dim, apart } = addLayers(layers, materials, renderer, scene, view.camera);
  blendScene(gltf.scene, THREE.ShaderChunk);
  const found = findMaps(materials, bake);
  const apply = makeSwitch(materials, found);
  const plain = plainLight(found);
  scene.add(plain);
  const state = { light: found.light !== null, occlusion: found.occlusion && found.light === null, colours: true, slices: false };
  let waits = false;
  const draw = () => {
    waits = false;
    drawAll(renderer, view.camera, scene, [sphere, slices]);
  };
  const request = () => {
    if (!waits) requestAnimationFrame(draw);
    waits = true;
  };
  const sphere = probes !== null ? makeSphere(probes, view, canvas, request) : null;
  const slices = grids.length > 0 ? makeSlices(grids, gltf.scene, view.camera, request) : null;
  const film = (exposure) => {
    setFilm(renderer, state.light, exposure);
    request();
  };
  const show = () => {
    apply(state);
    plain.visible = !state.light;
    const lit = state.light || found.light === null; // even light is not that of probes or slices
    if (sphere !== null) sphere.scene.visible = lit;
    if (slices !== null) slices.scene.visible = lit && state.slices;
    request();
  };
  show();
  resize(renderer, view);
  new ResizeObserver(() => {
    resize(renderer, view);
    draw(); // before the empty canvas is seen
  }).observe(canvas);
  view.controls.addEventListener('change', request);
  buildPanel({ name, found, layers, apart, dim, sphere, slices, state, show, film, view, request, measure: () => (state.light ? meter(renderer, scene, view.camera) : 0) });
  message.hidden = true;
  draw();
  document.documentElement.dataset.ready = 'true';
}

async function run() {
  const renderer = makeRenderer();
  if (renderer !== null) await start(renderer);
}

run().catch((error) => stop(`The scene could not be shown: ${error.message}`));
