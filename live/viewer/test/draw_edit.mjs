// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// node test/draw_edit.mjs MOTION.npz FOLDER [JUMP.npz]: draws the pictures of docs/editing.md with
// the page of `marey edit`: edit-loop.png, edit-ghost.png, edit-hand.png and edit-trim.png, and
// edit-jump.png of a motion with a jump. MAREY_PROGRAM is marey; MAREY_WEB_ROOT is the folder
// served/ of a page, otherwise the one that marey has. The pictures in docs/images show the walk
// of the sample session (./run demo).

import {copyFileSync, mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {missing, openBrowser, openPage} from './browser.mjs';
import {end_all, handle_at, serve, until} from './marey_process.mjs';

const [motion, out, jump] = process.argv.slice(2);
const why = missing({built: false});
if (why || !motion || !out || !process.env.MAREY_PROGRAM) {
  console.error(why ?? 'usage: MAREY_PROGRAM=... node test/draw_edit.mjs MOTION.npz FOLDER [JUMP.npz]');
  process.exit(1);
}

const shown = (page, ops) => until('the result', () => page.evaluate((count) => {
  const {document: edit, output, stale} = window.mareyPage;
  return edit.ops.length === count && !edit.isBehind && !stale &&
    edit.rendered.outputs.includes(output);
}, ops));
/** Makes changes as tools of the page do. */
async function commit(page, ...ops) {
  const count = await page.evaluate(() => window.mareyPage.document.ops.length);
  await page.evaluate((list) => window.mareyPage.commit((now) =>
    list.map((op, i) => ({insert: now.length + i, op}))), ops);
  await shown(page, count + ops.length);
}
/** Waits for a picture of everything that was changed. */
async function drawn(page) {
  const count = await page.evaluate(() => {
    window.mareyPage.renew();
    return window.mareyPage.drawnCount;
  });
  await page.waitForFunction((before) => window.mareyPage.drawnCount > before &&
    !window.mareyPage.stale, count);
}
const seek = (page, share) => page.evaluate((part) => {
  const {mareyPage} = window;
  mareyPage.stopAt(Math.round(part * mareyPage.reel.playback.last));
}, share);
const fold = (page, ...names) => page.evaluate((list) => {
  for (const part of document.querySelectorAll('#panels details')) {
    if (list.includes(/section-(\w+)/.exec(part.className)?.[1])) part.open = false;
  }
}, names);

/** The page of a copy of the motion. */
async function open(browser, name, height, source = motion, width = 1100) {
  const file = join(folder, `${name}.npz`);
  copyFileSync(source, file);
  const {MAREY_WEB_ROOT} = process.env;
  const {address} = await serve('edit', file, '--page',
    ...(MAREY_WEB_ROOT ? ['--web-root', MAREY_WEB_ROOT] : []));
  const {page} = await openPage(browser, address, {viewport: {width, height},
    colorScheme: 'light', deviceScaleFactor: 1});
  await shown(page, 0);
  // Spheres of the uncertainties hide the feet.
  await page.getByLabel('Uncertainty').uncheck({force: true}).catch(() => {});
  return page;
}
const details = async (page) => {
  if (!await page.evaluate(() => window.mareyPage.timeline.element.offsetHeight > 150)) {
    await page.keyboard.press('d');
  }
};

/** The whole page: a trimmed and filtered walk, the loops found in it. */
async function drawLoop(browser) {
  const page = await open(browser, 'walk', 860);
  await commit(page, {do: 'cut@1', from_s: 0.2, to_s: 2.8}, {do: 'filter@1'});
  await fold(page, 'result', 'joints', 'view');
  await page.locator('.section-loops > summary').click();
  await page.getByRole('button', {name: 'Find loops'}).click();
  await page.locator('.section-loops .loops li').first().click();
  await details(page);
  await page.locator('.section-loops').evaluate((part) => part.scrollIntoView());
  await seek(page, 0.4);
  await drawn(page);
  await page.screenshot({path: join(out, 'edit-loop.png')});
}

/** A walk turned by 90 degrees in front of its source. */
async function drawGhost(browser) {
  const page = await open(browser, 'turn', 620);
  await commit(page, {do: 'path@1', turn_deg: 90});
  await seek(page, 0.75);
  await page.keyboard.press('f');
  await drawn(page);
  await page.locator('.stage').screenshot({path: join(out, 'edit-ghost.png')});
}

/** The left hand while it is dragged. */
async function drawHand(browser) {
  const page = await open(browser, 'hand', 620);
  await seek(page, 0.5);
  await drawn(page);
  const [x, y] = await handle_at(page, 'Left hand');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y - 150, {steps: 8});
  await page.waitForTimeout(1000);
  await drawn(page);
  await page.locator('.stage').screenshot({path: join(out, 'edit-hand.png')});
  await page.mouse.up();
}

/** The timeline while its start is dragged. */
async function drawTrim(browser) {
  const page = await open(browser, 'trim', 700);
  await details(page);
  await drawn(page);
  const [left, top, to] = await page.evaluate(() => {
    const {timeline} = window.mareyPage;
    const box = timeline.element.getBoundingClientRect();
    const x = (frame) => box.left + timeline.gutter + timeline.window.x(frame, timeline.plot);
    return [x(0), box.top + 10, x(24)];
  });
  await page.mouse.move(left, top);
  await page.mouse.down();
  await page.mouse.move(to, top, {steps: 8});
  await page.waitForTimeout(600);
  await drawn(page);
  await page.locator('#time').screenshot({path: join(out, 'edit-trim.png')});
  await page.mouse.up();
}

/** A higher jump of the thesis law: curves, and the lowest point in its search space. */
async function drawJump(browser) {
  const page = await open(browser, 'jump', 960, jump, 1200);
  await fold(page, 'ops', 'result', 'joints', 'path', 'loops', 'view');
  await commit(page, {do: 'jump@1', apex_by_m: 0.1, law: 'thesis'});
  await page.locator('.section-jump > summary').click();
  await page.waitForFunction(() => window.mareyPage.jump.words?.phases &&
    window.mareyPage.jump.space.width > 0);
  await page.locator('.section-jump').evaluate((part) => part.scrollIntoView());
  await page.evaluate(() => {
    const {mareyPage} = window;
    mareyPage.stopAt(Math.round(mareyPage.jump.words.phases.apex_s * mareyPage.output.rate_hz));
  });
  await drawn(page);
  await page.keyboard.press('2');
  await page.keyboard.press('f');
  await drawn(page);
  await page.screenshot({path: join(out, 'edit-jump.png')});
}

const folder = mkdtempSync(join(tmpdir(), 'marey-draw-'));
const browser = await openBrowser();
try {
  for (const draw of [drawLoop, drawGhost, drawHand, drawTrim]) await draw(browser);
  if (jump) await drawJump(browser);
} finally {
  await end_all();
  await browser.close();
  rmSync(folder, {recursive: true});
}
