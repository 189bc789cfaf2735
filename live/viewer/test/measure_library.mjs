// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// npm run measure:library -- LIB [TIMES]: measures the page of `marey view LIB` in a headless
// browser: from the request of the page to the list with its first drawings, from the last key in
// the filter to the filtered list, and from a click on a clip to its picture. MAREY_PROGRAM is
// marey; MAREY_WEB_ROOT a folder with the page instead of the built-in one.
// docs/accuracy/library_page.md has figures.

import os from 'node:os';
import {openBrowser} from './browser.mjs';
import {end_all, serve} from './marey_process.mjs';

const [library, times = '10'] = process.argv.slice(2);
const FILTERS = ['quality=fail', 'content=walk', 'seconds>5 and quality=pass', 'content=walk and spike>3',
  'has(hand_right above head for 0.3 s)', ''];

const sorted = (values) => [...values].sort((a, b) => a - b);
function tell(what, values) {
  const all = sorted(values);
  const at = (share) => all[Math.min(all.length - 1, Math.floor(share * all.length))];
  console.log(`${what.padEnd(58)} ${[all[0], at(0.5), at(0.95)].map((ms) =>
    ms.toFixed(0).padStart(7)).join('')}   n = ${all.length}`);
}

const browser = await openBrowser();
const {address} = await serve('view', library, ...(process.env.MAREY_WEB_ROOT
  ? ['--web-root', process.env.MAREY_WEB_ROOT] : []));
const load = os.loadavg()[0];
const lists = [];
const drawn = [];
const filtered = new Map(FILTERS.map((query) => [query, []]));
const chosen = [];
let clips = 0;
for (let run = 0; run < Number(times); ++run) {
  const context = await browser.newContext({viewport: {width: 1280, height: 720}});
  const page = await context.newPage();
  await page.addInitScript(() => {
    const look = () => {
      const rows = document.querySelectorAll('.clip-row:not(.is-waiting)');
      if (rows.length > 0 && !window.listed_ms) window.listed_ms = performance.now();
      const {drawings, store} = window.mareyPage ?? {};
      const row = store?.row(0);
      if (row && drawings.of(row.clip) !== undefined && !window.drawn_ms) {
        window.drawn_ms = performance.now();
      }
      requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
  await page.goto(address);
  await page.waitForFunction(() => window.drawn_ms && window.mareyPage.clip);
  const [list_ms, drawn_ms, all] = await page.evaluate(() =>
    [window.listed_ms, window.drawn_ms, window.mareyPage.library.clips]);
  clips = all;
  lists.push(list_ms);
  drawn.push(drawn_ms);
  await page.waitForTimeout(1000);
  for (const query of FILTERS) {
    filtered.get(query).push(await page.evaluate(async (text) => {
      const input = document.querySelector('.clip-query');
      const frame = () => new Promise(requestAnimationFrame);
      const start = performance.now();
      input.value = text;
      input.dispatchEvent(new Event('input'));
      while (window.mareyPage.store.order.query !== text) {
        await frame();
        if (performance.now() - start > 10000) throw new Error(`refused: ${text}`);
      }
      await frame(); // Its rows are written in this refresh of the screen.
      return performance.now() - start;
    }, query));
    await page.waitForTimeout(200);
  }
  for (let row = 1; row < 6; ++row) {
    chosen.push(await page.evaluate(async (index) => {
      const rows = [...document.querySelectorAll('.clip-row')];
      const row = rows.find(({ariaPosInSet}) => Number(ariaPosInSet) === index + 1);
      const before = window.mareyPage.clip;
      const start = performance.now();
      row.click();
      while (window.mareyPage.clip === before || window.mareyPage.stale ||
        !window.mareyPage.stage.bodies.some(({present}) => present)) {
        await new Promise(requestAnimationFrame);
      }
      return performance.now() - start;
    }, row));
  }
  await context.close();
}
console.log(`${clips} clips; load before: ${load.toFixed(1)}; ${os.cpus().length} cores`);
console.log(`${'[ms]'.padEnd(58)} ${['least', 'median', '95 %'].map((word) =>
  word.padStart(7)).join('')}`);
tell('page requested to list', lists);
tell('page requested to first drawings', drawn);
for (const [query, values] of filtered) tell(`last key to list: ${query || '(all)'}`, values);
tell('click to picture of a clip and its neighbours', chosen);
await end_all();
await browser.close();
