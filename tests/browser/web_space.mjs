// SPDX-License-Identifier: MIT
// Light in space on pages of alpenglow web: the sphere that probes light, and slices of volumes, beside
// alpenglow sample.
import { execFileSync } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { alpenglow, check, difference, exposure, folder, label, open, ready, seen, shoot, side, toggle } from './web_pages.mjs';

/// The place at which the camera of the box, looking along +z, sees a point; and the normal that faces it.
const eye = [0.278, 0.273, -0.8];
const focal = side / 2 / Math.tan(0.686047912 / 2);
function seenAt(point) {
  const [x, y, z] = point.map((p, k) => p - eye[k]);
  const length = Math.hypot(x, y, z);
  return { pixel: [side / 2 - (focal * x) / z, side / 2 - (focal * y) / z].map(Math.floor), normal: [-x / length, -y / length, -z / length] };
}

/// The value that the page should show of a white surface: the film curve, in eight bits of sRGB.
function displayed(irradiance) {
  const film = 1 - Math.exp((-(2 ** exposure) * irradiance) / Math.PI);
  return 255 * (film <= 0.0031308 ? 12.92 * film : 1.055 * film ** (1 / 2.4) - 0.055);
}

function sample(point, normal) {
  const words = ['sample', 'builtin:cornell', '--with', 'probes', '--probes', path.join(folder, 'cornell.probes.json'), '--at', '-', '-q'];
  const printed = execFileSync(alpenglow, words, { encoding: 'utf8', input: `${[...point, ...normal].join()}\n` });
  return printed.trim().split('\n').at(-1).split(',').slice(6, 9).map(Number);
}

async function pixelOf(page, [x, y]) {
  const one = (await shoot(page)).toString('base64');
  return page.evaluate(async ([text, u, v]) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))]));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    return [...context.getImageData(u, v, 1, 1).data];
  }, [one, x, y]);
}

/// The sphere at two probes, where every look-up is the same, and dragged.
export async function checkProbes() {
  const page = await open('probes.html');
  await ready(page);
  await page.fill('#exposure', String(exposure));
  const { origin, spacing } = JSON.parse(await readFile(path.join(folder, 'cornell.probes.json'), 'utf8'));
  const start = await Promise.all(['x', 'y', 'z'].map((axis) => page.inputValue(`#sphere-${axis}`)));
  const entry = [eye[0], eye[1], origin[2] + Math.max(...spacing) / 4]; // the camera looks along z; a radius inside
  const apart = Math.max(...entry.map((e, k) => Math.abs(e - start[k])));
  check('sphere at first', apart < 0.003, `${start}, on the camera's axis at ${entry}`);
  for (const [k, axis] of ['x', 'y', 'z'].entries()) await page.fill(`#sphere-${axis}`, String(origin[k] + spacing[k]));
  for (const index of [1, 2]) {
    await page.focus('#sphere-x');
    if (index === 2) await page.keyboard.press('End');
    const point = origin.map((o, k) => o + (k === 0 ? index : 1) * spacing[k]);
    const { pixel, normal } = seenAt(point);
    const wanted = sample(point, normal).map(displayed);
    const got = await pixelOf(page, pixel);
    const worst = Math.max(...wanted.map((w, k) => Math.abs(w - got[k])));
    check(`sphere at probe ${index}`, worst <= 2, `${got.slice(0, 3)}, sample ${wanted.map((w) => w.toFixed(1))}`);
  }
  const before = await page.inputValue('#sphere-y');
  const { pixel } = seenAt(origin.map((o, k) => o + (k === 0 ? 2 : 1) * spacing[k]));
  await page.evaluate(() => document.querySelector('#controls').removeAttribute('open')); // it lies over the picture
  await page.mouse.move(...pixel);
  await page.mouse.down();
  await page.mouse.move(pixel[0], pixel[1] - 40, { steps: 4 });
  await page.mouse.up();
  const moved = (await page.inputValue('#sphere-y')) - before;
  const expected = (40 * (origin[2] + spacing[2] - eye[2] - 0.05)) / focal;
  check('sphere dragged', Math.abs(moved - expected) < 0.02, `by ${moved.toFixed(3)} m, ${expected.toFixed(3)} m in the picture`);
  await page.context().close();
}

