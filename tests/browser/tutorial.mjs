// SPDX-License-Identifier: MIT
// node tutorial.mjs FOLDER: viewer.html from a server shows the lit room: no error, middle greys,
// and warm walls.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import { chromium } from 'playwright-core';

const folder = process.argv[2];
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json' };
const server = http.createServer((request, response) => {
  const file = path.join(folder, path.normalize(decodeURI(request.url.split('?')[0])));
  if (!fs.existsSync(file)) {
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200, { 'Content-Type': TYPES[path.extname(file)] ?? 'application/octet-stream' });
  fs.createReadStream(file).pipe(response);
});
await new Promise((done) => server.listen(0, '127.0.0.1', done));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
  args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
const page = await browser.newPage({ viewport: { width: 320, height: 180 } });
const faults = [];
page.on('pageerror', (error) => faults.push(error.message));
page.on('response', (r) => r.status() >= 400 && !r.url().endsWith('.ico') && faults.push(r.url()));
await page.goto(`http://127.0.0.1:${server.address().port}/viewer.html`);
await page.waitForSelector('canvas', { timeout: 60000 });
await page.waitForTimeout(1000);
const picture = await page.screenshot(process.argv[3] ? { path: process.argv[3] } : {});
const colours = await page.evaluate(async (data) => {
  const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
  const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, image.width, image.height).data;
  const sums = [0, 0, 0];
  let dark = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    for (let k = 0; k < 3; k++) sums[k] += pixels[i + k];
    dark += pixels[i] < 4;
  }
  const count = pixels.length / 4;
  return { mean: sums.map((sum) => sum / count), dark: dark / count };
}, picture.toString('base64'));
await browser.close();
server.close();
const [red, , blue] = colours.mean;
if (red < 60 || red > 200 || red < 1.2 * blue || colours.dark > 0.05) {
  faults.push(`the picture is not the lit room: ${JSON.stringify(colours)}`);
}
console.log(faults.length > 0 ? faults.join('\n') : 'tutorial: good');
process.exit(faults.length > 0 ? 1 : 0);
