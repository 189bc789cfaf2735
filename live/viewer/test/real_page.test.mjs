// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page that marey serves: `marey view` on results, opened from their report,
// and `marey live` on a replayed trial. Each user action is tested once.

import assert from 'node:assert/strict';
import {cpSync, existsSync, mkdtempSync, readdirSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {openBrowser, openPage} from './browser.mjs';
import {apart, drag, end_all, joint, serve, until} from './marey_process.mjs';

const {MAREY_RESULTS, MAREY_SESSION} = process.env;

let browser;
let folder;
before(async () => {
  browser = await openBrowser();
  folder = mkdtempSync(join(tmpdir(), 'marey-page-'));
  for (const name of ['calibration.toml', 'subject.toml', 'report.html', 'report.json', 'walk']) {
    cpSync(join(MAREY_RESULTS, name), join(folder, name), {recursive: true});
  }
  // A second trial to switch to.
  cpSync(join(folder, 'walk'), join(folder, 'walk again'), {recursive: true});
});
after(async () => {
  await end_all();
  await browser.close();
  rmSync(folder, {recursive: true});
});

const playback = (page) => page.evaluate(() => {
  const {frame, time, last, playing, speed, loop} = window.mareyPage.reel.playback;
  return {frame, time, last, playing, speed, loop};
});
const dressed = (page, bodies) => page.waitForFunction((many) =>
  window.mareyPage.stage.bodies.filter((body) => body.dressed).length === many, bodies);

test('results: opened from the report, played, scrubbed, dragged; another trial is opened',
  async () => {
    const {address} = await serve('view', folder);
    const bodies = readdirSync(join(folder, 'walk')).filter((name) => name.endsWith('.glb'));
    const {page, troubles, close} = await openPage(browser, address);

    await page.goto(`${address}report.html`);
    const link = page.locator('.page-link[href*="frame="]').first();
    const wanted = Number(new URL(await link.getAttribute('href'), address)
      .searchParams.get('frame'));
    await link.click();
    await page.waitForFunction(() => window.mareyPage?.stage.bodies.some(({present}) => present));
    await dressed(page, bodies.length);
    const first = await page.evaluate(() => window.mareyPage.scene.file.first_frame);
    assert.equal((await playback(page)).frame + first, wanted);

    await page.keyboard.press('Home');
    await page.keyboard.press(' ');
    await until('it to play', async () => (await playback(page)).frame > 2);
    await page.keyboard.press(' ');
    assert.ok(!(await playback(page)).playing);
    const strips = await page.locator('.strips').boundingBox();
    await page.mouse.click(strips.x + 0.6 * strips.width, strips.y + 25);
    const {frame, last} = await playback(page);
    assert.ok(frame > 0.3 * last && frame < 0.8 * last, `${frame} of ${last}`);
    await page.locator('select[aria-label="Speed"]').selectOption('2');
    await page.keyboard.press('l');
    await page.keyboard.press('End');
    await page.keyboard.press(' ');
    await until('it to start again', async () => {
      const now = await playback(page);
      return now.speed === 2 && now.loop && now.playing && now.frame < 0.5 * last;
    });
    await page.keyboard.press(' ');

    const before_drag = await joint(page, 0, 'leftHand');
    const foot = await joint(page, 0, 'leftFoot');
    await drag(page, 'left hand', 30, -40);
    await until('the hand to follow', async () =>
      apart(await joint(page, 0, 'leftHand'), before_drag) > 0.1);
    assert.ok(apart(await joint(page, 0, 'leftFoot'), foot) < 0.2, 'the feet stay by it');
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowLeft');
    await until('the recording as it was', async () =>
      apart(await joint(page, 0, 'leftHand'), before_drag) < 1e-3);

    await page.locator('.section-trials select').selectOption('walk again');
    await until('the other trial', async () =>
      (await page.locator('#bar h1').textContent()) === 'walk again');
    assert.match(page.url(), /trial=walk\+again/);
    await dressed(page, bodies.length);
    await page.reload();
    await until('it to stay', async () =>
      (await page.locator('#bar h1').textContent()) === 'walk again');
    assert.deepEqual(troubles, []);
    await close();
  });

test('live: a walking body shows its balance and steps; its avatar is dragged and released',
  {timeout: 60000}, async () => {
  const body = join(folder, 'walk', readdirSync(join(folder, 'walk'))
    .find((name) => name.endsWith('.glb') && name !== 'motion.glb') ?? 'motion.glb');
  const {address} = await serve('live', MAREY_SESSION, '--results', folder, '--play', 'walk',
    '--loop', '--vmc-send-only', '--progress', 'none', '--avatar', body);
  const {page, troubles, close} = await openPage(browser, address);
  await until('a body that is tracked', async () =>
    /tracked/.test(await page.locator('.pill').textContent()));
  await dressed(page, 1);
  // In every picture, as only some frames of this walk have a foot on the floor.
  await page.waitForFunction(() => {
    const {skeletons} = window.mareyPage.reel.shown;
    return skeletons.every(({hasBalance}) => hasBalance) &&
      skeletons.some(({corners}) => corners >= 4);
  });
  await until('contacts and residuals of the past', () => page.evaluate(() => {
    const {contacts, graphs: [{curves: [residual]}], playback: {last}} = window.mareyPage.reel;
    const frames = [...Array(last + 1).keys()];
    return contacts.names.some((_, row) => frames.some((i) => contacts.source(row, i) === 1)) &&
      frames.some((i) => residual.at(i) > 0 && residual.at(i) < 10);
  }));
  const handle = () => page.evaluate(() => window.mareyPage.scene.skeletons[1] &&
    window.mareyPage.stage.handles.handles.find(({words}) => words.id === 'left hand').words);
  // Uses the projection of the page, as a walking body can move away from a position that
  // was computed before.
  const from = await joint(page, 1, 'leftHand');
  await page.evaluate(([x, y, z]) => {
    for (const phase of ['begin', 'move', 'end']) {
      window.mareyPage.drag('left hand', [x, y + 0.3, z], phase);
    }
  }, from);
  await until('the handle to be held', async () => (await handle()).active);
  const target = (await handle()).p_in_world;
  await until('the hand to be there', async () =>
    apart(await joint(page, 1, 'leftHand'), target) < 0.1);
  const summary = page.locator('.section-constraints summary');
  if (!await page.getByRole('checkbox', {name: 'left hand'}).isVisible()) await summary.click();
  await page.getByRole('checkbox', {name: 'left hand'}).uncheck();
  await until('it to be let go', async () => !(await handle()).active);
  await until('the hand to be its own again', async () =>
    apart(await joint(page, 1, 'leftHand'), target) > 0.15);
  assert.deepEqual(troubles, []);
  await close();
});
