// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// node measure_stage.mjs SCENE.toml: measures the pictures per second of the page of
// `marey stage --live`, the time from sending a frame to its display, and the processor time of
// a picture. MAREY_PROGRAM is marey. Renders in software, so that the result does not depend on a
// graphics card.

import {readdirSync, readFileSync} from 'node:fs';
import {loadavg} from 'node:os';
import {missing, openBrowser, openPage} from './browser.mjs';
import {end_all, serve} from './marey_process.mjs';

const SETTLE_MS = 6000;
const MEASURE_MS = 12000;
const MS_PER_TICK = 10;

/** Processor time of all processes that this one started. [ms] */
function used_ms() {
  const all = readdirSync('/proc').filter((name) => /^\d+$/.test(name)).flatMap((pid) => {
    try {
      const words = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ').at(-1).split(' ');
      return [{pid: Number(pid), parent: Number(words[1]),
        ms: MS_PER_TICK * (Number(words[11]) + Number(words[12]))}];
    } catch {
      return []; // It has ended meanwhile.
    }
  });
  const mine = new Set([process.pid]);
  for (let before = 0; before < mine.size;) {
    before = mine.size;
    for (const {pid, parent} of all) if (mine.has(parent)) mine.add(pid);
  }
  mine.delete(process.pid);
  return all.reduce((sum, {pid, ms}) => sum + (mine.has(pid) ? ms : 0), 0);
}

async function measure(browser, address, width, height) {
  const {page, close} = await openPage(browser, address, {viewport: {width, height: 720}});
  await page.evaluate(() => document.body.classList.add('without-panels'));
  const bars = await page.evaluate(() =>
    innerHeight - document.querySelector('.stage canvas').clientHeight);
  await page.setViewportSize({width, height: height + bars});
  await page.waitForTimeout(SETTLE_MS);
  const before_ms = used_ms();
  const result = await page.evaluate((ms) => new Promise((done) => {
    const {mareyPage} = window;
    const delays_ms = [];
    const frames = mareyPage.reel.ring.next;
    const start = performance.now();
    mareyPage.onDrawn = () => {
      mareyPage.stage.renderer.pixels(); // Waits until they are there.
      delays_ms.push(performance.now() - start);
    };
    setTimeout(() => {
      const seconds = (performance.now() - start) / 1000;
      done({pictures: delays_ms.length, seconds, ratio: mareyPage.stage.renderer.quality.ratio,
        received: mareyPage.reel.ring.next - frames, bodies: mareyPage.stage.bodies.length});
    }, ms);
  }), MEASURE_MS);
  const {pictures, seconds, ratio, received, bodies} = result;
  console.log(`${bodies} bodies, ${width}x${height}: ${(pictures / seconds).toFixed(1)} pictures/s ` +
    `of ${(received / seconds).toFixed(1)} frames/s received, pixel ratio ${ratio}, ` +
    `${((used_ms() - before_ms) / pictures).toFixed(1)} ms of processor time a picture ` +
    `(browser and marey), load ${loadavg()[0].toFixed(1)}`);
  await close();
}

const why = missing({built: false});
if (why) {
  console.log(`skipped: ${why}`);
  process.exit(0);
}
const browser = await openBrowser();
const root = process.env.MAREY_PAGE ? ['--web-root', `${process.env.MAREY_PAGE}/served`] : [];
const {address} = await serve('stage', process.argv[2], '--live', ...root);
for (const [width, height] of [[640, 360], [960, 540], [1280, 720]]) {
  await measure(browser, address, width, height);
}
await browser.close();
await end_all();
