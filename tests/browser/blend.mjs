// SPDX-License-Identifier: MIT
// node blend.mjs FOLDER: shows what write_blend left there through web/three-blend.js, as an
// occlusion map and as a light map, and holds every pixel to what the library reads there.
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { openViewer } from './viewer.mjs';

/// The map has eight bits: half a step. A texture unit's weights have eight bits too: 1/256 of how
/// far the texels lie apart in either direction, of which at most half a step is seen here. Besides
/// what the value changes over the 1/16 pixel to which vertices are snapped.
const allowed = (pixel) => 1 / 255 + pixel.drift;

const folder = process.argv[2];
const viewer = await openViewer();
let failed = false;
// Of a mesh with four sets of its own the plain viewer cannot show the fifth.
for (const [name, kind] of [
  ['blend', 'blend ao'],
  ['blend', 'blend light'],
  ['blend', 'blend earlier'],
  ['blend', 'plain ao'],
  ['full', 'blend ao'],
  ['full', 'blend light'],
]) {
  const expected = JSON.parse(await readFile(path.join(folder, `${name}.json`), 'utf8'));
  failed ||= expected.pixels.length < 5000;
  const shown = await viewer.show(kind, path.join(folder, `${name}.glb`), expected.side, expected.camera);
  let sum = 0;
  let worst = 0;
  const off = [];
  for (const pixel of expected.pixels) {
    const got = shown.pixels[4 * (pixel.y * expected.side + pixel.x)];
    const error = Math.abs(got - pixel.value);
    sum += error;
    worst = Math.max(worst, error / allowed(pixel));
    if (!(error <= allowed(pixel))) off.push(`pixel ${pixel.x}, ${pixel.y}: ${got}, not ${pixel.value} ± ${allowed(pixel)}`);
  }
  console.log(
    `${name}, ${kind}: ${expected.pixels.length} pixels, mean error ${(sum / expected.pixels.length).toExponential(2)}, ` +
      `largest ${worst.toFixed(2)} of what is allowed, ${off.length} beyond it`,
  );
  for (const fault of shown.faults) console.log(`  ${fault}`);
  const blended = kind !== 'plain ao';
  if (blended) for (const fault of off.slice(0, 8)) console.log(`  ${fault}`);
  // One set alone shows other values: else this test would see nothing.
  failed ||= shown.faults.length > 0 || (blended ? off.length > 0 : off.length < expected.pixels.length / 100);
}
const glsl = await readFile(path.join(path.dirname(new URL(import.meta.url).pathname), '../../web/blend.glsl'), 'utf8');
const { blendFunction } = await import('../../web/three-blend.js');
const bare = (text) => text.replace(/\s*\/\/[^\n]*/g, '').trim();
if (bare(glsl) !== bare(blendFunction)) {
  console.log('web/blend.glsl and the function in web/three-blend.js differ');
  failed = true;
}
await viewer.close();
process.exit(failed ? 1 : 0);
