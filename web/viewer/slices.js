// SPDX-License-Identifier: MIT
// Slices of a light propagation volume: one layer of cells across an axis, drawn in the scene. A cell
// shows its mean radiance, fluence / 4π: a white surface that is lit so from all sides looks alike.
import * as THREE from 'three';

/// The two axes along which the slices across an axis lie.
const acrossOf = (axis) => [(axis + 1) % 3, (axis + 2) % 3];

/// The texels of a slice, [n][n][4], and the largest fluence of a channel in it.
function readLayer({ size, fluence }, axis, layer) {
  const [u, v] = acrossOf(axis);
  const texels = new Float32Array(4 * size[u] * size[v]);
  const cell = [0, 0, 0];
  let [brightest, at] = [0, 0];
  cell[axis] = layer;
  for (cell[v] = 0; cell[v] < size[v]; cell[v]++) {
    for (cell[u] = 0; cell[u] < size[u]; cell[u]++, at += 4) {
      const first = 3 * (cell[0] + size[0] * (cell[1] + size[1] * cell[2]));
      for (let k = 0; k < 3; k++) {
        texels[at + k] = fluence[first + k] / (4 * Math.PI);
        brightest = Math.max(brightest, fluence[first + k]);
      }
      texels[at + 3] = 1;
    }
  }
  return { texels, brightest };
}

/// Mean radiance of the cells with light, all channels. 0: there are none.
function meanOf({ fluence }) {
  let [sum, count] = [0, 0];
  for (let i = 0; i < fluence.length; i += 3) {
    const cell = fluence[i] + fluence[i + 1] + fluence[i + 2];
    sum += cell / (12 * Math.PI);
    count += cell > 0;
  }
  return count > 0 ? sum / count : 0;
}

const farApart = 4; // EV

/// The exposure of a grid's slices beside that of the page, EV: 0, or what makes the grid's mean 18 %
/// grey if that is far from the page's exposure.
function shiftOf(grid, exposure) {
  const mean = meanOf(grid);
  const shift = mean > 0 ? Math.log2(0.18 / mean) - exposure : 0;
  return Math.abs(shift) > farApart ? shift : 0;
}

/// The place of the middle of a layer, in metres.
const placeOf = ({ corner, cell }, axis, layer) => corner[axis] + (layer + 0.5) * cell;

/// Corners of the slice from the corner of the grid, [4][3], in the order of the texture's rows. Floats
/// hold them also where the grid is far from the origin.
function cornersOf(grid, axis, layer) {
  const [u, v] = acrossOf(axis);
  return [[0, 0], [1, 0], [0, 1], [1, 1]].flatMap(([a, b]) => {
    const point = [0, 0, 0];
    point[axis] = (layer + 0.5) * grid.cell;
    point[u] = a * grid.size[u] * grid.cell;
    point[v] = b * grid.size[v] * grid.cell;
    return point;
  });
}

/// The first and the last layer across an axis that hold part of the scene. A scene often ends where a
/// cell does: a thousandth of a cell is no part.
function rangeOf({ corner, cell, size }, axis, bounds) {
  const clamp = (layer) => THREE.MathUtils.clamp(layer, 0, size[axis] - 1);
  const cellsTo = (point) => (point.getComponent(axis) - corner[axis]) / cell;
  const first = clamp(Math.floor(cellsTo(bounds.min) + 1e-3));
  return [first, Math.max(first, clamp(Math.ceil(cellsTo(bounds.max) - 1e-3) - 1))];
}

/// The axis whose slices face the camera most.
function facingAxis(camera) {
  const ahead = camera.getWorldDirection(new THREE.Vector3()).toArray().map(Math.abs);
  return ahead.indexOf(Math.max(...ahead));
}

function makeQuad() {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(12), 3));
  geometry.setAttribute('uv', new THREE.BufferAttribute(new Float32Array([0, 0, 1, 0, 0, 1, 1, 1]), 2));
  geometry.setIndex([0, 1, 2, 2, 1, 3]);
  const quad = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
  quad.frustumCulled = false;
  return quad;
}

/// @param grids [{ cell, corner, size, fluence }], the finest first   @param root the scene
/// @param camera that will see them first   @param changed called after `show`
/// @returns { scene, grids, axis, range(grid, axis), expose(exposure), show(grid, axis, layer) }: the first
/// axis; expose takes the automatic exposure of the page, EV; show returns { place, brightest, shift }, m, W/m²
/// and EV
export function makeSlices(grids, root, camera, changed) {
  let shifts = grids.map(() => 0);
  const expose = (exposure) => (shifts = grids.map((grid) => shiftOf(grid, exposure)));
  const bounds = new THREE.Box3().setFromObject(root);
  const quad = makeQuad();
  const scene = new THREE.Scene();
  scene.add(quad);
  scene.visible = false;
  const show = (index, axis, layer) => {
    const grid = grids[index];
    const [u, v] = acrossOf(axis);
    const { texels, brightest } = readLayer(grid, axis, layer);
    quad.material.map?.dispose();
    quad.material.map = new THREE.DataTexture(texels, grid.size[u], grid.size[v], THREE.RGBAFormat, THREE.FloatType);
    quad.material.color.setScalar(2 ** shifts[index]);
    quad.material.map.needsUpdate = true; // its filter is the nearest texel: a square is a cell
    quad.material.needsUpdate = true;
    quad.geometry.attributes.position.array.set(cornersOf(grid, axis, layer));
    quad.geometry.attributes.position.needsUpdate = true;
    quad.position.fromArray(grid.corner);
    changed();
    return { place: placeOf(grid, axis, layer), brightest, shift: shifts[index] };
  };
  return { scene, grids, axis: facingAxis(camera), expose, show, range: (index, axis) => rangeOf(grids[index], axis, bounds) };
}
