// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// npm run build: src/ as one page in dist/ (or in the folder that MAREY_PAGE names), which needs
// nothing else. With --watch it goes on.
import {copyFile, mkdir} from 'node:fs/promises';
import {fileURLToPath} from 'node:url';
import esbuild from 'esbuild';

const here = fileURLToPath(new URL('.', import.meta.url));
const options = {
  entryPoints: [`${here}src/page.ts`, `${here}src/page.css`],
  outdir: process.env.MAREY_PAGE ?? `${here}dist`,
  bundle: true,
  minify: !process.argv.includes('--watch'),
  format: 'esm',
  target: ['chrome110', 'firefox115', 'safari16.4'],
  legalComments: 'inline',
  logLevel: 'warning',
};
await mkdir(options.outdir, {recursive: true});
for (const name of ['index.html', 'icon.svg']) {
  await copyFile(`${here}src/${name}`, `${options.outdir}/${name}`);
}
if (process.argv.includes('--watch')) await (await esbuild.context(options)).watch();
else await esbuild.build(options);
