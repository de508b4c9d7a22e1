// SPDX-License-Identifier: MIT
// node probes.mjs FOLDER: shows what write_grid left there in two releases of three.js, whose boxes
// differ by half a cell, and holds every pixel of a sphere to what the library computes there.
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { openViewer } from './viewer.mjs';

const allowed = 2 / 255; // the brightest pixels are near 1
const folder = process.argv[2];
const viewer = await openViewer();
let failed = false;
for (const name of ['grid', 'thin']) {
  const expected = JSON.parse(await readFile(path.join(folder, `${name}.json`), 'utf8'));
  for (const three of ['three-185', 'three']) {
    const shown = await viewer.show(`probes ${three}`, path.join(folder, `${name}.mjs`), expected.side, expected.camera);
    let sum = 0;
    let worst = 0;
    for (const pixel of expected.pixels) {
      for (let k = 0; k < 3; k++) {
        const error = Math.abs(shown.pixels[4 * (pixel.y * expected.side + pixel.x) + k] - pixel.value[k]);
        sum += error / 3;
        worst = Number.isNaN(error) ? NaN : Math.max(worst, error);
      }
    }
    console.log(
      `${name} in ${three}: ${expected.pixels.length} pixels, mean error ${((255 * sum) / expected.pixels.length).toFixed(3)}/255, ` +
        `largest ${(255 * worst).toFixed(3)}/255 of 2/255; a probe elsewhere by half a cell would be ${(255 * expected.half).toFixed(1)}/255 off`,
    );
    for (const fault of shown.faults) console.log(`  ${fault}`);
    // The test would see nothing where light is even.
    failed ||= !(worst <= allowed) || shown.faults.length > 0 || expected.pixels.length < 5000 || !(expected.half > 4 * allowed);
  }
}
await viewer.close();
process.exit(failed ? 1 : 0);
