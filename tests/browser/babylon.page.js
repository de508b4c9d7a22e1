// SPDX-License-Identifier: MIT
// In the browser: a .babylon file through the engine's own loader, into a picture of floats.
/* global BABYLON */

/// Rows of the picture come from the bottom.
function flip(pixels, side) {
  const rows = [];
  for (let y = side - 1; y >= 0; y--) rows.push(...pixels.subarray(4 * side * y, 4 * side * (y + 1)));
  return rows;
}

window.show = async (kind, folder, file, side) => {
  const start = performance.now();
  const canvas = document.getElementById('canvas');
  canvas.width = canvas.height = side;
  const engine = new BABYLON.Engine(canvas, false);
  const scene = await BABYLON.SceneLoader.LoadAsync(folder, file, engine);
  // Linear light, before tone mapping and sRGB.
  scene.imageProcessingConfiguration.applyByPostProcess = true;
  const target = new BABYLON.RenderTargetTexture('picture', side, scene, {
    type: BABYLON.Constants.TEXTURETYPE_FLOAT,
    generateMipMaps: false,
  });
  target.renderList = scene.meshes;
  target.activeCamera = scene.activeCamera;
  target.clearColor = new BABYLON.Color4(0, 0, 0, 1);
  scene.customRenderTargets.push(target);
  await scene.whenReadyAsync();
  scene.render();
  const pixels = await target.readPixels();
  return { pixels: flip(new Float32Array(pixels.buffer), side), seconds: (performance.now() - start) / 1000 };
};
