// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page with a live session: drawing, dragging, commands, reconnection.

import assert from 'node:assert/strict';
import {existsSync} from 'node:fs';
import {after, afterEach, before, beforeEach, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openBrowser, openPage} from './browser.mjs';
import {MockServer} from './mock_server.mjs';
import {realAvatar} from './real_avatar.mjs';

const DATA = process.env.MAREY_SHARED_DATA ??
  fileURLToPath(new URL('../../../../shared/data', import.meta.url));

let browser;
let server;
let opened;
let page;
before(async () => { browser = await openBrowser(); });
after(() => browser.close());
beforeEach(async () => {
  server = new MockServer();
  opened = await openPage(browser, await server.start());
  ({page} = opened);
});
afterEach(async () => {
  await opened.close();
  await server.stop();
});

/** Waits until this holds; fails with its name after a time that is long on a busy machine. */
async function until(what, holds, limit_ms = 20000) {
  const end = performance.now() + limit_ms;
  while (!(await holds())) {
    assert.ok(performance.now() < end, `this did not happen: ${what}`);
    await new Promise((done) => setTimeout(done, 40));
  }
}

const said = (type) => server.heard.filter((words) => words.type === type);
const text = (selector) => page.locator(selector).textContent();

/** The largest distance of the avatar's nodes from the joints that drive them. [m] */
const offSkin = () => page.evaluate(() => {
  const body = window.mareyPage.stage.bodies[1];
  if (!body.dressed || !body.present) return null;
  body.avatar.object.updateMatrixWorld(true);
  let worst = 0;
  body.avatar.nodes.forEach((node, i) => {
    if (!node) return;
    const at = node.matrixWorld.elements;
    for (let k = 0; k < 3; ++k) {
      worst = Math.max(worst, Math.abs(at[12 + k] - body.pose.p_in_world[3 * i + k] -
        body.words.offset_m[k]));
    }
  });
  return worst;
});

test('bodies are drawn, the skin follows the skeleton, nothing leaves the server', async () => {
  await until('the skin', async () => (await offSkin()) !== null);
  assert.ok(await offSkin() < 1e-5);
  await until('greeting and echo', () => said('hello').length > 0 && said('shown').length > 0);
  await until('pictures to be asked for', () => said('thumbnails').some(({on}) => on));
  await until('a picture', () => page.evaluate(() =>
    document.querySelector('.pictures canvas').width === 320));
  assert.match(await text('.pill'), /tracked/);
  assert.deepEqual(opened.troubles, []);
});

test('a dragged hand follows the pointer, and the server receives it', async () => {
  await page.waitForTimeout(600); // The camera of the view has come to rest.
  const at = (id) => page.evaluate((name) => {
    const {left, top} = document.querySelector('.stage canvas').getBoundingClientRect();
    const [x, y] = window.mareyPage.stage.pixelOfHandle(name);
    return [x + left, y + top];
  }, id);
  const [x, y] = await at('left hand');
  await page.mouse.move(x + 3, y);
  await page.mouse.down();
  await page.mouse.move(x + 23, y - 30, {steps: 4});
  await page.mouse.move(x + 43, y - 60, {steps: 4});
  await page.mouse.up();
  await until('the end of the drag', () => said('drag').some(({phase}) => phase === 'end'));
  const drags = said('drag');
  assert.equal(drags[0].phase, 'begin');
  assert.ok(drags.filter(({phase}) => phase === 'move').length >= 2);
  assert.ok(drags.every(({id}) => id === 'left hand'));
  const [from, to] = [drags[0].p_in_world, drags[drags.length - 1].p_in_world];
  assert.ok(to[1] > from[1] + 0.1 && to[1] < from[1] + 0.8, `from ${from} to ${to}`);
  assert.equal(drags[0].frame, undefined);
  const [seen_x, seen_y] = await at('left hand');
  assert.ok(Math.hypot(seen_x - x - 40, seen_y - y + 60) < 3, 'it is under the pointer');

  server.heard.length = 0;
  const [u, v] = await at('right hand');
  await page.mouse.move(u, v);
  await page.mouse.down();
  await page.keyboard.down('Shift');
  await page.mouse.move(u + 60, v - 40, {steps: 4});
  await page.mouse.up();
  await page.keyboard.up('Shift');
  await until('the end of the drag', () => said('drag').some(({phase}) => phase === 'end'));
  const [start, end] = [said('drag')[0], said('drag').at(-1)].map((d) => d.p_in_world);
  assert.ok(end[1] > start[1] + 0.05);
  assert.ok(Math.abs(end[0] - start[0]) < 1e-6 && Math.abs(end[2] - start[2]) < 1e-6,
    'with shift only up and down');
  assert.deepEqual(opened.troubles, []);
});

