// SPDX-License-Identifier: MIT
// The camera: the first one of the file, or the one that the command chose; orbit by mouse, touch and
// keys.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

function boundsOf(root) {
  const box = new THREE.Box3().setFromObject(root);
  return box.isEmpty() ? new THREE.Box3(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1)) : box;
}

/// The camera that alpenglow render chooses for a file without one.
/// @param given { position, target, fov }: m, and degrees
function automatic({ position, target, fov }) {
  const camera = new THREE.PerspectiveCamera(fov, 1, 0.01, 1000);
  camera.position.fromArray(position);
  camera.lookAt(new THREE.Vector3().fromArray(target));
  return camera;
}

function fromFile(gltf) {
  let found = null;
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.traverse((object) => {
    found ??= object.isPerspectiveCamera ? object : null;
  });
  if (found === null) return null;
  const camera = new THREE.PerspectiveCamera(found.fov, 1, found.near, found.far);
  found.matrixWorld.decompose(camera.position, camera.quaternion, new THREE.Vector3());
  return camera;
}

/// The point ahead of the camera, at the distance of the middle of the scene.
function targetOf(camera, box) {
  const ahead = camera.getWorldDirection(new THREE.Vector3());
  const middle = box.getCenter(new THREE.Vector3()).sub(camera.position);
  const size = box.getSize(new THREE.Vector3()).length() || 1;
  return camera.position.clone().addScaledVector(ahead, Math.max(middle.dot(ahead), size / 20));
}

/// Fits the camera to a picture. One higher than wide shows as much from left to right as a square.
/// @param fov of a square picture, degrees
function fit(camera, fov, width, height) {
  camera.aspect = width / height;
  const slope = Math.tan(THREE.MathUtils.degToRad(fov / 2)) / Math.min(camera.aspect, 1);
  camera.fov = THREE.MathUtils.radToDeg(2 * Math.atan(slope));
  camera.updateProjectionMatrix();
}

/// @param given the camera for a file without one: { position, target, fov }
/// @returns { camera, controls, fit(width, height), reset, turn, dolly }
export function makeCamera(gltf, given, canvas) {
  const box = boundsOf(gltf.scene);
  const size = box.getSize(new THREE.Vector3()).length() || 1;
  const camera = fromFile(gltf) ?? automatic(given);
  camera.near = Math.max(camera.near, size * 1e-4);
  camera.far = Math.max(size, camera.position.distanceTo(box.getCenter(new THREE.Vector3()))) * 10;
  const { fov } = camera;
  const target = targetOf(camera, box);
  const start = { position: camera.position.clone(), quaternion: camera.quaternion.clone() };
  const controls = new OrbitControls(camera, canvas); // turns the camera
  controls.maxDistance = camera.far / 3;
  const reset = () => {
    controls.target.copy(target);
    camera.position.copy(start.position);
    controls.update();
    camera.quaternion.copy(start.quaternion);
  };
  reset();
  return { camera, controls, fit: (width, height) => fit(camera, fov, width, height), reset, turn: (x, y) => turn(camera, controls, x, y), dolly: (f) => dolly(camera, controls, f) };
}

function turn(camera, controls, x, y) {
  const offset = camera.position.clone().sub(controls.target);
  const place = new THREE.Spherical().setFromVector3(offset);
  place.theta += x;
  place.phi = THREE.MathUtils.clamp(place.phi + y, 0.01, Math.PI - 0.01);
  camera.position.copy(controls.target).add(new THREE.Vector3().setFromSpherical(place));
  controls.update();
}

function dolly(camera, controls, factor) {
  camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
  controls.update();
}
