// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// node validate_gltf.mjs FILE...: runs Khronos' glTF validator. Prints every error and
// warning; exit 1 when there is one, 77 when the validator is not installed.
import { readFile } from 'node:fs/promises';
import { basename } from 'node:path';

let validator;
try {
  validator = (await import('gltf-validator')).default;
} catch {
  console.log('skipped: gltf-validator is missing; run `npm ci` in tests/tools');
  process.exit(77);
}

const files = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node validate_gltf.mjs FILE...');
  process.exit(2);
}
let failed = false;
for (const file of files) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: basename(file),
    maxIssues: 100,
  });
  const { numErrors, numWarnings, numInfos, messages } = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`);
  for (const message of messages) {
    // 0 error, 1 warning, 2 information, 3 hint.
    if (message.severity > 2) continue;
    console.log(`  ${message.code} at ${message.pointer ?? '?'}: ${message.message}`);
  }
  failed ||= numErrors > 0 || numWarnings > 0;
}
process.exit(failed ? 1 : 0);
