// SPDX-License-Identifier: MIT
// node web.mjs FOLDER ALPENGLOW: opens the pages that web.sh wrote, by file://, clicks their switches
// and compares what they show with the pictures of alpenglow render.
import { execFileSync } from 'node:child_process';
import { copyFile, readFile, readdir, stat } from 'node:fs/promises';
import path from 'node:path';
import { chromium } from 'playwright-core';

const [folder, alpenglow] = process.argv.slice(2);
const side = 320;
const exposure = 1.5;
const allowed = 1; // mean of 255: edges and eight bits; without the blend it is 1.14
const seen = 12; // least difference by which a switch must change the picture
const faults = [];

const program = { executablePath: process.env.CHROMIUM || '/usr/bin/chromium' };
const browser = await chromium.launch({
  ...program,
  args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

function check(name, good, text) {
  console.log(`${good ? 'ok' : 'FAULT'} ${name}: ${text}`);
  if (!good) faults.push(name);
}

/// A page whose console must stay silent, and which may ask for nothing but itself.
async function open(name, options = {}, before = () => {}) {
  const context = await browser.newContext({ viewport: { width: side, height: side }, ...options });
  const page = await context.newPage();
  await page.addInitScript(before);
  const address = `file://${encodeURI(path.join(folder, name))}`;
  page.on('pageerror', (error) => check(name, false, String(error)));
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !/GL Driver Message/.test(message.text())) check(name, false, message.text());
  });
  page.on('request', (request) => {
    if (request.url() !== address && !/^(blob|data):/.test(request.url())) check(name, false, `requests ${request.url()}`);
  });
  await page.goto(address);
  return page;
}

const ready = (page) => page.waitForSelector('html[data-ready]', { timeout: 60000 });

/// The picture of the canvas, without the panel over it.
async function shoot(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const style = await page.addStyleTag({ content: '#panel { visibility: hidden } #view { outline: none !important }' });
  const png = await page.screenshot();
  await style.evaluate((element) => element.remove());
  return png;
}

/// Mean difference of two pictures, of 255, over the pixels that the second covers: the rest of it is
/// grey 96.
function difference(page, a, b) {
  return page.evaluate(async (pictures) => {
    const [one, two] = await Promise.all(
      pictures.map(async (text) => {
        const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes]), { colorSpaceConversion: 'none' });
        const canvas = new OffscreenCanvas(image.width, image.height);
        const context = canvas.getContext('2d');
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, image.width, image.height);
      }),
    );
    if (one.width !== two.width || one.height !== two.height) return NaN;
    let [sum, count] = [0, 0];
    for (let i = 0; i < two.data.length; i += 4) {
      if (two.data[i] === 96 && two.data[i + 1] === 96 && two.data[i + 2] === 96) continue;
      for (let k = 0; k < 3; k++) sum += Math.abs(one.data[i + k] - two.data[i + k]) / 3;
      count += 1;
    }
    return count > 5000 ? sum / count : NaN;
  }, [a.toString('base64'), b.toString('base64')]);
}

