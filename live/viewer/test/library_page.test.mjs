// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page of `marey view LIB`: list, filter, playback, corrections on the disk.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {openBrowser, openPage} from './browser.mjs';
import {end_all, serve, until} from './marey_process.mjs';

const CLIPS = 150; // More than a page of rows.

let browser;
let folder;
let opened;
let page;
const write = (count) => execFileSync(process.env.MAREY_LIBRARY_WRITER, [folder, String(count)]);
before(async () => {
  browser = await openBrowser();
  folder = mkdtempSync(join(tmpdir(), 'marey-library-'));
  write(CLIPS);
  const {address} = await serve('view', folder, ...(process.env.MAREY_WEB_ROOT
    ? ['--web-root', process.env.MAREY_WEB_ROOT] : []));
  opened = await openPage(browser, address, {viewport: {width: 1280, height: 720}});
  ({page} = opened);
});
after(async () => {
  assert.deepEqual(opened?.troubles, []);
  await end_all();
  await browser.close();
  rmSync(folder, {recursive: true});
});

const names = () => page.locator('.clip-row:not(.is-waiting) .clip-words > .clip-name')
  .allInnerTexts();
const chosen = () => page.evaluate(() => window.mareyPage.clip?.row.name ?? '');
const count = () => page.locator('.clip-count').innerText();
const time = () => page.evaluate(() => window.mareyPage.reel.playback.time);
const filter = (text) => page.locator('.clip-query').fill(text);

test('the list has all clips, and rows only where they are visible', async () => {
  await until('the list', async () => (await count()) === `${CLIPS} clips`);
  assert.ok((await names()).includes('walk_100'));
  assert.ok(await page.locator('.clip-row').count() < 30);
  await page.locator('.clip-list').evaluate((list) => { list.scrollTop = list.scrollHeight; });
  await until('the last rows', async () => (await names()).includes(`walk_${99 + CLIPS}`));
  await page.locator('.clip-list').evaluate((list) => { list.scrollTop = 0; });
  await until('the first rows', async () => (await names()).includes('walk_100'));
});

test('drawings appear in the rows', async () => {
  await until('a drawing', () => page.locator('.clip-poses').first().evaluate((canvas) =>
    canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data
      .filter((value, i) => i % 4 === 3 && value > 200).length > 100));
});

test('the filter takes the words of a query, and reports a wrong one with its place', async () => {
  await filter('label=stroll');
  await until('the strolls', async () => (await count()) === `100 of ${CLIPS} clips`);
  await filter('label=');
  await page.locator('.clip-query-error:visible').waitFor();
  assert.match(await page.locator('.clip-query-error').innerText(), /column/);
  assert.equal(await count(), `100 of ${CLIPS} clips`);
  await filter('');
  await until('all clips', async () => (await count()) === `${CLIPS} clips`);
  assert.ok(await page.locator('.clip-query-error').isHidden());
  const fails = page.locator('.clip-chip.verdict-fail');
  const expected = Number((await fails.innerText()).split(' ')[1]);
  await fails.click();
  await until('the failed clips', async () => (await count()) === `${expected} of ${CLIPS} clips`);
  await fails.click();
  await until('all clips', async () => (await count()) === `${CLIPS} clips`);
});

test('arrow keys choose a clip, which plays with its neighbours', async () => {
  await page.locator('.clip-row').first().click();
  await until('the first clip', async () => (await chosen()) === 'walk_100');
  await page.keyboard.press('ArrowDown');
  await until('the second clip', async () => (await chosen()) === 'walk_101');
  assert.equal(await page.evaluate(() => window.mareyPage.stage.bodies.length), 4);
  await until('it plays', async () => {
    const before = await time();
    await new Promise((done) => setTimeout(done, 200));
    return (await time()) !== before;
  });
  assert.equal(await page.locator('.neighbour').count(), 3);
  await page.locator('.section-clip-similar input').check();
  await until('mirrored neighbours', () => page.evaluate(() => window.mareyPage.clip.mirrored));
  await page.locator('.section-clip-similar input').uncheck();
  await until('neighbours', () => page.evaluate(() => !window.mareyPage.clip.mirrored));
});

test('a problem of the quality gate leads to its frame', async () => {
  await page.evaluate(() => window.mareyPage.reel.playback.pause());
  const problem = page.locator('.problem').first();
  const frame = Number(/(\d+)(?:–\d+)?$/.exec(await problem.innerText())[1]);
  await problem.click();
  await until('the frame', async () => (await time()) === frame);
});

test('a wrong verdict and a label become lines on the disk', async () => {
  const id = await page.evaluate(() => window.mareyPage.clip.row.clip_id);
  await page.locator('.figures .wrong').first().click();
  await page.locator('.correction-verdict input').nth(0).fill('looks right, to me');
  await page.locator('.correction-verdict input').nth(1).fill('Anna');
  await page.locator('.correction-verdict .primary').click();
  await page.locator('.correction-verdict.is-stored').waitFor();
  const lines = readFileSync(join(folder, 'labels', 'verdicts.csv'), 'utf8').trim().split('\n');
  assert.equal(lines.length, 2);
  assert.match(lines[1], new RegExp(`^${id},[a-z0-9_]+,.*,pass,Anna,"looks right, to me"$`));

  await page.locator('.add-label').click();
  await page.locator('.correction-label input[type=text]').first().fill('turn');
  await page.locator('.correction-label input[type=number]').nth(1).fill('0.5');
  await page.locator('.correction-label .primary').click();
  await page.locator('.correction-label.is-stored').waitFor();
  const labels = readFileSync(join(folder, 'labels', 'page.csv'), 'utf8').trim().split('\n');
  assert.equal(labels[1], `${id},0,0.5,turn,Anna,1`);
});

test('a new build is reported, and loaded on request', async () => {
  write(20);
  await page.locator('.reload').waitFor();
  assert.equal(await count(), `${CLIPS} clips`);
  await page.locator('.reload').click();
  await until('the new list', async () => (await count()) === '20 clips');
  assert.ok(await page.locator('.reload').isHidden());
});

test('a damaged index is reported', async () => {
  writeFileSync(join(folder, 'library.sqlite'), 'no database');
  await page.locator('.reload').click({timeout: 20000});
  await page.locator('.clip-empty:visible').waitFor();
  assert.match(await page.locator('.clip-empty').innerText(), /marey library build/);
});
