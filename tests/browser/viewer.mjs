// SPDX-License-Identifier: MIT
// A browser without a screen that shows a file and hands out the linear radiance of its pixels.
// Nothing goes over a network: every request is answered from the disk or refused.
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { chromium } from 'playwright-core';

const here = path.dirname(new URL(import.meta.url).pathname);
const origin = 'http://viewer.invalid';
const types = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json' };

/// Opens a browser; `show(kind, file, side, camera)` gives { pixels, seconds, faults }: pixels
/// [side][side][4] with rows from the top, seen by the file's first camera, or where it has none by
/// `camera`: { position, target, up, fov in radians }. kind: 'three' (Object JSON), 'babylon', 'glb';
/// 'blend ao', 'blend light', 'plain ao': the occlusion map of a .glb alone; 'probes PACKAGE': a module
/// of probes in a release of three.js, on a sphere that the camera's `sphere` describes.
export async function openViewer() {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
    args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  return { show: (...given) => show(browser, ...given), close: () => browser.close() };
}

/// Where a path of the page lies: /packages are ours, /scene is the folder of the file.
function place(url, folder) {
  const name = decodeURIComponent(new URL(url).pathname);
  if (name.startsWith('/scene/')) return path.join(folder, name.slice('/scene/'.length));
  if (name.startsWith('/web/')) return path.join(here, '../..', name);
  if (name.startsWith('/packages/')) return path.join(here, 'node_modules', name.slice('/packages/'.length));
  return path.join(here, name);
}

function address(kind) {
  const [first, three] = kind.split(' ');
  if (first === 'probes') return `probes.html?${three}`;
  return first === 'babylon' ? 'babylon.html' : 'three.html';
}

async function answer(route, folder, refused) {
  const url = route.request().url();
  try {
    if (!url.startsWith(`${origin}/`)) throw new Error('another host');
    const file = place(url, folder);
    await route.fulfill({
      body: await readFile(file),
      contentType: types[path.extname(file)] ?? 'application/octet-stream',
    });
  } catch (error) {
    refused.push(`${url}: ${error.message}`);
    await route.abort();
  }
}

async function show(browser, kind, file, side, camera) {
  const page = await browser.newPage({ viewport: { width: side, height: side } });
  const faults = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  page.on('console', (message) => {
    // A driver in software says that reading back is slow; browsers ask for an icon.
    if (message.type() === 'error' || (message.type() === 'warning' && !/GL Driver Message/.test(message.text()))) {
      faults.push(message.text());
    }
  });
  await page.route(() => true, (route) => answer(route, path.dirname(path.resolve(file)), faults));
  try {
    await page.goto(`${origin}/${address(kind)}`);
    await page.waitForFunction('window.show !== undefined', null, { timeout: 60000 });
    const result = await page.evaluate(([...given]) => window.show(...given), [
      kind,
      '/scene/',
      path.basename(file),
      side,
      camera,
    ]);
    return { pixels: Float32Array.from(result.pixels), seconds: result.seconds, faults };
  } catch (error) {
    throw new Error(`${file}: ${error.message}\n${faults.join('\n')}`);
  } finally {
    await page.close();
  }
}
