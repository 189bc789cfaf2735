// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// node run_stage.mjs: tests the page of `marey stage --live` in a browser. MAREY_PROGRAM is marey,
// MAREY_SCENES the folder of the sample scenes. Prints "skipped:" if there is no browser.

import {spawnSync} from 'node:child_process';
import {existsSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import {missing} from './browser.mjs';

const why = missing({built: false});
if (why) {
  console.log(`skipped: ${why}`);
  process.exit(0);
}
for (const name of ['MAREY_PROGRAM', 'MAREY_SCENES']) {
  if (!existsSync(process.env[name] ?? '')) {
    console.error(`${name} is not an existing file or folder`);
    process.exit(1);
  }
}
const {status} = spawnSync(process.execPath, ['--test',
  fileURLToPath(new URL('stage_live.test.mjs', import.meta.url))], {stdio: 'inherit'});
process.exit(status ?? 1);
