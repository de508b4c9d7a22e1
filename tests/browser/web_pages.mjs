// SPDX-License-Identifier: MIT
// Pages of alpenglow web in Chromium: opened by file://, photographed, and compared with pictures of
// alpenglow render. Arguments of the program: FOLDER ALPENGLOW.
import { execFileSync } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { chromium } from 'playwright-core';

export const [folder, alpenglow] = process.argv.slice(2);
export const side = 320;
export const exposure = 1.5;
const allowed = 1; // mean of 255: edges and eight bits; without the blend it is 1.14
export const seen = 12; // least difference by which a switch must change the picture
export const faults = [];

export const program = { executablePath: process.env.CHROMIUM || '/usr/bin/chromium' };
export const browser = await chromium.launch({
  ...program,
  args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

export function check(name, good, text) {
  console.log(`${good ? 'ok' : 'FAULT'} ${name}: ${text}`);
  if (!good) faults.push(name);
}

/// A page whose console must stay silent, and which may request nothing but itself.
/// @param before runs in the page before its scripts   @param fails faults in the console and requests are expected
export async function open(name, options = {}, before = () => {}, fails = false) {
  const context = await browser.newContext({ viewport: { width: side, height: side }, ...options });
  const page = await context.newPage();
  await page.addInitScript(before);
  const address = `file://${encodeURI(path.join(folder, name))}`;
  page.on('pageerror', (error) => fails || check(name, false, String(error)));
  page.on('console', (message) => {
    if (!fails && ['error', 'warning'].includes(message.type()) && !/GL Driver Message/.test(message.text())) check(name, false, message.text());
  });
  page.on('request', (request) => {
    if (!fails && request.url() !== address && !/^(blob|data):/.test(request.url())) check(name, false, `requests ${request.url()}`);
  });
  await page.goto(address);
  return page;
}

export const ready = (page) => page.waitForSelector('html[data-ready]', { timeout: 60000 });

/// The picture of the canvas, without the panel over it.
export async function shoot(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const style = await page.addStyleTag({ content: '#panel { visibility: hidden } #view { outline: none !important }' });
  const png = await page.screenshot();
  await style.evaluate((element) => element.remove());
  return png;
}

/// Mean difference of two pictures, of 255, over the pixels that the second covers: the rest of it is
/// grey 96.
export function difference(page, a, b) {
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

export async function render(scene, ...options) {
  const file = path.join(folder, 'render.png');
  const words = ['render', path.join(folder, scene), '-f', '-o', file, '--resolution', `${side}x${side}`, ...options];
  const printed = execFileSync(alpenglow, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
  return { png: await readFile(file), exposure: Number(/exposure +(\S+) EV/.exec(printed)?.[1]) };
}

/// Writes the page of a scene beside it, SCENE.html.
export function writePage(scene) {
  execFileSync(alpenglow, ['web', path.join(folder, scene), '-q', '-f', '-o', path.join(folder, `${scene}.html`)], { stdio: ['ignore', 'ignore', 'ignore'] });
}

export async function compare(page, name, picture) {
  const mean = await difference(page, await shoot(page), picture);
  check(name, mean <= allowed, `${mean.toFixed(2)} of ${allowed}/255 from render`);
}

export const label = (page, key) => page.locator(`#switches label:has(#switch-${key})`);
export const toggle = (page, key) => label(page, key).click();