/// Fluence of a cell, by the irradiance that alpenglow sample finds on both sides of a surface there:
/// a surface reads the cell half a side above itself. 4 E: the mean of E over all normals is Φ / 4.
function sampleFluence(centre, cell) {
  const points = [1, -1].map((sign) => [...centre.map((c, k) => c - (k === 1 ? (sign * cell) / 2 : 0)), 0, sign, 0].join());
  const words = ['sample', 'builtin:cornell', '--with', 'lpv', '--grid', '16', '--at', '-', '-q'];
  const printed = execFileSync(alpenglow, words, { encoding: 'utf8', input: `${points.join('\n')}\n` });
  const [up, down] = printed.trim().split('\n').slice(-2).map((line) => line.split(',').slice(6, 9).map(Number));
  return { fluence: up.map((e, k) => 2 * (e + down[k])), isCut: [...up, ...down].some((e) => e <= 0) };
}

/// A slice that was clicked on: its cells beside the file, and beside alpenglow sample.
export async function checkSlices() {
  const page = await open('slices.html');
  await ready(page);
  await page.fill('#exposure', String(exposure));
  const before = await shoot(page);
  check('slice off', await page.isHidden('#slice'), 'its controls are hidden');
  await toggle(page, 'slices');
  await page.focus('#slice-axis');
  await page.keyboard.type('z');
  await page.focus('#slice-place');
  await page.keyboard.press('Home');
  for (let i = 0; i < 3; i++) await page.keyboard.press('ArrowRight');
  const change = await difference(page, await shoot(page), before);
  check('slice', change > seen, `changes the picture by ${change.toFixed(1)}/255`);
  const [grid] = JSON.parse(await readFile(path.join(folder, 'cornell.lpv.json'), 'utf8')).grids;
  const text = await page.textContent('#slice-value');
  const layer = Math.round(-grid.corner[2] / grid.cell) + 3; // the scene begins at z = 0, with a cell
  const place = grid.corner[2] + (layer + 0.5) * grid.cell;
  check('slice place', Math.abs(parseFloat(text) - place) < 1e-3, `${text}, layer ${layer} at ${place.toFixed(4)} m`);
  await page.locator('#controls > summary').click();
  for (const [x, y] of [[4, 11], [8, 11], [12, 7]]) {
    const cell = [x, y, layer];
    const centre = cell.map((c, k) => grid.corner[k] + (c + 0.5) * grid.cell);
    const first = 3 * (x + 16 * (y + 16 * layer));
    const written = grid.fluence.slice(first, first + 3);
    const { fluence, isCut } = sampleFluence(centre, grid.cell);
    const wanted = fluence.map((f) => displayed(f / 4)); // radiance Φ / 4π is that of E = Φ / 4
    const got = await pixelOf(page, seenAt(centre).pixel);
    const worst = Math.max(...wanted.map((w, k) => Math.abs(w - got[k])));
    const apart = Math.max(...written.map((w, k) => Math.abs(w / fluence[k] - 1)));
    check(`slice at ${cell}`, !isCut && worst <= 1.5 && apart < 1e-3, `${got.slice(0, 3)}, sample ${wanted.map((w) => w.toFixed(1))}; file within ${apart.toExponential(1)}`);
  }
  await page.locator('#controls > summary').click();
  await toggle(page, 'light');
  const dark = await shoot(page);
  await toggle(page, 'slices');
  check('slice without light', (await difference(page, await shoot(page), dark)) < 0.01, 'is not drawn');
  await page.context().close();
}

