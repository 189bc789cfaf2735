// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page with a recording: playing, scrubbing, stepping, adapting.

import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {openBrowser, openPage} from './browser.mjs';
import {MockServer} from './mock_server.mjs';

const FRAMES = 300;
const FRAME_RATE_HZ = 30; // As in the mock server.

let browser;
let server;
let opened;
let page;
before(async () => {
  browser = await openBrowser();
  server = new MockServer({mode: 'file', frames: FRAMES});
  opened = await openPage(browser, await server.start());
  ({page} = opened);
  await page.waitForFunction(() => window.mareyPage.stage.bodies[1]?.dressed &&
    window.mareyPage.stage.bodies[0].present);
});
after(async () => {
  await browser.close();
  await server.stop();
});

const time = () => page.evaluate(() => window.mareyPage.reel.playback.time);
/** Asserts that playback advances at `speed` times the recorded rate over 30 frames of the
 *  screen, measured by their duration; the page counts each as 0.25 s at most. The error may
 *  be one frame of the screen, as the page and this test measure at different times in it. */
async function assert_plays_at(speed) {
  const {moved, played_s, longest_s} = await page.evaluate(async () => {
    const {playback} = window.mareyPage.reel;
    let last_ms = await new Promise(requestAnimationFrame);
    const from = playback.time;
    let played_s = 0;
    let longest_s = 0;
    for (let frame = 0; frame < 30; ++frame) {
      const now_ms = await new Promise(requestAnimationFrame);
      const seconds = Math.min((now_ms - last_ms) / 1000, 0.25);
      played_s += seconds;
      longest_s = Math.max(longest_s, seconds);
      last_ms = now_ms;
    }
    return {moved: playback.time - from, played_s, longest_s};
  });
  const rate_hz = speed * FRAME_RATE_HZ;
  assert.ok(Math.abs(moved - played_s * rate_hz) <= longest_s * rate_hz + 1e-6,
    `${moved} frames in ${played_s} s`);
}
/** Returns after `count` frames of the screen, however long a busy machine takes for them. */
const pass_frames = count => page.evaluate(async frames => {
  for (let frame = 0; frame < frames; ++frame)
    await new Promise(requestAnimationFrame);
}, count);
const hips_y = () => page.evaluate(() => window.mareyPage.stage.bodies[0].pose.p_in_world[1]);

test('keys step, jump and play', async () => {
  await page.keyboard.press('Home');
  await page.keyboard.press('ArrowRight');
  assert.equal(await time(), 1);
  await page.keyboard.press('Shift+ArrowRight');
  assert.equal(await time(), 31);
  await page.keyboard.press('End');
  assert.equal(await time(), FRAMES - 1);
  await page.keyboard.press('Home');
  await page.keyboard.press(' ');
  await assert_plays_at(1);
  await page.keyboard.press(' ');
  const reached = await time();
  await pass_frames(5);
  assert.equal(await time(), reached, 'playback is paused');
});

test('the timeline scrubs, zooms and shows the position', async () => {
  const box = await page.locator('.strips').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + 25);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.75 * box.width, box.y + 25, {steps: 5});
  await page.mouse.up();
  const reached = await time();
  assert.ok(reached > 0.6 * FRAMES && reached < 0.8 * FRAMES);
  assert.equal(await page.locator('.strips').getAttribute('aria-valuenow'), String(reached));
  assert.match(await page.locator('.clock').textContent(),
    new RegExp(`frame ${reached + 100}$`));
  await page.mouse.wheel(0, -600);
  await page.waitForTimeout(100);
  assert.ok(await page.evaluate(() => !window.mareyPage.timeline.window.whole));
  await page.mouse.dblclick(box.x + box.width / 2, box.y + 25);
  assert.ok(await page.evaluate(() => window.mareyPage.timeline.window.whole));
});

test('slow motion is shown between frames', async () => {
  await page.keyboard.press('Home');
  await page.getByLabel('Speed').selectOption('0.1');
  await page.locator('.play').click();
  await assert_plays_at(0.1);
  await page.locator('.play').click();
  const reached = await time();
  assert.notEqual(reached, Math.floor(reached));
  await page.getByLabel('Speed').selectOption('1');
});

test('loop starts again', async () => {
  await page.locator('.loop').click();
  await page.keyboard.press('End');
  await page.keyboard.press(' ');
  await page.waitForFunction(() => window.mareyPage.reel.playback.time < 100);
  await page.keyboard.press(' ');
  await page.locator('.loop').click();
});

test('details show segments, contacts and graphs', async () => {
  const height = () => page.evaluate(() => document.querySelector('.timeline').clientHeight);
  const before_px = await height();
  await page.keyboard.press('d');
  assert.ok(await height() > before_px + 200);
  await page.keyboard.press('d');
  assert.equal(await height(), before_px);
});

test('a dragged constraint shows that frame adapted, until one goes elsewhere', async () => {
  await page.evaluate(() => window.mareyPage.seek(40));
  await page.waitForTimeout(700);
  const before_m = await hips_y();
  const [x, y] = await page.evaluate(() => {
    const {left, top} = document.querySelector('.stage canvas').getBoundingClientRect();
    const at = window.mareyPage.stage.pixelOfHandle('left hand');
    return [at[0] + left, at[1] + top];
  });
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 10, y - 30, {steps: 3});
  await page.mouse.up();
  await page.waitForFunction((was) =>
    window.mareyPage.stage.bodies[0].pose.p_in_world[1] > was + 0.09, before_m);
  assert.ok(server.heard.filter(({type}) => type === 'drag').every(({frame}) => frame === 140));
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowLeft');
  await page.waitForFunction((was) =>
    Math.abs(window.mareyPage.stage.bodies[0].pose.p_in_world[1] - was) < 1e-6, before_m);
});

test('no errors and no requests to other servers', () => {
  assert.deepEqual(opened.troubles, []);
});
