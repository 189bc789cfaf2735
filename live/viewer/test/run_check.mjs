// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Checks the types of the page as `npm run check` does.

import {spawnSync} from 'node:child_process';
import {fileURLToPath} from 'node:url';
import {skipWithoutPackages} from './installed.mjs';

skipWithoutPackages();
const here = fileURLToPath(new URL('..', import.meta.url));
const {status} = spawnSync(process.execPath,
  [`${here}node_modules/typescript/bin/tsc`, '--noEmit', '--project', here], {stdio: 'inherit'});
process.exit(status ?? 1);