test('the past can be shown while frames arrive, and the present again', async () => {
  await page.waitForFunction(() => {
    const {first, last} = window.mareyPage.reel.playback;
    return last - first > 40; // 0.4 of the timeline is then well beyond 5 frames.
  });
  const time = () => page.evaluate(() => {
    const {playback} = window.mareyPage.reel;
    return {...playback};
  });
  const strips = await page.locator('.strips').boundingBox();
  await page.mouse.click(strips.x + 0.6 * strips.width, strips.y + 25);
  const back = await time();
  assert.ok(!back.following && back.time < back.last - 5);
  await page.waitForFunction(
    last => window.mareyPage.reel.playback.last > last, back.last);
  assert.equal((await time()).time, back.time, 'the past stays');
  await page.locator('.live-button').click();
  assert.ok((await time()).following);
});

test('calibration goes step by step, and can be cancelled', async () => {
  await page.locator('.section-wizard summary').click();
  await page.getByRole('button', {name: 'Start'}).click();
  await until('step one', async () => (await text('.section-wizard h3')) === 'Stand still');
  await page.getByRole('button', {name: 'Next'}).click();
  await until('step two', async () => (await text('.section-wizard h3')) === 'Move every joint');
  assert.equal(await page.locator('.grids canvas').count(), 3);
  await page.getByRole('button', {name: 'Next'}).click();
  await until('the end', async () => (await text('.section-wizard h3')) === 'Done');
  assert.match(await text('.quality'), /left forearm24.1 cm ± 0.3 ✓/);
  await page.getByRole('button', {name: 'Accept'}).click();
  await until('all four words', () => said('wizard').length === 4);
  assert.deepEqual(said('wizard').map(({action}) => action), ['start', 'next', 'next', 'accept']);
  await page.getByRole('button', {name: 'Start'}).click();
  await page.getByRole('button', {name: 'Cancel'}).click();
  await until('it to be cancelled', () => said('wizard').at(-1).action === 'cancel');
});

test('constraints are switched, takes recorded, states shown', async () => {
  await page.locator('.section-constraints summary').click();
  await page.getByRole('checkbox', {name: 'gaze'}).check();
  await until('the constraint', () => said('constraint').length === 1);
  assert.deepEqual(said('constraint')[0], {type: 'constraint', id: 'gaze', active: true});
  await page.locator('.record').click();
  await until('recording', async () => /Stop/.test(await text('.record')));
  await page.locator('.record').click();
  await until('its end', () => said('record').length === 2);
  server.recordingTrouble = 'take-003: the disk is full';
  await page.locator('.record').click();
  await until('the trouble', async () => /failed/.test(await text('.record')));
  assert.match(await page.locator('.record').getAttribute('title'), /disk is full/);
  await page.locator('.record').click();
  await until('no more of it', async () => (await text('.record')) === 'Record');
  await page.locator('.section-status summary').click();
  assert.match(await text('.section-status'), /detect left/);
  assert.match(await text('.facts'), /21 ms, p95 30 ms/);
  assert.match(await text('.section-cameras'), /silent/);
});

