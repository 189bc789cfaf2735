// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// npm run measure [-- avatar.glb]: measures the pictures per second that the page draws,
// and the time from sending a frame to its display. Renders in software, so that the result
// does not depend on a graphics card.

import {loadavg} from 'node:os';
import {missing, openBrowser, openPage} from './browser.mjs';
import {MockServer} from './mock_server.mjs';
import {realAvatar} from './real_avatar.mjs';

const SETTLE_MS = 6000;
const MEASURE_MS = 12000;

const percentile = (values, share) =>
  values.sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

/** `finish`: also waits until the pixels are there, which costs time itself. */
async function measure(browser, {label, rate_hz, width, height, finish, avatar, mode = 'live'}) {
  const server = new MockServer({rate_hz, avatar, mode,
    clock_s: () => (performance.timeOrigin + performance.now()) / 1000});
  const address = await server.start();
  const {page, close} = await openPage(browser, address, {viewport: {width, height: 720}});
  await page.evaluate(() => document.body.classList.add('without-panels'));
  const bars = await page.evaluate(() =>
    innerHeight - document.querySelector('.stage canvas').clientHeight);
  await page.setViewportSize({width, height: height + bars});
  await page.waitForTimeout(SETTLE_MS);
  const result = await page.evaluate(([ms, wait]) => new Promise((done) => {
    const {mareyPage} = window;
    const delays_ms = [];
    const start = performance.now();
    mareyPage.onDrawn = (sent_s) => {
      if (wait) mareyPage.stage.renderer.pixels();
      delays_ms.push(performance.timeOrigin + performance.now() - 1000 * sent_s);
    };
    setTimeout(() => done({delays_ms, ratio: mareyPage.stage.renderer.quality.ratio,
      fps: delays_ms.length / (performance.now() - start) * 1000}), ms);
  }), [MEASURE_MS, finish]);
  const {fps, ratio, delays_ms} = result;
  console.log(`${label}, ${width}x${height}, sent at ${rate_hz} Hz: ${fps.toFixed(1)} fps, ` +
    `sent to ${finish ? 'pixels' : 'drawn'} p50 ${percentile(delays_ms, 0.5).toFixed(0)} ms, ` +
    `p95 ${percentile(delays_ms, 0.95).toFixed(0)} ms, pixel ratio ${ratio}, ` +
    `load ${loadavg()[0].toFixed(1)}`);
  await close();
  await server.stop();
}

const why = missing();
if (why) {
  console.log(`skipped: ${why}`);
  process.exit(0);
}
const file = process.argv[2];
const avatar = file ? realAvatar(file) : true;
const label = file ? file.split('/').pop() : '25 bones, 4.4k triangles';
const browser = await openBrowser();
for (const finish of [false, true]) {
  for (const rate_hz of [30, 60]) {
    await measure(browser, {label, rate_hz, width: 640, height: 360, finish, avatar});
  }
}
await measure(browser, {label, rate_hz: 30, width: 1280, height: 720, finish: true, avatar});
for (const finish of [false, true]) {
  await measure(browser, {label: 'forty bodies of 25 bones', rate_hz: 60, width: 960, height: 600,
    finish, mode: 'stage'});
}
await browser.close();
