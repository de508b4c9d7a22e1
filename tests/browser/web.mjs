// SPDX-License-Identifier: MIT
// node web.mjs FOLDER ALPENGLOW: opens the pages that web.sh wrote, by file://, clicks their switches
// and compares what they show with the pictures of alpenglow render.
import { copyFile, readdir, stat } from 'node:fs/promises';
import path from 'node:path';
import { browser, check, compare, difference, exposure, faults, folder, label, open, ready, render, seen, shoot, toggle } from './web_pages.mjs';
import { checkFailures, checkForeign, checkMessages } from './web_faults.mjs';
import { checkFar, checkGrids, checkProbes, checkSlices, checkSunSlice } from './web_space.mjs';

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
  check(`${scene} note`, (await page.textContent('#notes')) === '', 'there is none');
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
  const [picture, panel] = [await page.locator('#view').boundingBox(), await page.locator('#panel').boundingBox()];
  check('phone, picture', picture.y + picture.height <= panel.y + 1 && picture.height > 300, `${picture.height} pixels high, above the panel`);
  await page.locator('#controls > summary').tap();
  check('phone, panel closed', await page.isHidden('#exposure'), 'a tap on its name closes it');
  await page.waitForFunction((height) => document.getElementById('view').height > 1.2 * height, picture.height);
  check('phone', change > seen && !wide, `a tap changes the picture by ${change.toFixed(1)}/255; too wide: ${wide}`);
  await page.context().close();
}

/// The link of a report leads to the page.
async function checkReport() {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto(`file://${path.join(folder, 'report.html')}`);
  await page.getByRole('link', { name: 'See this scene in the browser' }).click();
  const name = await ready(page).then(() => page.textContent('#name'));
  check('report', name === 'small.glb', `its link leads to ${name}`);
  await context.close();
}

for (const scene of ['emissive.glb', 'moz.glb', 'extras.glb', 'exr.gltf', 'hdr.glb', 'units.glb', 'radiance.glb', 'blend.glb', 'bare.glb']) await checkLight(scene);
await checkLayers('layers', 'layers', 1);
await checkLayers('pages', 'pages', 2);
await checkLayers('moz8', 'twin', 2);
await checkBrightLayers();
await checkSlices();
await checkSunSlice();
await checkGrids();
await checkProbes();
await checkCamera();
await checkPhone();
await checkMessages();
await checkFailures();
await checkForeign();
await checkFar();
await checkReport();
const { size } = await stat(path.join(folder, 'ao.gltf.html'));
check('size', size < 4e6, `${(size / 1e6).toFixed(1)} of 4 MB`);
await browser.close();
process.exit(faults.length > 0 ? 1 : 0);
