// SPDX-License-Identifier: MIT
// The scene of the page: its bytes from the elements that hold them, loaded by GLTFLoader.
import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';

function bytesOf(element) {
  const text = atob(element.textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  element.textContent = ''; // the text is larger than the bytes
  return bytes;
}

/// Blobs of the files beside the asset, by the name that the asset gives them.
function fileUrls(names) {
  const elements = document.querySelectorAll('script.file');
  return new Map(names.map((name, i) => [name, URL.createObjectURL(new Blob([bytesOf(elements[i])]))]));
}

/// Nothing is fetched that is not in the page: other addresses become an empty one.
function managerOf(urls) {
  const manager = new THREE.LoadingManager();
  manager.setURLModifier((url) => {
    if (/^(blob|data):/.test(url)) return url;
    return urls.get(url) ?? urls.get(decodeURIComponent(url)) ?? 'data:,';
  });
  return manager;
}

/// A texture of half floats or floats whose first row is v = 0. EXRLoader hands out rows from the
/// bottom; HDRLoader has them flipped by WebGL.
/// @param type of an EXR's numbers: half floats end at 65504
async function loadFloats(uri, manager, renderer, type = THREE.HalfFloatType) {
  if (/\.ktx2$/i.test(uri)) return new KTX2Loader(manager).detectSupport(renderer).loadAsync(uri);
  const isHdr = /\.hdr$/i.test(uri);
  const loader = isHdr ? new HDRLoader(manager) : new EXRLoader(manager).setDataType(type);
  const texture = await loader.loadAsync(uri);
  texture.flipY = !isHdr;
  texture.needsUpdate = true;
  return texture;
}

/// The page of the atlas that an image is, by its name: "light 2" in a .glb, scene.light.2.png beside a
/// .gltf. The first page of a file has no number.
function pageOf(name) {
  return Number(/^light (\d+)$/.exec(name)?.[1] ?? /\.light\.(\d+)\.\w+$/.exec(name)?.[1] ?? 0);
}

/// Makes surfaces without a material grey, as the library reads them; GLTFLoader makes them white. A bake
/// gives them materials, with a mark in their extras.
function readAbsentMaterials(json) {
  const grey = { pbrMetallicRoughness: { baseColorFactor: [0.5, 0.5, 0.5, 1] } };
  json.materials ??= [];
  for (const material of json.materials) if (material.extras?.alpenglow === 'no material') Object.assign(material, grey);
  const index = json.materials.push(grey) - 1;
  for (const { primitives } of json.meshes ?? []) for (const primitive of primitives) primitive.material ??= index;
}

/// Reads light maps that three.js does not read itself: MOZ_lightmap, and the file of extras.lightmap.
class LightMapPlugin {
  constructor(parser, floats) {
    this.name = 'MOZ_lightmap';
    this.parser = parser;
    this.floats = floats;
  }

  beforeRoot() {
    readAbsentMaterials(this.parser.json);
  }

  imageName(texture) {
    const { json } = this.parser;
    const image = json.images?.[json.textures[texture].source];
    return image?.name ?? image?.uri ?? '';
  }

  async extendMaterialParams(index, params) {
    const definition = this.parser.json.materials[index];
    const moz = definition.extensions?.MOZ_lightmap;
    const extra = definition.extras?.lightmap;
    const found = moz ?? extra;
    if (found === undefined || found === null) return;
    const texture =
      moz !== undefined ? await this.parser.getDependency('texture', moz.index) : await this.floats(extra.uri);
    if (!texture) return;
    const map = texture.clone();
    map.userData.page = pageOf(moz !== undefined ? this.imageName(moz.index) : extra.uri);
    map.channel = found.texCoord ?? 0;
    map.colorSpace = THREE.LinearSRGBColorSpace;
    if (moz === undefined) map.minFilter = map.magFilter = THREE.LinearFilter;
    const intensity = found.intensity ?? 1;
    if (found.units === 'radiance') {
      map.userData.isRadiance = true; // all light that leaves the surface, its emission included
      Object.assign(params, { emissive: new THREE.Color(1, 1, 1), emissiveMap: map, emissiveIntensity: intensity });
    } else {
      params.lightMap = map;
      params.lightMapIntensity = found.units === 'irradiance/pi' ? Math.PI * intensity : intensity;
    }
  }
}

/// The maps of single lights: [{ name, pages }], a texture for each page of the atlas.
async function loadLayers({ layers, pages }, renderer) {
  const elements = [...document.querySelectorAll('script.layer')];
  const uris = elements.map((element, i) => `layer${i}.exr`);
  const manager = managerOf(new Map(uris.map((uri, i) => [uri, URL.createObjectURL(new Blob([bytesOf(elements[i])]))])));
  const textures = await Promise.all(uris.map((uri) => loadFloats(uri, manager, renderer, THREE.FloatType)));
  return layers.map((name, i) => ({ name, pages: textures.slice(i * pages, (i + 1) * pages) }));
}

/// The grids of the volume: [{ cell, corner, size, fluence }].
function loadGrids(volume) {
  const elements = document.querySelectorAll('script.volume');
  return (volume ?? []).map((grid, i) => ({ ...grid, fluence: new Float32Array(bytesOf(elements[i]).buffer) }));
}

/// The probes, { info, texture }, or null.
async function loadProbes(info, renderer) {
  if (info === null) return null;
  const url = URL.createObjectURL(new Blob([bytesOf(document.querySelector('script.probes'))]));
  return { info: { scale: 1, ...info }, texture: await new KTX2Loader().detectSupport(renderer).loadAsync(url) };
}

/// @returns { gltf, name, camera, layers, probes, grids }
export async function loadScene(renderer) {
  const about = JSON.parse(document.getElementById('scene').textContent);
  const manager = managerOf(fileUrls(about.files));
  const loaded = new Map();
  const floats = (uri) => {
    if (!loaded.has(uri)) loaded.set(uri, loadFloats(uri, manager, renderer));
    return loaded.get(uri);
  };
  const loader = new GLTFLoader(manager);
  loader.setMeshoptDecoder(MeshoptDecoder);
  loader.register((parser) => new LightMapPlugin(parser, floats));
  const gltf = await loader.parseAsync(bytesOf(document.querySelector('script.asset')).buffer, '');
  const [layers, probes] = await Promise.all([loadLayers(about, renderer), loadProbes(about.probes, renderer)]);
  return { gltf, name: about.name, camera: about.camera, layers, probes, grids: loadGrids(about.volume) };
}
