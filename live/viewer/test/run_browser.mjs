// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// npm run test:browser: user actions on the page in a headless browser. Prints "skipped:"
// if there is no browser.

import {spawnSync} from 'node:child_process';
import {fileURLToPath} from 'node:url';
import {missing} from './browser.mjs';

const why = missing();
if (why) {
  console.log(`skipped: ${why}`);
  process.exit(0);
}
const here = fileURLToPath(new URL('.', import.meta.url));
// Runs one test at a time, as rendering in software leaves no core for a second browser.
const {status} = spawnSync(process.execPath, ['--test', '--test-concurrency=1',
  ...['live_page', 'file_page', 'stage_page', 'ops_panel', 'jump_panel'].map((name) => `${here}${name}.test.mjs`)],
  {stdio: 'inherit'});
process.exit(status ?? 1);
