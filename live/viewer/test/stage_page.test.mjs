// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// User actions on the page of a scene that runs live, with forty bodies of the mock server.

import assert from 'node:assert/strict';
import {after, before, beforeEach, test} from 'node:test';
import {openBrowser, openPage} from './browser.mjs';
import {handle_at, until} from './marey_process.mjs';
import {MockServer} from './mock_server.mjs';

let browser;
let server;
let opened;
let page;
let finger;
before(async () => {
  browser = await openBrowser();
  server = new MockServer({mode: 'stage', rate_hz: 10});
  opened = await openPage(browser, await server.start(), {hasTouch: true});
  ({page} = opened);
  finger = await page.context().newCDPSession(page);
  await page.waitForTimeout(600); // The camera of the view has come to rest.
});
after(async () => {
  await browser.close();
  await server.stop();
});
beforeEach(() => { server.heard.length = 0; });

const said = (type) => server.heard.filter((words) => words.type === type);
const held = () => page.evaluate(() =>
  window.mareyPage.stage.handles.handles.map(({words}) => words.active));
/** Sends a touch of one finger, at a time of the page's own clock if it is given. [s] */
const touch = (type, x, y, timestamp) => finger.send('Input.dispatchTouchEvent',
  {type, touchPoints: type === 'touchEnd' ? [] : [{x, y}], ...(timestamp ? {timestamp} : {})});

test('all bodies are drawn at their places, and the targets move', async () => {
  assert.equal(await page.evaluate(() => window.mareyPage.stage.bodies
    .filter(({present, object}) => present && object.visible).length), 40);
  const place = () => page.evaluate(() =>
    window.mareyPage.stage.handles.handles[1].shown_in_world[0]);
  const before_ = await place();
  await until('the target to move', async () => Math.abs(await place() - before_) > 0.01);
  assert.ok(!await page.locator('.section-cameras').isVisible());
  assert.ok(!await page.locator('.record').isVisible());
});

test('a target is dragged with the mouse, and a double click returns it', async () => {
  const [x, y] = await handle_at(page, 'left');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y - 60, {steps: 8});
  await page.mouse.up();
  await until('the end of the drag', () => said('drag').some(({phase}) => phase === 'end'));
  const drags = said('drag');
  assert.equal(drags[0].phase, 'begin');
  assert.ok(drags.at(-1).p_in_world[1] > drags[0].p_in_world[1] + 0.1);
  await until('it to be held', async () => (await held())[0]);
  const [u, v] = await handle_at(page, 'left');
  assert.ok(Math.hypot(u - x - 40, v - y + 60) < 8, 'it stays under the pointer');
  // Repeated, as a machine with much to do can be too slow for a double click.
  await until('it to be released', async () => {
    await page.mouse.dblclick(u, v);
    return said('constraint').length > 0;
  });
  assert.deepEqual(said('constraint')[0], {type: 'constraint', id: 'left', active: false});
  await until('its path', async () => !(await held())[0]);
});

test('a finger drags a target, and a double tap returns it', async () => {
  const [x, y] = await handle_at(page, 'left');
  await touch('touchStart', x, y);
  for (let i = 1; i <= 4; ++i) await touch('touchMove', x + 10 * i, y - 10 * i);
  await touch('touchEnd');
  await until('the end of the drag', () => said('drag').some(({phase}) => phase === 'end'));
  await until('it to be held', async () => (await held())[0]);
  const [u, v] = await handle_at(page, 'left');
  const begin_s = Date.now() / 1000;
  // The times of the events count, not those of a machine with much to do.
  for (const [i, type] of ['touchStart', 'touchEnd', 'touchStart', 'touchEnd'].entries()) {
    await touch(type, u, v, begin_s + 0.08 * i);
  }
  await until('it to be released', () => said('constraint').length > 0);
  await until('its path', async () => !(await held())[0]);
});

test('a target that cannot be dragged stays, and the view turns instead', async () => {
  const azimuth = () => page.evaluate(() => window.mareyPage.stage.orbit.azimuth);
  const before_ = await azimuth();
  const [x, y] = await handle_at(page, 'right');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y, {steps: 4});
  await page.mouse.up();
  await until('the view to turn', async () => Math.abs(await azimuth() - before_) > 0.05);
  assert.equal(said('drag').length, 0);
});

test('the scene is paused, played and restarted, and its figures are shown', async () => {
  const section = page.locator('.section-run');
  await page.getByRole('button', {name: 'Pause scene'}).click();
  await until('the pause', async () => /paused/.test(await page.locator('.pill').textContent()));
  await page.getByRole('button', {name: 'Play scene'}).click();
  await page.getByRole('button', {name: 'Restart'}).click();
  await until('all actions', () => said('run').length === 3);
  assert.deepEqual(said('run').map(({action}) => action), ['pause', 'play', 'restart']);
  assert.match(await section.textContent(), /wrist_error0.400 mm≤ 1 ✓/);
  assert.match(await section.textContent(), /feet_slide–≤ 0.1/);
  assert.deepEqual(opened.troubles, []);
});
