// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page say "skipped:" and why where its packages were not fetched.

import {existsSync} from 'node:fs';
import {fileURLToPath} from 'node:url';

const here = fileURLToPath(new URL('..', import.meta.url));

const built = process.env.MAREY_PAGE ?? `${here}dist`;
/** Where the served page was built, and the parts of reports. */
export const pageFolder = `${built}/served/`;
export const reportFolder = `${built}/reports/`;

/** Why there are no packages; null when there are. */
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
