// SPDX-License-Identifier: MIT
// A white sphere lit by baked probes, which can be dragged. It has a scene of its own, because a light
// probe of three.js lights everything in its scene. The look-up is linear between eight probes;
// probes inside of solids are left out.
import * as THREE from 'three';

const stateBlack = 3; // in a solid, without light
const bandSizes = { sh9: 9, sh4: 4 };

/// Reads a half float of the texture: slab, probe, channel.
function readerOf({ size, scale }, texture) {
  const { data } = texture.image;
  const count = size[0] * size[1] * size[2];
  return (slab, probe, channel) => scale * THREE.DataUtils.fromHalfFloat(data[4 * (slab * count + probe) + channel]);
}

/// The two probes on both sides of a place along an axis, and the weight of the second.
function between(info, axis, at) {
  const last = info.size[axis] - 1;
  const place = THREE.MathUtils.clamp((at - info.origin[axis]) / info.spacing[axis], 0, last);
  const first = Math.min(Math.floor(place), Math.max(last - 1, 0));
  return { first, second: Math.min(first + 1, last), weight: place - first };
}

/// Adds the coefficients of the probes around a point, [27], into `sum`.
function gather(info, read, point, sum) {
  const axes = [0, 1, 2].map((axis) => between(info, axis, point.getComponent(axis)));
  const coefficients = 3 * bandSizes[info.basis];
  const slabs = Math.ceil(coefficients / 4);
  let total = 0;
  sum.fill(0);
  for (let corner = 0; corner < 8; corner++) {
    const [x, y, z] = axes.map((a, k) => (corner & (1 << k) ? a.second : a.first));
    const weight = axes.reduce((w, a, k) => w * (corner & (1 << k) ? a.weight : 1 - a.weight), 1);
    const probe = x + info.size[0] * (y + info.size[1] * z);
    if (weight === 0 || Math.round(read(slabs, probe, 3) / info.scale) === stateBlack) continue;
    for (let i = 0; i < coefficients; i++) sum[i] += weight * read(i >> 2, probe, i & 3);
    total += weight;
  }
  if (total > 0) for (let i = 0; i < coefficients; i++) sum[i] /= total;
}

/// Lets the pointer drag the sphere in the plane that faces the camera.
function addDragging({ scene, sphere }, view, canvas, moved) {
  const ray = new THREE.Raycaster();
  const plane = new THREE.Plane();
  let offset = null;
  const aim = (event) => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const x = (2 * (event.clientX - left)) / width - 1;
    ray.setFromCamera(new THREE.Vector2(x, 1 - (2 * (event.clientY - top)) / height), view.camera);
  };
  // On the document and before the controls of the camera, which must not turn it meanwhile.
  document.addEventListener('pointerdown', (event) => {
    if (event.target !== canvas || !scene.visible) return;
    aim(event);
    const hit = ray.intersectObject(sphere)[0];
    if (hit === undefined) return;
    plane.setFromNormalAndCoplanarPoint(view.camera.getWorldDirection(new THREE.Vector3()), hit.point);
    offset = sphere.position.clone().sub(hit.point);
    view.controls.enabled = false;
  }, true);
  document.addEventListener('pointermove', (event) => {
    if (offset === null) return;
    aim(event);
    const point = ray.ray.intersectPlane(plane, new THREE.Vector3());
    if (point !== null) moved(point.add(offset));
  });
  for (const end of ['pointerup', 'pointercancel']) {
    document.addEventListener(end, () => {
      if (offset !== null) view.controls.enabled = true;
      offset = null;
    });
  }
}

/// A place that the camera sees: a third of the way to its target, or where this way enters the grid.
/// @param radius distance from the side of the grid
function startOf({ camera, controls }, grid, radius) {
  const point = camera.position.clone().lerp(controls.target, 1 / 3);
  const ahead = new THREE.Ray(point, controls.target.clone().sub(point).normalize());
  const entry = grid.containsPoint(point) ? null : ahead.intersectBox(grid, new THREE.Vector3());
  return entry?.addScaledVector(ahead.direction, radius) ?? point;
}

/// @param given { info, texture }: the JSON of the probes, and their light
/// @param changed called when the sphere has moved
/// @returns { scene, bounds, position, start, place(point) }: place keeps the sphere in the grid
export function makeSphere({ info, texture }, view, canvas, changed) {
  const low = new THREE.Vector3().fromArray(info.origin);
  const high = low.clone().add(new THREE.Vector3(...info.size.map((n, k) => (n - 1) * info.spacing[k])));
  const largest = Math.max(high.distanceTo(low) / 25, Math.min(...info.spacing) / 4);
  const start = startOf(view, new THREE.Box3(low, high), largest);
  const radius = Math.min(largest, start.distanceTo(view.camera.position) / 10); // must not hide the scene
  const sphere = new THREE.Mesh(new THREE.SphereGeometry(radius, 48, 24), new THREE.MeshLambertMaterial());
  const light = new THREE.LightProbe();
  const scene = new THREE.Scene();
  scene.add(sphere, light);
  const read = readerOf(info, texture);
  const sum = new Float32Array(27);
  const place = (point) => {
    sphere.position.copy(point).clamp(low, high);
    sphere.updateMatrixWorld();
    gather(info, read, sphere.position, sum);
    light.sh.fromArray(sum);
    changed();
  };
  addDragging({ scene, sphere }, view, canvas, place);
  return { scene, bounds: { low, high }, position: sphere.position, start, place };
}
