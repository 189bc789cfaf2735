// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The panel for jumps of the edit page: the list, the curves, the dragged lowest point.

import assert from 'node:assert/strict';
import {after, afterEach, before, beforeEach, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openBrowser} from './browser.mjs';
import {until} from './marey_process.mjs';

const JUMP = {do: 'jump@1', jump: 2, apex_by_m: 0.1, law: 'thesis'};

let browser;
let code;
let style;
let page;
let errors;
before(async () => {
  const {default: esbuild} = await import('esbuild');
  const bundle = async (file, format) => (await esbuild.build({write: false, bundle: true, format,
    entryPoints: [fileURLToPath(new URL(file, import.meta.url))]})).outputFiles[0].text;
  code = await bundle('jump_panel_page.ts', 'iife');
  style = await bundle('../src/styles/page.css');
  browser = await openBrowser();
});
after(() => browser.close());
beforeEach(async () => {
  page = await browser.newPage({viewport: {width: 400, height: 1200}});
  errors = [];
  page.on('pageerror', (error) => errors.push(error.message));
  await page.setContent('<!DOCTYPE html><body><div id="panels"></div></body>');
  // The panel is not scrolled.
  await page.addStyleTag({content: `${style} body { display: block; }
    #panels { height: auto; max-height: none; overflow: visible; }`});
  await page.addScriptTag({content: code});
});
afterEach(async () => {
  await page.close();
  assert.deepEqual(errors, []);
});

const calls = () => page.evaluate(() => window.testPage.calls.splice(0));
const load = (ops) => page.evaluate((made) => window.testPage.load(made), ops);
const shown = () => until('the curves', () => page.evaluate(() => {
  const {panel} = window.testPage;
  return !panel.isAsking && panel.words !== null && panel.curves.width > 0;
}));
const painted = () => page.evaluate(() => new Promise((done) => {
  requestAnimationFrame(() => requestAnimationFrame(done));
}));
/** The lowest point of the space, and its pixel on the page. */
const lowest = () => page.evaluate(() => {
  const {space} = window.testPage.panel;
  const {left, top} = space.canvas.getBoundingClientRect();
  const [x, y] = space.pixel(space.point);
  return {point: space.point, at: [left + x, top + y]};
});
/** A pixel of a canvas, as red, green, blue. */
const colourAt = (selector, x, y) => page.evaluate(([name, px, py]) => {
  const canvas = document.querySelector(name);
  const scale = canvas.width / canvas.clientWidth;
  return [...canvas.getContext('2d').getImageData(Math.round(px * scale), Math.round(py * scale),
    1, 1).data.slice(0, 3)];
}, [selector, x, y]);

test('jumps are listed without an operation; one is chosen and changed', async () => {
  await load([{do: 'filter@1'}]);
  assert.deepEqual(await calls(), [], 'no question is sent before the click');
  await page.getByRole('button', {name: 'Find jumps'}).click();
  await shown();
  assert.deepEqual(await calls(), [['jump', {op: 1, output: 0,
    ops_patch: [{insert: 1, op: {do: 'jump@1'}}]}]]);
  assert.match(await page.locator('.section-jump').innerText(), /3 jumps found/);
  assert.equal(await page.locator('.jumps li').count(), 3);
  assert.equal(await page.locator('.jumps .unusual').innerText(), '−12.2 m/s²');
  await page.locator('.jumps li').nth(1).getByRole('button').click();
  await until('the second jump', async () => (await page.locator('.jump-findings')
    .innerText()).includes('−12.2'));
  const [question, seek] = (await calls()).sort();
  assert.deepEqual(question[1].ops_patch, [{insert: 1, op: {do: 'jump@1', jump: 2}}]);
  assert.deepEqual(seek, ['seek', 3.42 * 120]);
  await page.getByRole('button', {name: 'Change this jump'}).click();
  await until('the operation', async () => (await page.locator('.section-jump').innerText())
    .includes('Operation 2 changes jump 2 of 3'));
  const made = await calls();
  assert.deepEqual(made[0], ['commit', [{insert: 1,
    op: {do: 'jump@1', apex_by_m: 0.1, jump: 2}}]]);
  assert.deepEqual(made.find(([name]) => name === 'select'), ['select', 1]);
});

test('a list entry changes the number of the operation', async () => {
  await load([JUMP]);
  await shown();
  assert.match(await page.locator('.section-jump summary').innerText(), /jump 2 of 3/);
  await calls();
  await page.locator('.jumps li').nth(0).getByRole('button').click();
  await until('the first jump', async () => (await page.locator('.section-jump summary')
    .innerText()).includes('jump 1 of 3'));
  const {jump: _, ...rest} = JUMP;
  assert.deepEqual(await calls(), [['commit', [{replace: 0, op: rest}]],
    ['jump', {op: 0, output: 0}]]);
});

