// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// node run_real.mjs [edit]: tests the page that marey serves, in a browser; with edit, the page of
// marey edit. MAREY_PROGRAM is marey, MAREY_RESULTS what `marey process` made of MAREY_SESSION,
// whose trial is `walk`. Prints "skipped:" if there is no browser.

import {spawnSync} from 'node:child_process';
import {existsSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import {missing} from './browser.mjs';

const why = missing({built: false});
if (why) {
  console.log(`skipped: ${why}`);
  process.exit(0);
}
for (const name of ['MAREY_PROGRAM', 'MAREY_RESULTS', 'MAREY_SESSION']) {
  if (!existsSync(process.env[name] ?? '')) {
    console.error(`${name} is not an existing file or folder`);
    process.exit(1);
  }
}
const script = process.argv[2] === 'edit' ? 'edit_page.test.mjs' : 'real_page.test.mjs';
const {status} = spawnSync(process.execPath, ['--test',
  fileURLToPath(new URL(script, import.meta.url))], {stdio: 'inherit'});
process.exit(status ?? 1);
