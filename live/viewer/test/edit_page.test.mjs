// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page of `marey edit --page` on the walk of a session: each gesture becomes a line
// of the recipe, and the exported files have the bytes of the command line's.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {cpSync, mkdtempSync, readdirSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {openBrowser, openPage} from './browser.mjs';
import {apart, end, end_all, joint, serve, until} from './marey_process.mjs';

const {MAREY_PROGRAM, MAREY_RESULTS} = process.env;
/** Index of the edited body in the scene; the source is 0. */
const RESULT = 1;

let browser;
let folder;
let recipe;
before(async () => {
  browser = await openBrowser();
  folder = mkdtempSync(join(tmpdir(), 'marey-edit-'));
  cpSync(join(MAREY_RESULTS, 'walk', 'motion.npz'), join(folder, 'walk.npz'));
  recipe = join(folder, 'walk.edit.toml');
});
after(async () => {
  await end_all();
  await browser.close();
  rmSync(folder, {recursive: true});
});

const recipe_text = () => readFileSync(recipe, 'utf8');
const state = (page) => page.evaluate(() => {
  const {document: edit, output, reel: {playback}} = window.mareyPage;
  return {revision: edit.revision?.revision ?? 0, sha256: edit.revision?.sha256 ?? '',
    ops: edit.ops.map(({keys}) => keys), rendered: edit.rendered?.revision ?? 0,
    frames: output?.frames ?? 0, rate_hz: output?.rate_hz ?? 0, frame: playback.frame,
    last: playback.last};
});
/** Waits until the result of the newest revision is shown. */
const shown = (page) => until('the result of the newest revision', () => page.evaluate(() => {
  const {document: edit, output, reel: {playback}} = window.mareyPage;
  return !edit.isBehind && edit.rendered.outputs.includes(output) &&
    playback.last === output.frames - 1;
}));
/** Goes to a frame and waits until it is drawn. */
async function seek(page, frame) {
  const drawn = await page.evaluate((at) => {
    window.mareyPage.seek(at);
    return window.mareyPage.drawnCount;
  }, frame);
  await page.waitForFunction((count) => window.mareyPage.drawnCount > count &&
    !window.mareyPage.stale, drawn);
}
/** Makes a change as a tool of the page does. Returns whether it was made. */
const commit = (page, ...steps) => page.evaluate((list) =>
  window.mareyPage.commit(() => list), steps);

test('a motion gets a recipe; changes, undo and redo; two pages are in step', async () => {
  const {address, marey} = await serve('edit', join(folder, 'walk.npz'), '--page');
  const first = await openPage(browser, address);
  const second = await openPage(browser, address);
  await shown(first.page);
  assert.match(recipe_text(), /path = "walk\.npz"/);
  const opened = await state(first.page);
  assert.equal(opened.ops.length, 0);

  assert.ok(await commit(first.page, {insert: 0, op: {do: 'cut@1', from_s: 0.5, to_s: 2}}));
  await shown(first.page);
  await shown(second.page);
  const cut = await state(first.page);
  assert.equal(cut.frames, Math.round(1.5 * cut.rate_hz) + 1);
  assert.deepEqual(await state(second.page).then(({sha256}) => sha256), cut.sha256);
  assert.match(recipe_text(), /do = "cut@1"\nfrom_s = 0\.5\nto_s = 2/);

  await second.page.keyboard.press('Control+z');
  await until('it to be undone on both', async () =>
    (await state(first.page)).sha256 === opened.sha256);
  await first.page.locator('.redo').click();
  await until('it to be redone on both', async () =>
    (await state(second.page)).sha256 === cut.sha256);
  await shown(second.page);
  assert.equal((await state(second.page)).frames, cut.frames);
  assert.deepEqual([...first.troubles, ...second.troubles], []);
  await end(marey, 'SIGKILL');
  await first.close();
  await second.close();
});

test('a killed program loses no revision: undo works in the next run', async () => {
  const {address, marey} = await serve('edit', recipe, '--page');
  const {page, troubles, close} = await openPage(browser, address);
  await shown(page);
  const before_undo = await state(page);
  assert.equal(before_undo.ops.length, 1);
  await page.locator('.undo').click();
  await until('it to be undone', async () => (await state(page)).ops.length === 0);
  await page.locator('.redo').click();
  await until('it to be redone', async () => (await state(page)).sha256 === before_undo.sha256);
  assert.deepEqual(troubles, []);
  await end(marey);
  await close();
});

test('a change that the recipe refuses is told and changes nothing', async () => {
  const {address, marey} = await serve('edit', recipe, '--page');
  const {page, close} = await openPage(browser, address);
  await shown(page);
  const was = await state(page);
  assert.ok(!await commit(page, {insert: 0, op: {do: 'cut@1', from_second: 1}}));
  await until('a notice', async () => /from_s/.test(await page.locator('.notice').textContent()));
  assert.equal((await state(page)).revision, was.revision);
  await end(marey);
  await close();
});

test('a preview shows a change in the scene without making it', async () => {
  const {address, marey} = await serve('edit', recipe, '--page');
  const {page, troubles, close} = await openPage(browser, address);
  await shown(page);
  const was = await state(page);
  await seek(page, 20);
  const hand = await joint(page, RESULT, 'leftHand');
  await page.evaluate(() => window.mareyPage.preview((ops) => [{insert: ops.length, op: {
    do: 'pose@1', at_frame: 20, bone: 'leftHand', moved_m: [0, 0.15, 0]}}]));
  await until('the hand to rise', async () =>
    apart(await joint(page, RESULT, 'leftHand'), hand) > 0.1);
  assert.equal((await state(page)).revision, was.revision);
  await page.evaluate(() => window.mareyPage.cancel());
  await until('the hand to be back', async () =>
    apart(await joint(page, RESULT, 'leftHand'), hand) < 1e-3);
  assert.deepEqual(troubles, []);
  await end(marey);
  await close();
});

test('exported files have the bytes of the command line', async () => {
  const [by_page, by_command] = [join(folder, 'page'), join(folder, 'command')];
  const {address, marey} = await serve('edit', recipe, '--page', '--out', by_page);
  const {page, troubles, close} = await openPage(browser, address);
  await shown(page);
  assert.ok(await commit(page, {insert: 1, op: {do: 'filter@1'}}));
  await shown(page);
  await page.locator('.export').click();
  await until('the files', async () =>
    /Written: .*walk\.npz/.test(await page.locator('.section-result').textContent()));
  execFileSync(MAREY_PROGRAM, ['edit', recipe, '--out', by_command], {stdio: 'ignore'});
  const names = readdirSync(by_command).sort();
  assert.deepEqual(readdirSync(by_page).sort(), names);
  assert.ok(names.includes('walk.npz') && names.includes('walk.edit.json'));
  for (const name of names) {
    assert.ok(readFileSync(join(by_page, name)).equals(readFileSync(join(by_command, name))),
      `${name} differs`);
  }
  assert.deepEqual(troubles, []);
  await end(marey);
  await close();
});