test('dark and light are chosen, shown and remembered', async () => {
  const background = () => page.evaluate(() =>
    getComputedStyle(document.body).backgroundColor);
  const light = await background();
  await page.locator('#bar .theme').click();
  const dark = await background();
  assert.notEqual(light, dark);
  await page.reload();
  await until('the page', () => page.evaluate(() => window.mareyPage?.drawnCount > 0));
  assert.equal(await background(), dark);
  await page.emulateMedia({colorScheme: 'dark'});
  await page.locator('.section-view select').selectOption('system');
  assert.equal(await background(), dark);
});

test('keys move time and show the help', async () => {
  await page.keyboard.press('?');
  assert.ok(await page.locator('dialog.help').isVisible());
  await page.keyboard.press('Escape');
  assert.ok(!await page.locator('dialog.help').isVisible());
  await page.keyboard.press('ArrowLeft');
  const state = () => page.evaluate(() => ({...window.mareyPage.reel.playback}));
  assert.ok(!(await state()).following);
  await page.keyboard.press('End');
  assert.ok((await state()).following);
  await page.keyboard.press('3');
  await until('the view from above', () => page.evaluate(() =>
    window.mareyPage.stage.orbit.height > 1.4));
});

test('on a phone all is within the screen and large enough for a finger', async () => {
  await opened.close();
  opened = await openPage(browser, `http://127.0.0.1:${server.port}/`, {
    viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true, deviceScaleFactor: 2});
  ({page} = opened);
  assert.ok(!await page.locator('#panels').isVisible(), 'panels begin folded');
  await page.getByRole('button', {name: 'Panels'}).tap();
  assert.ok(await page.locator('#panels').isVisible());
  const {width, stage_px, small} = await page.evaluate(() => ({
    width: document.documentElement.scrollWidth,
    stage_px: document.querySelector('.stage canvas').clientWidth,
    small: [...document.querySelectorAll('button, select, summary')].filter((node) =>
      node.offsetParent && node.getBoundingClientRect().height < 36).map((n) => n.textContent)}));
  assert.ok(width <= 390, `${width} px wide`);
  assert.equal(stage_px, 390, 'panels lie over the stage');
  assert.deepEqual(small, []);
  await page.getByRole('button', {name: 'Panels'}).tap();
  assert.ok(!await page.locator('#panels').isVisible());
  await until('pictures to be stopped', () => said('thumbnails').at(-1)?.on === false);
  assert.deepEqual(opened.troubles, []);
});

test('a lost server is reported, and found again within two seconds', async () => {
  const {port} = server;
  await server.stop();
  await until('the banner', () => page.locator('.banner').isVisible());
  assert.match(await text('.pill'), /not connected/);
  server = new MockServer();
  await server.start(port);
  const back = performance.now();
  await until('it to be back', () => page.evaluate(() => window.mareyPage.connected));
  assert.ok(performance.now() - back < 2000);
  await until('frames', () => said('shown').length > 0);
  assert.ok(!await page.locator('.banner').isVisible());
  assert.equal(await page.evaluate(() => window.mareyPage.stage.bodies.length), 2);
});

test('a server that stops answering is left, and connected again', async () => {
  server.silent = true;
  await until('another line', () => said('hello').length > 1, 9000);
});

test('a skin that cannot be read is reported, and the bones are shown', async () => {
  server.media.set('/media/1', Buffer.from('no model at all'));
  await page.reload();
  await until('the message', async () => /skin of mannequin/.test(await text('.messages')));
  await until('its bones', () => page.evaluate(() =>
    window.mareyPage.stage.bodies[1].present && !window.mareyPage.stage.bodies[1].dressed));
});

const real = `${DATA}/avatars/makehuman/adult_male_mixamo_unity.glb`;
test('a real avatar’s skin follows, too', {skip: !existsSync(real) &&
  'the avatars next to the checkout are missing'}, async () => {
  await opened.close();
  await server.stop();
  server = new MockServer({avatar: realAvatar(real)});
  opened = await openPage(browser, await server.start());
  ({page} = opened);
  await until('the skin', async () => (await offSkin()) !== null);
  assert.ok(await offSkin() < 1e-3);
  assert.deepEqual(opened.troubles, []);
});
