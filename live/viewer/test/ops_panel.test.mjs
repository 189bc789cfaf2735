// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The list of operations of the edit page: forms, order, changes by other pages.

import assert from 'node:assert/strict';
import {after, afterEach, before, beforeEach, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {openBrowser} from './browser.mjs';

const POSE = {do: 'pose@1', at_s: 1.2, bone: 'rightHand', moved_m: [0, 0.1, 0], width_s: 0.4};
const OPS = [{do: 'cut@1', from_s: 0.4, to_s: 3}, {do: 'filter@1'}, {do: 'plant@1'}, POSE,
  {do: 'path@1', turn_deg: 90}];

let browser;
let code;
let page;
let errors;
before(async () => {
  const {default: esbuild} = await import('esbuild');
  const built = await esbuild.build({write: false, bundle: true, format: 'iife',
    entryPoints: [fileURLToPath(new URL('ops_panel_page.ts', import.meta.url))]});
  code = built.outputFiles[0].text;
  browser = await openBrowser();
});
after(() => browser.close());
beforeEach(async () => {
  page = await browser.newPage();
  errors = [];
  page.on('pageerror', (error) => errors.push(error.message));
  await page.setContent('<!DOCTYPE html><body></body>');
  await page.addScriptTag({content: code});
  await page.evaluate((ops) => window.testPage.load(ops), OPS);
});
afterEach(async () => {
  await page.close();
  assert.deepEqual(errors, []);
});

const calls = () => page.evaluate(() => window.testPage.calls.splice(0));
const select = (index) => page.evaluate((i) => window.testPage.panel.select(i), index);
const selected = () => page.evaluate(() => window.testPage.panel.selected);
const patch = (steps) => page.evaluate((made) => window.testPage.patch(made), steps);
const titles = () => page.locator('.op-title').allInnerTexts();
const input = (key) => page.locator(`[data-key=${key}] input`).first();

test('typing previews, Enter commits once, Escape restores', async () => {
  await select(3);
  await input('width_s').fill('0.7');
  const step = {replace: 3, op: {...POSE, width_s: 0.7}};
  assert.deepEqual(await calls(), [['preview', [step]]]);
  await input('width_s').press('Enter');
  await input('width_s').blur();
  assert.deepEqual(await calls(), [['commit', [step]]]);
  await input('width_s').fill('0.9');
  await input('width_s').press('Escape');
  assert.deepEqual((await calls()).map(([name]) => name), ['preview', 'cancel']);
  assert.equal(await input('width_s').inputValue(), '0.7');
});

test('a held arrow key previews each step and commits once', async () => {
  await select(3);
  await input('width_s').focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.down('ArrowUp');
  const steps = await calls();
  assert.deepEqual(steps.map(([name]) => name), ['preview', 'preview', 'preview']);
  await page.keyboard.up('ArrowUp');
  await input('width_s').blur();
  assert.deepEqual(await calls(), [['commit', steps[2][1]]]);
});

test('a wrong value is marked and not sent; a default value removes its key', async () => {
  await select(3);
  await input('width_s').fill('-1');
  await input('width_s').press('Enter');
  assert.deepEqual(await calls(), []);
  assert.match(await page.locator('[data-key=width_s] .field-error').innerText(), /less/i);
  assert.equal(await input('width_s').getAttribute('aria-invalid'), 'true');
  await input('width_s').fill('0.5');
  await input('width_s').press('Enter');
  const {width_s: _, ...rest} = POSE;
  assert.deepEqual((await calls()).at(-1), ['commit', [{replace: 3, op: rest}]]);
});

test('the form keeps its focus and text while other pages change the recipe', async () => {
  await select(3);
  await input('width_s').fill('0.7');
  await patch([{insert: 0, op: {do: 'mirror@1'}}, {move: 5, to: 1}]);
  assert.equal(await selected(), 5);
  await patch([{replace: 5, op: {...POSE, at_s: 2}}]);
  assert.equal(await input('width_s').inputValue(), '0.7');
  assert.equal(await input('width_s').evaluate((one) => one === document.activeElement), true);
  await calls();
  await input('width_s').press('Enter');
  // The other page's value of another key stays.
  assert.deepEqual(await calls(),
    [['commit', [{replace: 5, op: {...POSE, at_s: 2, width_s: 0.7}}]]]);
  await patch([{remove: 5}]);
  assert.equal(await selected(), null);
});

test('the order is changed by dragging and by keys', async () => {
  const grip = (i) => page.locator('.op-grip').nth(i).boundingBox();
  const [from, to] = [await grip(1), await grip(3)];
  await page.mouse.move(from.x + 2, from.y + 4);
  await page.mouse.down();
  const row = await page.locator('.op').nth(3).boundingBox();
  await page.mouse.move(to.x + 2, row.y + row.height - 1, {steps: 5});
  await page.mouse.up();
  const made = await calls();
  assert.equal(made.filter(([name]) => name === 'commit').length, 1);
  assert.deepEqual(made.at(-1), ['commit', [{move: 1, to: 3}]]);
  await page.locator('.op-open').nth(3).focus();
  await page.keyboard.press('Alt+ArrowUp');
  await page.keyboard.press('Alt+ArrowUp');
  assert.deepEqual(await titles(), ['Cut', 'Filter', 'Plant feet', 'Pose key', 'Path']);
  await page.keyboard.press('Delete');
  assert.deepEqual(await titles(), ['Cut', 'Plant feet', 'Pose key', 'Path']);
});

test('an added operation is opened, and valid', async () => {
  await page.getByRole('button', {name: 'Add operation'}).click();
  await page.locator('[data-op=event]').click();
  assert.deepEqual(await calls(),
    [['commit', [{insert: 5, op: {do: 'event@1', text: 'event', at_s: 0.75}}]]]);
  assert.equal(await selected(), 5);
  assert.equal(await page.locator('.op.selected .wrong').count(), 0);
  assert.equal(await page.locator('[data-op=splice]').getAttribute('aria-disabled'), 'true');
});

test('failures and findings are shown at their operations', async () => {
  await page.evaluate(() => {
    const {panel} = window.testPage;
    panel.setProgress({type: 'progress', revision: 1, done: 1, total: 5, state: 'failed', op: 4,
      error: 'path: the motion stays in place.'});
    panel.setRendered({revision: 1, scene: 1, until: 4, outputs: [], findings: [], reports: [
      {op: 2, do: 'plant@1', figures: {slide_after_mm: 0.42}, findings: [{severity: 'fair',
        id: 'x', text: 'a leg is too short', next: 'raise the hips', value: null, limit: null,
        unit: ''}]}]});
  });
  assert.match(await page.locator('.op').nth(4).innerText(), /stays in place/);
  assert.match(await page.locator('.op').nth(2).innerText(), /slide\safter\s0.42\smm/);
  assert.match(await page.locator('.op').nth(2).innerText(), /A leg is too short\s*Raise the hips/);
});

test('a change of one of 2000 operations rewrites only its row', async () => {
  const changed = await page.evaluate(() => {
    const {testPage} = window;
    testPage.load(Array.from({length: 2000}, (_, i) =>
      ({do: 'event@1', text: `step ${i}`, at_s: i / 100})));
    const observer = new MutationObserver(() => {});
    observer.observe(document.querySelector('.ops'),
      {subtree: true, childList: true, characterData: true});
    testPage.patch([{replace: 1000, op: {do: 'event@1', text: 'other', at_s: 1}}]);
    const rows = observer.takeRecords().map(({target}) => (target.parentElement ?? target)
      .closest('.op'));
    const all = [...document.querySelectorAll('.op')];
    return [...new Set(rows)].map((row) => all.indexOf(row));
  });
  assert.deepEqual(changed, [1000]);
});
