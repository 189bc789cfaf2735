// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page print "skipped:" and the reason if its packages are not installed.

import {existsSync} from 'node:fs';
import {fileURLToPath} from 'node:url';

const here = fileURLToPath(new URL('..', import.meta.url));

const built = process.env.MAREY_PAGE ?? `${here}dist`;
/** Folder of the built page and of the parts of reports. */
export const pageFolder = `${built}/served/`;
export const reportFolder = `${built}/reports/`;

/** The reason why packages are missing; null if they are installed. */
export function missingPackages() {
  return ['esbuild', 'typescript', 'three', 'playwright-core'].every((name) =>
    existsSync(`${here}node_modules/${name}`)) ? null
    : 'the packages of live/viewer are missing; npm ci --prefix live/viewer';
}

export function skipWithoutPackages() {
  const why = missingPackages();
  if (!why) return;
  console.log(`skipped: ${why}`);
  process.exit(0);
}
