// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page of `marey edit --page` on the walk of a session: each gesture becomes a line
// of the recipe, and the exported files have the bytes of the command line's.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {
  cpSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync,
} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {openBrowser, openPage} from './browser.mjs';
import {
  apart, drag, end, end_all, handle_at, joint, serve, until,
} from './marey_process.mjs';

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
  return !edit.isBehind && edit.rendered.outputs.includes(output) && !window.mareyPage.stale &&
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

test('a change that the recipe refuses is reported and changes nothing', async () => {
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

test('the panel states why a motion has no jump, and the recipe stays', async () => {
  const {address, marey} = await serve('edit', recipe, '--page');
  const {page, troubles, close} = await openPage(browser, address);
  await shown(page);
  const was = await state(page);
  await page.evaluate(() => { document.querySelector('.section-jump').open = true; });
  await page.getByRole('button', {name: 'Find jumps'}).click();
  await until('the reason', async () =>
    /bears the body/.test(await page.locator('.section-jump').innerText()));
  assert.equal((await state(page)).revision, was.revision);
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

/** Returns the place of a frame in a row of the timeline. [px] */
const place_at = (page, kind, row, frame) => page.evaluate(([of_kind, at_row, at_frame]) => {
  const {timeline} = window.mareyPage;
  const {left, top} = timeline.element.getBoundingClientRect();
  const band = of_kind === 'axis' ? {top: 0, height: 20} : timeline.bands.find((one) =>
    one.strip?.kind === of_kind && one.row === at_row);
  return [left + timeline.gutter + timeline.window.x(at_frame, timeline.plot),
    top + band.top + band.height / 2];
}, [kind, row, frame]);

/** Presses at one place, moves to another and releases. */
async function drag_from_to(page, [x, y], [to_x, to_y]) {
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(to_x, to_y, {steps: 8});
  await page.mouse.up();
}

/** Opens a page of an empty recipe for the walk. */
async function open_empty(name) {
  const file = join(folder, `${name}.npz`);
  cpSync(join(folder, 'walk.npz'), file);
  const {address, marey} = await serve('edit', file, '--page');
  const opened = await openPage(browser, address, {viewport: {width: 1200, height: 900}});
  await shown(opened.page);
  if (!await opened.page.evaluate(() => window.mareyPage.timeline.element.offsetHeight > 200)) {
    await opened.page.keyboard.press('d');
  }
  return {...opened, marey, recipe: () => readFileSync(join(folder, `${name}.edit.toml`), 'utf8')};
}
/** Waits until the recipe has this many operations and their result is shown. */
async function has_ops(page, count) {
  await until(`${count} operations`, async () => (await state(page)).ops.length === count);
  await shown(page);
}

test('trim handles, contact edges and brushed spans of the timeline write operations', async () => {
  const {page, troubles, close, marey, recipe: text} = await open_empty('time');
  const {last, rate_hz} = await state(page);

  await drag_from_to(page, await place_at(page, 'axis', 0, 0), await place_at(page, 'axis', 0, 12));
  await has_ops(page, 1);
  const {ops: [cut], frames} = await state(page);
  assert.equal(cut.do, 'cut@1');
  assert.ok(Math.abs(frames - (last - 11)) <= 2, `${frames} of ${last + 1}`);
  await drag_from_to(page, await place_at(page, 'axis', 0, frames - 1),
    await place_at(page, 'axis', 0, frames - 11));
  await until('a shorter motion', async () => (await state(page)).frames < frames - 7);
  assert.equal((await state(page)).ops.length, 1, 'the same cut is changed');
  await shown(page);

  const span = () => page.evaluate(() => window.mareyPage.output.contacts[2].spans.find(
    ([first, end]) => first > 3 && end < window.mareyPage.output.frames - 4));
  const [first] = await span();
  await drag_from_to(page, await place_at(page, 'contacts', 2, first - 0.5),
    await place_at(page, 'contacts', 2, first - 0.5 + 3));
  await has_ops(page, 2);
  const {ops: [, contacts]} = await state(page);
  assert.equal(contacts.do, 'contacts@1');
  assert.equal(contacts.edits.length, 1);
  assert.equal(contacts.edits[0].do, 'move_start');
  assert.ok(Math.abs((contacts.edits[0].to_s - contacts.edits[0].from_s) * rate_hz - 3) <= 1);
  assert.ok((await span())[0] > first, 'the contact starts later');

  await page.keyboard.down('Shift');
  await drag_from_to(page, await place_at(page, 'axis', 0, 5), await place_at(page, 'axis', 0, 25));
  await page.keyboard.up('Shift');
  await page.locator('.span-menu').getByText('Filter').click();
  await has_ops(page, 3);
  assert.equal((await state(page)).ops[2].do, 'filter@1');
  assert.match(text(), /do = "filter@1"/);
  assert.deepEqual(troubles, []);
  await end(marey);
  await close();
});

test('the list of operations adds, changes, switches off, moves and removes', async () => {
  const {page, troubles, close, marey} = await open_empty('list');
  const {frames} = await state(page);
  const add = async (name) => {
    await page.getByRole('button', {name: 'Add operation'}).click();
    await page.locator(`[data-op=${name}]`).click();
  };
  await add('retime');
  await has_ops(page, 1);
  const retime = (await state(page)).ops[0];
  assert.equal(retime.do, 'retime@1');
  const field = page.getByLabel(/duration/i).first();
  await field.fill('4');
  await field.press('Enter');
  await until('4 s', async () => (await state(page)).ops[0].duration_s === 4);
  await shown(page);
  assert.ok((await state(page)).frames > frames);
  await page.locator('.op-on').first().uncheck();
  await until('the motion as before', async () => (await state(page)).frames === frames);
  await page.locator('.op-on').first().check();
  await add('mirror');
  await has_ops(page, 2);
  await page.locator('.op-open').nth(1).focus();
  await page.keyboard.press('Alt+ArrowUp');
  await until('the other order', async () => (await state(page)).ops[0].do === 'mirror@1');
  await page.locator('.op-open').first().focus();
  await page.keyboard.press('Delete');
  await until('one operation', async () => (await state(page)).ops.length === 1);
  assert.equal((await state(page)).ops[0].do, 'retime@1');
  assert.deepEqual(troubles, []);
  await end(marey);
  await close();
});

test('a dragged hand makes a key, a dragged point a path, a click in the map a loop', async () => {
  const {page, troubles, close, marey} = await open_empty('space');
  await seek(page, 30);
  const hand = await joint(page, RESULT, 'leftHand');
  const [x, y] = await handle_at(page, 'Left hand');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 20, y - 60, {steps: 6});
  await until('the hand to follow', async () =>
    apart(await joint(page, RESULT, 'leftHand'), hand) > 0.05);
  await page.keyboard.press('Escape');
  await page.mouse.up();
  await until('the hand to be back', async () =>
    apart(await joint(page, RESULT, 'leftHand'), hand) < 1e-3);
  assert.equal((await state(page)).ops.length, 0, 'Escape makes no key');
  await drag(page, 'Left hand', 20, -60);
  await has_ops(page, 1);
  const [key] = (await state(page)).ops;
  assert.equal(key.do, 'pose@1');
  assert.equal(key.bone, 'leftHand');
  await seek(page, 30);
  const moved = await joint(page, RESULT, 'leftHand');
  assert.ok(apart(moved, hand.map((x, k) => x + key.moved_m[k])) < 0.02, 'the hand is there');
  await drag(page, 'Left hand', -10, 20);
  await until('the same key to change', async () =>
    JSON.stringify((await state(page)).ops[0].moved_m) !== JSON.stringify(key.moved_m));
  assert.equal((await state(page)).ops.length, 1);
  await shown(page);

  await page.locator('.section-path summary').first().click();
  await page.getByRole('button', {name: 'Turn 90° left'}).click();
  await has_ops(page, 2);
  assert.equal((await state(page)).ops[1].turn_deg, 90);
  await page.locator('.undo').click();
  await has_ops(page, 1);

  await page.locator('.section-loops > summary').click();
  await page.getByRole('button', {name: 'Find loops'}).click();
  await page.locator('.section-loops .loops li').first().click();
  await page.getByRole('button', {name: 'Loop here'}).click();
  await has_ops(page, 2);
  assert.equal((await state(page)).ops[1].do, 'cyclify@1');
  assert.deepEqual(troubles, []);
  await end(marey);
  await close();
});

test('Escape gives a drag up; a given-up preview is not shown', async () => {
  const {page, troubles, close, marey} = await open_empty('escape');
  assert.ok(await commit(page, {insert: 0, op: {do: 'filter@1'}}));
  await shown(page);
  await seek(page, 30);
  const [x, y] = await handle_at(page, 'Left hand');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 10, y - 30, {steps: 4});
  await page.keyboard.press('Escape');
  await page.mouse.up();
  // The motion before the filter; the answer to the preview arrives after its end.
  await page.evaluate(() => window.mareyPage.lookAt(0));
  await until('the source', () => page.evaluate(() => window.mareyPage.parts.until === 0));
  await seek(page, 20);
  const hand = await joint(page, RESULT, 'leftHand');
  await page.evaluate(() => {
    window.mareyPage.preview(() => [{insert: 0, op: {do: 'pose@1', at_frame: 20,
      bone: 'leftHand', moved_m: [0, 0.15, 0]}}]);
    setTimeout(() => window.mareyPage.cancel(), 0);
  });
  await until('all answers', () => page.evaluate(() =>
    window.mareyPage.document.waiting.size === 0 && !window.mareyPage.stale));
  await seek(page, 20);
  assert.ok(apart(await joint(page, RESULT, 'leftHand'), hand) < 1e-6);
  assert.equal((await state(page)).ops.length, 1);
  assert.deepEqual(troubles, []);
  await end(marey);
  await close();
});

test('a recipe that fails when it is opened is repaired on the page', async () => {
  const file = join(folder, 'broken.edit.toml');
  writeFileSync(file, 'format = 1\n[source]\npath = "walk.npz"\n[[op]]\ndo = "filter@1"\n' +
    '[[op]]\ndo = "cut@1"\nfrom_s = 100.0\nto_s = 101.0\n');
  const {address, marey} = await serve('edit', file, '--page');
  const {page, troubles, close} = await openPage(browser, address);
  await page.locator('.op-open').nth(1).focus();
  await page.keyboard.press('Delete');
  await has_ops(page, 1);
  assert.equal(await page.evaluate(() => window.mareyPage.until), null);

  // Another program changes the file: its change is kept, and that of the page refused.
  writeFileSync(file, `${readFileSync(file, 'utf8')}[[op]]\ndo = "mirror@1"\n`);
  assert.ok(!await commit(page, {remove: 0}));
  await has_ops(page, 2);
  assert.match(readFileSync(file, 'utf8'), /mirror@1/);
  assert.ok(await commit(page, {remove: 0}));
  await has_ops(page, 1);
  assert.deepEqual((await state(page)).ops, [{do: 'mirror@1'}]);
  writeFileSync(file, 'no recipe [');
  assert.ok(!await commit(page, {remove: 0}));
  assert.equal(readFileSync(file, 'utf8'), 'no recipe [');
  assert.deepEqual(troubles, []);
  await end(marey);
  await close();
});