test('the lowest point is dragged within the space: previews, then one change', async () => {
  await load([JUMP]);
  await shown();
  await painted();
  await calls();
  const {at: [x, y]} = await lowest();
  await page.mouse.move(x + 3, y - 2);
  await page.mouse.down();
  await page.mouse.move(x - 20, y + 10, {steps: 4});
  // Far outside: the point stays at the edge.
  await page.mouse.move(x - 25, y + 300, {steps: 4});
  const edge = (await lowest()).point;
  assert.match(await page.locator('.section-jump').innerText(), /deeper, the push would be neg/);
  await until('questions during the drag', () => page.evaluate(() =>
    !window.testPage.panel.isAsking));
  await page.mouse.up();
  await until('the end', () => page.evaluate(() => !window.testPage.panel.isAsking));
  const made = await calls();
  const names = made.map(([name]) => name);
  assert.equal(names.filter((name) => name === 'commit').length, 1);
  assert.ok(names.filter((name) => name === 'preview').length >= 4);
  assert.deepEqual(made.find(([name]) => name === 'commit')[1],
    [{replace: 0, op: {...JUMP, lowest: edge}}]);
  const drafts = made.filter(([name, asked]) => name === 'jump' && asked.ops_patch);
  assert.ok(drafts.length >= 1);
  assert.deepEqual(made.at(-1), ['jump', {op: 0, output: 0}]);
  await page.getByRole('button', {name: 'As captured'}).click();
  assert.deepEqual((await calls())[0], ['commit', [{replace: 0, op: JUMP}]]);
});

test('Escape gives a drag up, arrow keys move the point and commit once', async () => {
  await load([JUMP]);
  await shown();
  await painted();
  const {at: [x, y], point} = await lowest();
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 20, y, {steps: 3});
  await page.keyboard.press('Escape');
  await page.mouse.up();
  assert.deepEqual((await lowest()).point, point);
  const given_up = (await calls()).map(([name]) => name);
  assert.ok(given_up.includes('cancel') && !given_up.includes('commit'));
  await page.locator('.jump-space canvas').focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.down('ArrowLeft');
  await page.keyboard.up('ArrowLeft');
  await page.keyboard.press('Shift+ArrowUp');
  const commits = (await calls()).filter(([name]) => name === 'commit');
  assert.deepEqual(commits.map(([, [step]]) => step.op.lowest),
    [{at: 0.63, height_m: 0.77}, {at: 0.63, height_m: 0.771}]);
});

test('the force law has no space; a button changes the law', async () => {
  const {law: _, ...force} = JUMP;
  await load([force]);
  await shown();
  assert.ok(await page.locator('.jump-space').isHidden());
  await page.getByRole('button', {name: 'Set the lowest point by hand'}).click();
  await until('the space', () => page.locator('.jump-space').isVisible());
  assert.ok((await calls()).some(([name, steps]) => name === 'commit' &&
    steps[0].op.law === 'thesis'));
});

test('wishes that cannot be met are explained, and errors, too', async () => {
  await load([{...JUMP, apex_by_m: 1.2}]);
  await shown();
  assert.match(await page.locator('.section-jump .error').innerText(), /at most 0.62 m higher/);
  await page.evaluate(() => { window.testPage.answer = 'No time in which nothing bears the body.'; });
  await load([{...JUMP, apex_by_m: 0.3}]);
  await until('the reason', async () => (await page.locator('.section-jump').innerText())
    .includes('nothing bears the body'));
  assert.equal(await page.locator('.jumps').isVisible(), false);
  await calls();
  await page.evaluate(() => window.testPage.panel.update());
  assert.deepEqual(await calls(), [], 'a failed question is not repeated');
});

test('the cursor is linked to the timeline where the times are the same', async () => {
  await load([JUMP]);
  await shown();
  await painted();
  const cursor = page.locator('.jump-curves .now');
  await page.evaluate(() => window.testPage.panel.setTime(108));
  assert.ok(await cursor.isVisible());
  const before_x = (await cursor.boundingBox()).x;
  await page.evaluate(() => window.testPage.panel.setTime(180));
  assert.ok((await cursor.boundingBox()).x > before_x + 40);
  await page.evaluate(() => {
    window.testPage.view.until = 0;
    window.testPage.panel.setTime(108);
  });
  assert.ok(await cursor.isHidden(), 'the motion before the jump has other times');
  await page.evaluate(() => { window.testPage.view.until = null; });
  await calls();
  const box = await page.locator('.jump-curves canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + 50);
  const [[name, frame]] = await calls();
  assert.equal(name, 'seek');
  assert.ok(frame > 48 && frame < 300);
});

test('the edges of the space have the colours of their rules', async () => {
  await load([JUMP]);
  await shown();
  await painted();
  const edge = (at, k) => page.evaluate(([share, which]) => {
    const {space} = window.testPage.panel;
    const column = space.islands[0].reduce((a, b) =>
      (Math.abs(b[0] - share) < Math.abs(a[0] - share) ? b : a));
    return space.pixel({at: column[0], height_m: column[which]});
  }, [at, k]);
  const [force, fall, rise] = await Promise.all([edge(0.5, 1), edge(0.7, 1), edge(0.52, 2)]);
  const [orange, blue, purple] = await Promise.all([force, fall, rise].map(([x, y]) =>
    colourAt('.jump-space canvas', x, y)));
  assert.ok(orange[0] > 180 && orange[2] < 90, String(orange));
  assert.ok(blue[2] > 150 && blue[0] < 110, String(blue));
  assert.ok(purple[0] > 140 && purple[1] < 130, String(purple));
});
