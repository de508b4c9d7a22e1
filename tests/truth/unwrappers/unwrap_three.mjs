// SPDX-License-Identifier: MIT
// unwrap_three.mjs THREE IN.obj OUT.obj SIZE PADDING: the JavaScript unwrapper of three.js on one
// mesh, without a browser. THREE is the folder of the package. Prints its seconds.
import { readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [folder, input, output, size, padding] = process.argv.slice(2);
const load = (path) => import(pathToFileURL(`${folder}/${path}`).href);
const { BufferAttribute, BufferGeometry, Mesh } = await load('build/three.module.js');
const { unwrapUVs } = await load('examples/jsm/utils/unwrapUVs.js');

const positions = [], index = [];
for (const line of readFileSync(input, 'utf8').split('\n')) {
    const words = line.split(' ');
    if (words[0] === 'v') positions.push(+words[1], +words[2], +words[3]);
    if (words[0] === 'f') index.push(words[1] - 1, words[2] - 1, words[3] - 1);
}
const geometry = new BufferGeometry();
geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
geometry.setIndex(new BufferAttribute(new Uint32Array(index), 1));
const mesh = new Mesh(geometry);

// Its padding is on both sides of each chart: half of ours leaves no less between two.
const started = performance.now();
const atlas = unwrapUVs(mesh, { resolution: +size, padding: Math.ceil(padding / 2) });
const seconds = (performance.now() - started) / 1000;
if (atlas === null) {
    console.log(JSON.stringify({ seconds, refused: 'the charts do not fit the page' }));
    process.exit(0);
}
const made = mesh.geometry, uv = made.getAttribute('uv1'), at = made.getAttribute('position');
const lines = [];
for (let i = 0; i < at.count; i++) lines.push(`v ${at.getX(i)} ${at.getY(i)} ${at.getZ(i)}`);
for (let i = 0; i < uv.count; i++) lines.push(`vt ${uv.getX(i)} ${uv.getY(i)}`);
for (let i = 0; i < made.index.count; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => made.index.getX(i + k) + 1);
    lines.push(`f ${a}/${a} ${b}/${b} ${c}/${c}`);
}
writeFileSync(output, lines.join('\n') + '\n');
console.log(JSON.stringify({ seconds, excluded: atlas.warnings.excludedFaces }));
