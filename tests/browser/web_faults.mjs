// SPDX-License-Identifier: MIT
// Pages of alpenglow web that cannot show their scene, or hold files of strangers.
import { createServer } from 'node:http';
import { readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { chromium } from 'playwright-core';
import { check, folder, open, program, ready, writePage } from './web_pages.mjs';

export async function checkMessages() {
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
  const other = await open('other.html');
  await ready(other);
  const note = await other.textContent('#notes');
  check('lights of another bake', /hold light of another bake/.test(note), note);
  await other.context().close();
  const apart = await open('far_apart.html');
  await ready(apart);
  const capped = await apart.textContent('#notes');
  check('lights far apart', / differ from this one by more than 200 %\.$/.test(capped), capped);
  await apart.context().close();
}

/// A page must show one message in place of the scene and the panel.
async function checkStopped(name, page, wanted) {
  const shown = page.locator('#message', { hasText: wanted });
  await shown.waitFor({ timeout: 60000 }).catch(() => {});
  const good = (await shown.isVisible()) && (await page.isHidden('#panel'));
  check(name, good, await page.textContent('#message'));
  await page.context().close();
}

/// Failures of the browser before and after the scene is there.
export async function checkFailures() {
  const denied = await open('ao.gltf.html', {}, () => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function getContext(...words) {
      return this.id === 'view' ? null : original.apply(this, words);
    };
  }, true);
  await checkStopped('WebGL denied', denied, /^The scene could not be shown: .*Error creating WebGL context/);
  const old = await open('ao.gltf.html', {}, () => {
    HTMLScriptElement.supports = undefined;
  });
  await checkStopped('no import maps', old, /^This browser is too old/);
  const broken = await open('broken.html', {}, () => {}, true);
  await checkStopped('a broken script', broken, /^The scripts of the page could not be started/);
  const lost = await open('ao.gltf.html', {}, () => {}, true);
  await ready(lost);
  await lost.evaluate(() => document.getElementById('view').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext());
  await checkStopped('context lost', lost, /^The browser took the graphics memory/);
}

/// A scene with images of a stranger's server, and a page into which a script was smuggled that loads
/// from there: no request may reach the server.
export async function checkForeign() {
  let requests = 0;
  const server = createServer((request, response) => {
    requests += 1;
    response.setHeader('Access-Control-Allow-Origin', '*').end();
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const foreign = `http://127.0.0.1:${server.address().port}/`;
  const scene = JSON.parse(await readFile(path.join(folder, 'ao.gltf'), 'utf8'));
  for (const image of scene.images) image.uri = `${foreign}image.png`;
  await writeFile(path.join(folder, 'foreign.gltf'), JSON.stringify(scene));
  writePage('foreign.gltf');
  const page = await open('foreign.gltf.html', {}, () => {}, true);
  await ready(page);
  check('foreign image', requests === 0, `${requests} requests`);
  await page.evaluate(async (url) => {
    const image = Object.assign(new Image(), { src: `${url}image.png` });
    const script = Object.assign(document.createElement('script'), { src: `${url}script.js` });
    const frame = Object.assign(document.createElement('iframe'), { src: `${url}frame.html` });
    document.body.append(image, script, frame);
    await fetch(`${url}data.bin`).catch(() => {});
    await new Promise((done) => setTimeout(done, 500));
  }, foreign);
  check('foreign address', requests === 0, `${requests} requests`);
  await page.context().close();
  server.close();
}
