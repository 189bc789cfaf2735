// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// node run_library.mjs: tests the page of a motion library in a browser. MAREY_PROGRAM is marey,
// MAREY_LIBRARY_WRITER the program write_page_library of the tests. MAREY_WEB_ROOT, if set, is a
// folder with the page instead of the built-in one. Prints "skipped:" if there is
// no browser.

import {spawnSync} from 'node:child_process';
import {existsSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import {missing} from './browser.mjs';

const why = missing({built: false});
if (why) {
  console.log(`skipped: ${why}`);
  process.exit(0);
}
for (const name of ['MAREY_PROGRAM', 'MAREY_LIBRARY_WRITER']) {
  if (!existsSync(process.env[name] ?? '')) {
    console.error(`${name} is not an existing file`);
    process.exit(1);
  }
}
const {status} = spawnSync(process.execPath, ['--test',
  fileURLToPath(new URL('library_page.test.mjs', import.meta.url))], {stdio: 'inherit'});
process.exit(status ?? 1);
