// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// npm run build: bundles src/ into dist/ (or the folder that MAREY_PAGE names). served/ has the
// page that marey serves; reports/ has the shell, style and script of each kind of report, into
// which marey writes its data. With --watch it rebuilds after each change.
import {copyFile, mkdir, readFile, writeFile} from 'node:fs/promises';
import {fileURLToPath} from 'node:url';
import esbuild from 'esbuild';

const here = fileURLToPath(new URL('.', import.meta.url));
const out = process.env.MAREY_PAGE ?? `${here}dist`;
const isWatching = process.argv.includes('--watch');
/** Sections of each report, in order. */
const sections = {
  report: {motion: 'Motion', pictures: 'Pictures', reprojection: 'Reprojection',
    tags: 'Tags and gaps', joints: 'Joint centres', subject: 'Subject', cameras: 'Cameras',
    avatars: 'Avatars and files', time: 'Time'},
  calibration: {layout: 'Camera positions', errors: 'Expected error',
    pictures: 'Views of each camera', together: 'Views in common', checks: 'Checks',
    parameters: 'Parameters', outliers: 'Outliers'},
  markers: {samples: 'Samples', residuals: 'Distance from the body', curves: 'Before and after',
    stills: 'Stills', joints: 'Joint centres', labels: 'Labels'},
  library_check: {figures: 'Figures', problems: 'Kinds of problems',
    sources: 'Sources without clips', clips: 'Clips'},
};

async function bundle(names, format, folder) {
  const options = {
    entryPoints: names.flatMap((name) =>
      [`${here}src/pages/${name}.ts`, `${here}src/styles/${name}.css`]),
    entryNames: '[name]',
    outdir: `${out}/${folder}`,
    bundle: true,
    minify: !isWatching,
    format,
    target: ['chrome110', 'firefox115', 'safari16.4'],
    legalComments: 'inline',
    // uPlot's licence notice is not marked as a legal comment, so it is added here.
    banner: {js: '/*! Contains uPlot, Copyright (c) 2025 Leon Sorokin, MIT License. */'},
    logLevel: 'warning',
  };
  if (isWatching) await (await esbuild.context(options)).watch();
  else await esbuild.build(options);
}

await mkdir(`${out}/served`, {recursive: true});
await mkdir(`${out}/reports`, {recursive: true});
for (const name of ['index.html', 'icon.svg']) {
  await copyFile(`${here}src/pages/${name}`, `${out}/served/${name}`);
}
const shell = await readFile(`${here}src/pages/report.html`, 'utf8');
for (const [name, titles] of Object.entries(sections)) {
  const places = Object.entries(titles).map(([id, title]) =>
    `  <section id="${id}"><h2>${title}</h2></section>\n`).join('');
  await writeFile(`${out}/reports/${name}.html`, shell.replace('{{sections}}', places));
}
await bundle(['page'], 'esm', 'served');
await bundle(Object.keys(sections), 'iife', 'reports');
