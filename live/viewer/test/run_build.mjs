// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Builds the page and the reports as `npm run build` does, if node and its packages are
// installed. Then checks the output: all files exist, and none loads from other servers or
// runs text as code.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {pageFolder, reportFolder, skipWithoutPackages} from './installed.mjs';

skipWithoutPackages();
await import('../build.mjs');
const read = (name) => readFileSync(pageFolder + name, 'utf8');
const [html, script, style] = ['index.html', 'page.js', 'page.css'].map(read);
assert.match(read('icon.svg'), /^<svg/);
assert.doesNotMatch(html, /<script>|style=|\son[a-z]+=|https?:/, 'the policy forbids these');
assert.doesNotMatch(script, /\beval\(|new Function\(/);
assert.doesNotMatch(style, /url\(|@import/);
for (const kind of ['report', 'calibration', 'markers']) {
  const [shell, code, look] = ['html', 'js', 'css'].map((end) =>
    readFileSync(`${reportFolder}${kind}.${end}`, 'utf8'));
  for (const place of ['style', 'data', 'script']) assert.ok(shell.includes(`{{${place}}}`));
  // An HTML parser would end the script, or its page, there.
  assert.doesNotMatch(code, /<\/script|<!--/i);
  assert.doesNotMatch(code, /\beval\(|new Function\(/);
  assert.doesNotMatch(look, /url\(|@import|<\/style/i);
  console.log(`${kind}.js ${code.length} bytes`);
}
console.log(`page.js ${script.length} bytes, page.css ${style.length} bytes`);
