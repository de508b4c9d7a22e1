// SPDX-License-Identifier: MIT
// node run.mjs LIST: validates every "BEFORE<tab>AFTER" line of the file LIST.
import { readFile } from 'node:fs/promises';
import { newErrors } from './validate.mjs';

const lines = (await readFile(process.argv[2], 'utf8')).split('\n').filter((line) => line !== '');
let failed = 0;
for (const line of lines) {
  const [before, after] = line.split('\t');
  const found = await newErrors(before, after);
  for (const issue of found.slice(0, 10)) {
    console.log(`${after}: ${issue.code} ${issue.pointer ?? ''}: ${issue.message}`);
  }
  failed += found.length > 0 ? 1 : 0;
}
console.log(`${lines.length - failed} of ${lines.length} written files have no new error`);
process.exit(failed > 0 || lines.length === 0 ? 1 : 0);