/// A volume of 10,000 times the light has an exposure of its own, which the panel states.
export async function checkSunSlice() {
  const page = await open('sun.html');
  await ready(page);
  await page.fill('#exposure', String(exposure));
  await toggle(page, 'slices');
  const text = await page.textContent('#slice-value');
  const [, shift] = /, shown ([0-9.]+) EV darker than the page$/.exec(text) ?? [];
  const [grid] = JSON.parse(await readFile(path.join(folder, 'sun.lpv.json'), 'utf8')).grids;
  const layer = Math.round((parseFloat(text) - grid.corner[2]) / grid.cell - 0.5);
  const cell = [4, 11, layer];
  const first = 3 * (cell[0] + 16 * (cell[1] + 16 * layer));
  const wanted = grid.fluence.slice(first, first + 3).map((f) => displayed((2 ** -shift * f) / 4));
  await page.locator('#controls > summary').click();
  const got = await pixelOf(page, seenAt(cell.map((c, k) => grid.corner[k] + (c + 0.5) * grid.cell)).pixel);
  const worst = Math.max(...wanted.map((w, k) => Math.abs(w - got[k])));
  check('slice of a sun', worst <= 2 && Math.max(...wanted) < 250, `${got.slice(0, 3)}, ${wanted.map((w) => w.toFixed(1))} wanted; ${text}`);
  await page.context().close();
}

/// Several grids: one is chosen, and its slices have its own cells.
export async function checkGrids() {
  const page = await open('grids.html', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true });
  await ready(page);
  await label(page, 'slices').tap();
  const { grids } = JSON.parse(await readFile(path.join(folder, 'grids.lpv.json'), 'utf8'));
  const labels = await page.locator('#slice-grid option').allTextContents();
  check('grids', labels.length === 2 && labels[1].includes(String(Number(grids[1].cell.toPrecision(3)))), labels.join(', '));
  const before = await shoot(page);
  await page.selectOption('#slice-grid', '1');
  const change = await difference(page, await shoot(page), before);
  check('first axis', (await page.inputValue('#slice-axis')) === '2', 'z, along which the camera looks');
  const first = Math.round(-grids[1].corner[2] / grids[1].cell); // the scene reaches from 0 to 0.559 m, both sides of cells
  const last = Math.round((0.5592 - grids[1].corner[2]) / grids[1].cell) - 1;
  const place = grids[1].corner[2] + (Math.round((first + last) / 2) + 0.5) * grids[1].cell;
  const text = await page.textContent('#slice-value');
  check('coarse grid', change > 0 && Math.abs(parseFloat(text) - place) < 1e-3, `${text}; changes the picture by ${change.toFixed(1)}/255`);
  const wide = await page.evaluate(() => document.getElementById('panel').scrollWidth > innerWidth);
  check('grids, phone', !wide, 'the panel fits');
  await page.context().close();
}

/// Pictures of a page with its sphere alone, and with a slice too.
async function shootSpace(name) {
  const page = await open(name);
  await ready(page);
  await page.fill('#exposure', String(exposure));
  const sphere = await shoot(page);
  await toggle(page, 'slices');
  await page.focus('#slice-place');
  await page.keyboard.press('Home');
  for (let i = 0; i < 3; i++) await page.keyboard.press('ArrowRight');
  const slice = await shoot(page);
  return { page, sphere, slice, place: parseFloat(await page.textContent('#slice-value')) };
}

/// A scene 524 km away looks like the same scene at the origin: its sphere, its slice, and their places.
export async function checkFar() {
  const near = await shootSpace('near.html');
  const far = await shootSpace('far.html');
  for (const key of ['sphere', 'slice']) {
    const apart = await difference(near.page, far[key], near[key]);
    check(`far ${key}`, apart < 0.1, `differs from the near one by ${apart.toFixed(3)}/255`);
  }
  check('far place', Math.abs(far.place - near.place - 524288) < 2e-3, `${far.place} m, near ${near.place} m`);
  await near.page.context().close();
  await far.page.context().close();
}
