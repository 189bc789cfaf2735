// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Builds the page as `npm run build` does, where that can be; then looks at what came out:
// all of it there, nothing in it that fetches from elsewhere or runs text as code.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {pageFolder, skipWithoutPackages} from './installed.mjs';

skipWithoutPackages();
await import('../build.mjs');
const read = (name) => readFileSync(pageFolder + name, 'utf8');
const [html, script, style] = ['index.html', 'page.js', 'page.css'].map(read);
assert.match(read('icon.svg'), /^<svg/);
assert.doesNotMatch(html, /<script>|style=|\son[a-z]+=|https?:/, 'the policy forbids these');
assert.doesNotMatch(script, /\beval\(|new Function\(/);
assert.doesNotMatch(style, /url\(|@import/);
console.log(`page.js ${script.length} bytes, page.css ${style.length} bytes`);
