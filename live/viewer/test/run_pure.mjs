// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// npm test: bundles every test/*.test.ts and runs it in node. Nothing here needs a browser.

import {spawnSync} from 'node:child_process';
import {mkdir, readdir, rm} from 'node:fs/promises';
import {fileURLToPath} from 'node:url';
import {skipWithoutPackages} from './installed.mjs';

skipWithoutPackages();
const {default: esbuild} = await import('esbuild');

const here = fileURLToPath(new URL('.', import.meta.url));
const out = `${here}../dist-test`;
const tests = (await readdir(here)).filter((name) => name.endsWith('.test.ts'));
if (tests.length === 0) throw new Error('there is nothing to test');
await rm(out, {recursive: true, force: true});
await mkdir(out, {recursive: true});
await esbuild.build({entryPoints: tests.map((name) => here + name), outdir: out, bundle: true,
  platform: 'node', format: 'esm', target: 'node20', outExtension: {'.js': '.mjs'},
  logLevel: 'warning'});
const {status} = spawnSync(process.execPath,
  ['--test', ...tests.map((name) => `${out}/${name.replace(/ts$/, 'mjs')}`)],
  {stdio: 'inherit'});
process.exit(status ?? 1);