async function render(scene, ...options) {
  const file = path.join(folder, 'render.png');
  const words = ['render', path.join(folder, scene), '-f', '-o', file, '--resolution', `${side}x${side}`, ...options];
  const printed = execFileSync(alpenglow, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
  return { png: await readFile(file), exposure: Number(/exposure +(\S+) EV/.exec(printed)?.[1]) };
}

async function compare(page, name, picture) {
  const mean = await difference(page, await shoot(page), picture);
  check(name, mean <= allowed, `${mean.toFixed(2)} of ${allowed}/255 from render`);
}

const label = (page, key) => page.locator(`#switches label:has(#switch-${key})`);
const toggle = (page, key) => label(page, key).click();

/// The page of a scene with light, its exposure, and its switches.
async function checkLight(scene) {
  const page = await open(`${scene}.html`);
  await ready(page);
  const measured = Number(await page.inputValue('#exposure'));
  const own = await render(scene, '--with', 'lightmap');
  check(`${scene} exposure`, Math.abs(measured - own.exposure) <= 0.15, `${measured} EV, render ${own.exposure}`);
  await page.fill('#exposure', String(exposure));
  const lit = await render(scene, '--with', 'lightmap', '--exposure', String(exposure));
  await compare(page, `${scene} light`, lit.png);
  const before = await shoot(page);
  await toggle(page, 'light');
  const change = await difference(page, await shoot(page), before);
  check(`${scene} light off`, change > seen, `changes the picture by ${change.toFixed(1)}/255`);
  if (['moz.glb', 'emissive.glb'].includes(scene)) await checkOcclusion(page, scene);
  await page.context().close();
}

/// With the light off: occlusion alone, on white.
async function checkOcclusion(page, scene) {
  await toggle(page, 'occlusion');
  if ((await page.locator('#switch-colours').count()) > 0) await toggle(page, 'colours');
  const picture = await render(scene, '--with', 'ao');
  // The lamp of the scene is shown by the map in both.
  await compare(page, `${scene} occlusion`, picture.png);
}

/// Replaces the light map of a scene, page by page, by that of one lamp. @returns the number of pages
async function showOneLamp(scene) {
  const lamp = (await readdir(path.join(folder, scene))).filter((name) => /^irradiance\.lamp(\.\d+)?\.exr$/.test(name));
  for (const name of lamp) {
    const own = name.replace('irradiance.lamp', `${scene}.light`);
    await copyFile(path.join(folder, scene, name), path.join(folder, own));
  }
  return lamp.length;
}

/// Two lamps, of which one is dimmed to nothing: what is left is the map of the other.
/// @param reference a scene with the same light as floats in files   @param pages least number of them
async function checkLayers(scene, reference, pages) {
  const page = await open(`${scene}.glb.html`);
  await ready(page);
  await page.fill('#exposure', String(exposure));
  const options = ['--with', 'lightmap', '--exposure', String(exposure)];
  await compare(page, scene, (await render(`${reference}.glb`, ...options)).png);
  const before = await shoot(page);
  const dimmer = page.getByLabel('lamp 0');
  await dimmer.focus();
  await page.keyboard.press('Home');
  const count = await showOneLamp(reference);
  check(`${scene} pages`, count >= pages, `${count}`);
  await compare(page, `${scene}, one dimmed`, (await render(`${reference}.glb`, ...options)).png);
  const change = await difference(page, await shoot(page), before);
  check(`${scene} dimmer`, change > seen, `changes the picture by ${change.toFixed(1)}/255`);
  await page.context().close();
}

/// Light above 65504, the end of half floats, and its exposure; dimmed and back.
async function checkBrightLayers() {
  const page = await open('bright.glb.html');
  await ready(page);
  const own = await render('bright.glb', '--with', 'lightmap');
  const measured = Number(await page.inputValue('#exposure'));
  check('bright exposure', Math.abs(measured - own.exposure) <= 0.15, `${measured} EV, render ${own.exposure}`);
  await page.fill('#exposure', '-14');
  const { png } = await render('bright.glb', '--with', 'lightmap', '--exposure', '-14');
  await compare(page, 'bright', png);
  const dimmer = page.getByLabel('lamp 1');
  await dimmer.focus();
  await page.keyboard.press('Home');
  const change = await difference(page, await shoot(page), png);
  check('bright dimmer', change > seen, `changes the picture by ${change.toFixed(1)}/255`);
  await dimmer.focus(); // shoot hides the panel
  for (let i = 0; i < 100; i++) await page.keyboard.press('ArrowRight');
  await compare(page, 'bright, back at 100 %', png);
  await page.context().close();
}

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
async function checkProbes() {
  const page = await open('probes.html');
  await ready(page);
  await page.fill('#exposure', String(exposure));
  const { origin, spacing } = JSON.parse(await readFile(path.join(folder, 'cornell.probes.json'), 'utf8'));
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
async function checkSlices() {
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
  const layer = Math.floor(-grid.corner[2] / grid.cell) + 3; // the scene begins at z = 0
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

/// Several grids: one is chosen, and its slices have its own cells.
async function checkGrids() {
  const page = await open('grids.html', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true });
  await ready(page);
  await label(page, 'slices').tap();
  const { grids } = JSON.parse(await readFile(path.join(folder, 'grids.lpv.json'), 'utf8'));
  const labels = await page.locator('#slice-grid option').allTextContents();
  check('grids', labels.length === 2 && labels[1].includes(String(Number(grids[1].cell.toPrecision(3)))), labels.join(', '));
  const before = await shoot(page);
  await page.selectOption('#slice-grid', '1');
  const change = await difference(page, await shoot(page), before);
  const first = Math.floor(-grids[1].corner[0] / grids[1].cell); // the scene reaches from 0 to 0.556 m
  const last = Math.floor((0.556 - grids[1].corner[0]) / grids[1].cell);
  const place = grids[1].corner[0] + (Math.round((first + last) / 2) + 0.5) * grids[1].cell;
  const text = await page.textContent('#slice-value');
  check('coarse grid', change > 0 && Math.abs(parseFloat(text) - place) < 1e-3, `${text}; changes the picture by ${change.toFixed(1)}/255`);
  const wide = await page.evaluate(() => document.getElementById('panel').scrollWidth > innerWidth);
  check('grids, phone', !wide, 'the panel fits');
  await page.context().close();
}

async function checkCamera() {
  const page = await open('ao.gltf.html');
  await ready(page);
  const first = await shoot(page);
  const moved = async (name) => {
    const change = await difference(page, await shoot(page), first);
    check(name, change > 3, `changes the picture by ${change.toFixed(1)}/255`);
    await page.getByRole('button', { name: 'Reset camera' }).click();
    const rest = await difference(page, await shoot(page), first);
    check(`${name}, reset`, rest < 0.01, `${rest.toFixed(3)}/255 remain`);
  };
  await page.mouse.move(20, 100);
  await page.mouse.down();
  await page.mouse.move(80, 120, { steps: 4 });
  await page.mouse.up();
  await moved('mouse');
  await page.focus('#view');
  for (let i = 0; i < 5; i++) await page.keyboard.press('ArrowLeft');
  await moved('keys');
  await page.focus('#switch-occlusion');
  await page.keyboard.press('Space');
  const change = await difference(page, await shoot(page), first);
  check('a switch by keyboard', change > 1, `changes the picture by ${change.toFixed(1)}/255`);
  await page.context().close();
}

async function checkPhone() {
  const page = await open('moz.glb.html', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true });
  await ready(page);
  const before = await shoot(page);
  await label(page, 'light').tap();
  const change = await difference(page, await shoot(page), before);
  const wide = await page.evaluate(() => [document.body, document.getElementById('panel')].some((e) => e.scrollWidth > innerWidth));
  await page.locator('#controls > summary').tap();
  check('phone, panel closed', await page.isHidden('#exposure'), 'a tap on its name closes it');
  check('phone', change > seen && !wide, `a tap changes the picture by ${change.toFixed(1)}/255; too wide: ${wide}`);
  await page.context().close();
}

async function checkMessages() {
  const blind = await open('ao.gltf.html', {}, () => {
    HTMLCanvasElement.prototype.getContext = () => null;
  });
  const text = await blind.textContent('#message');
  check('no WebGL', /has no WebGL 2/.test(text) && (await blind.isHidden('#view')), text);
  await blind.context().close();
  const without = await chromium.launch({ ...program, args: ['--disable-gpu', '--disable-3d-apis'] });
  const plain = await without.newPage();
  await plain.goto(`file://${path.join(folder, 'ao.gltf.html')}`);
  const told = plain.locator('#message', { hasText: 'has no WebGL 2' });
  await told.waitFor({ timeout: 10000 }).catch(() => {});
  check('Chromium without WebGL', (await told.isVisible()) && (await plain.isHidden('#panel')), 'says so, without a panel');
  await without.close();
  const hostile = await open('hostile.html');
  await ready(hostile);
  const name = await hostile.textContent('#name');
  check('name', name === '<img src=x onerror=alert(1)>.gltf' && (await hostile.locator('img').count()) === 0, name);
  const licence = await hostile.textContent('#licence');
  check('licence', /MIT License[^]*three\.js authors[^]*NONINFRINGEMENT/.test(licence), `${licence.length} characters`);
  await hostile.context().close();
}

for (const scene of ['emissive.glb', 'moz.glb', 'extras.glb', 'exr.gltf', 'hdr.glb', 'units.glb', 'radiance.glb', 'blend.glb']) await checkLight(scene);
await checkLayers('layers', 'layers', 1);
await checkLayers('pages', 'pages', 2);
await checkLayers('moz8', 'twin', 2);
await checkBrightLayers();
await checkSlices();
await checkGrids();
await checkProbes();
await checkCamera();
await checkPhone();
await checkMessages();
const { size } = await stat(path.join(folder, 'ao.gltf.html'));
check('size', size < 4e6, `${(size / 1e6).toFixed(1)} of 4 MB`);
await browser.close();
process.exit(faults.length > 0 ? 1 : 0);
