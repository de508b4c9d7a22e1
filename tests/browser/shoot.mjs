// SPDX-License-Identifier: MIT
// node shoot.mjs PAGE.html OUT.png WIDTH HEIGHT SCALE: a picture of a page of alpenglow web, for the
// gallery. SCALE: pixels of the picture for one of the page.
import path from 'node:path';
import { chromium } from 'playwright-core';

const [file, out, width, height, deviceScaleFactor] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
  args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
const viewport = { width: Number(width), height: Number(height) };
const page = await browser.newPage({ viewport, deviceScaleFactor: Number(deviceScaleFactor) });
await page.goto(`file://${encodeURI(path.resolve(file))}`);
await page.waitForSelector('html[data-ready]', { timeout: 60000 });
await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
await page.screenshot({ path: out });
await browser.close();
