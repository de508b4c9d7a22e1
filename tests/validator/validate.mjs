// SPDX-License-Identifier: MIT
// node validate.mjs BEFORE AFTER: what the Khronos validator calls an error in AFTER and did not
// in BEFORE. External files are resolved. Exit status: 0 nothing new, 1 something, 2 wrong usage.
import { readFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { pathToFileURL } from 'node:url';

/** Messages of severity error, each { code, message, pointer }. */
export async function errorsOf(file) {
  const { default: validator } = await import('gltf-validator');
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: file,
    maxIssues: 0, // all
    externalResourceFunction: async (uri) =>
      new Uint8Array(await readFile(join(dirname(file), decodeURIComponent(uri)))),
  });
  return report.issues.messages.filter((issue) => issue.severity === 0);
}

/** A fault that was there before is no new one where it is copied: numbers in it may differ. */
const faultOf = (issue) => issue.code + ' ' + issue.message.replace(/[-+\d.eE]+/g, '#');

export async function newErrors(before, after) {
  const known = new Set((await errorsOf(before)).map(faultOf));
  return (await errorsOf(after)).filter((issue) => !known.has(faultOf(issue)));
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  if (process.argv.length !== 4) {
    console.error('usage: node validate.mjs BEFORE AFTER');
    process.exit(2);
  }
  const found = await newErrors(process.argv[2], process.argv[3]);
  for (const issue of found) {
    console.log(`${issue.code} ${issue.pointer ?? ''}: ${issue.message}`);
  }
  process.exit(found.length > 0 ? 1 : 0);
}
