// SPDX-License-Identifier: MIT
// The maps of the scene and their switches. Materials become Lambert's, whose picture is exactly
// emission + albedo / π × light map: there is no light that a gloss could reflect.
import * as THREE from 'three';

const copied = ['name', 'color', 'map', 'aoMap', 'aoMapIntensity', 'lightMap', 'lightMapIntensity', 'emissive', 'emissiveIntensity', 'emissiveMap', 'alphaMap', 'alphaTest', 'opacity', 'transparent', 'depthWrite', 'side', 'vertexColors', 'userData'];

/// Coarser levels of an atlas mix its charts, and draw dark lines along their borders. Maps of an atlas
/// have coordinates of their own.
function readFinestLevel(texture) {
  if (!texture || texture.channel === 0) return;
  texture.minFilter = THREE.LinearFilter;
  texture.generateMipmaps = false;
}

function lambertOf(material) {
  const result = new THREE.MeshLambertMaterial();
  for (const key of copied) {
    if (material[key] !== undefined && material[key] !== null) result[key] = material[key];
  }
  // Unlit materials show their colour as it is.
  if (material.isMeshBasicMaterial) {
    result.emissive = material.color.clone();
    result.emissiveMap = material.map;
    result.color = new THREE.Color(0);
    result.map = null;
  }
  for (const key of ['aoMap', 'lightMap', 'emissiveMap']) readFinestLevel(result[key]);
  return result;
}

/// Replaces all materials below `root`. @returns them
export function replaceMaterials(root) {
  const made = new Map();
  const replace = (material) => {
    if (!made.has(material)) made.set(material, lambertOf(material));
    return made.get(material);
  };
  root.traverse((object) => {
    if (!object.isMesh) return;
    object.material = Array.isArray(object.material) ? object.material.map(replace) : replace(object.material);
  });
  return [...made.values()];
}

/// The form of the light: 'map', 'radiance' (a map that shows it with colours), 'emission' (in place of
/// the colours) or null.
function formOf(materials, bake) {
  if (materials.some((m) => m.lightMap !== null)) return 'map';
  if (materials.some((m) => m.emissiveMap?.userData.isRadiance)) return 'radiance';
  return bake?.light?.as === 'emissive' ? 'emission' : null;
}

/// Lists the maps that the materials hold.
export function findMaps(materials, bake) {
  return {
    occlusion: materials.some((m) => m.aoMap !== null),
    light: formOf(materials, bake),
    textures: materials.some((m) => m.map !== null || m.vertexColors || m.color.getHex() !== 0xffffff),
  };
}

/// Switches the maps: { occlusion, light, colours }, each true or false.
export function makeSwitch(materials, found) {
  const first = materials.map((m) => ({ ...m, color: m.color.clone(), emissive: m.emissive.clone() }));
  const white = new THREE.Color(1, 1, 1);
  return (state) => {
    const lit = state.light && found.light !== null;
    materials.forEach((m, i) => {
      const was = first[i];
      const colours = state.colours && (lit || found.light !== 'emission');
      const keepsBlack = lit && found.light === 'emission';
      m.aoMap = state.occlusion ? was.aoMap : null;
      m.lightMap = lit ? was.lightMap : null;
      m.color.copy(colours || keepsBlack ? was.color : white);
      m.map = colours || keepsBlack ? was.map : null;
      m.vertexColors = (colours || keepsBlack) && was.vertexColors;
      m.emissive.copy(lit || found.light === null ? was.emissive : new THREE.Color(0));
      m.needsUpdate = true;
    });
  };
}
