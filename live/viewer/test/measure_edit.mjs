// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// npm run measure:edit -- MOTION.npz [SECONDS]: measures the time from an event on the page of
// `marey edit` to the picture of its change. MAREY_PROGRAM is marey; MOTION is a walk, of which
// a motion of SECONDS (60) at 120 Hz is made. Its recipe is cut, filter, plant. Renders in
// software, so the same is also measured without drawing: events, messages, marey and decoding.
// The processor times depend little on other work of the machine.

import {execFileSync} from 'node:child_process';
import {copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {loadavg, tmpdir} from 'node:os';
import {join} from 'node:path';
import {missing, openBrowser, openPage} from './browser.mjs';
import {end_all, handle_at, serve, until} from './marey_process.mjs';

const {MAREY_PROGRAM} = process.env;
const MOVES = 100;
const RATE_HZ = 120;
const DURATION_S = Number(process.argv[3] ?? 60);
/** Time between two moves: a pointer of 60 Hz. */
const STEP_MS = 16;

const percentile = (values, share) => [...values].sort((a, b) => a - b)[
  Math.min(values.length - 1, Math.floor(share * values.length))];
const words = (values) => (values.length === 0 ? 'nothing'
  : `p50 ${percentile(values, 0.5).toFixed(0)}, ` +
  `p95 ${percentile(values, 0.95).toFixed(0)}, worst ${percentile(values, 1).toFixed(0)} ms`);

/** Makes the long motion and returns its file. */
function longMotion(folder, motion) {
  copyFileSync(motion, join(folder, 'walk.npz'));
  writeFileSync(join(folder, 'make.edit.toml'), `format = 1
name = "long"
[source]
path = "walk.npz"
[[op]]
do = "cyclify@1"
cycles = 60
[[op]]
do = "retime@1"
rate_hz = ${RATE_HZ}
[[op]]
do = "cut@1"
from_s = 0
to_s = ${DURATION_S}
`);
  execFileSync(MAREY_PROGRAM, ['edit', join(folder, 'make.edit.toml'), '--out', folder,
    '--format', 'npz'], {stdio: 'inherit'});
  return join(folder, 'long.npz');
}

/** Waits until the result of the newest revision with `ops` operations is shown. */
const shown = (page, ops) => until('the result', () => page.evaluate((count) => {
  const {document: edit, output, stale} = window.mareyPage;
  return edit.ops.length === count && !edit.isBehind && !stale &&
    edit.rendered.outputs.includes(output);
}, ops), 60000);

/** Records in the page, for each change: its event, the sending of the newest one, the answer,
 *  the decoded frames, the picture. */
const hook = (page) => page.evaluate(() => {
  const {mareyPage} = window;
  const {document: edit, reel} = mareyPage;
  const log = window.editLog = {moves: [], sent: [], bytes: [], wait: false};
  let event_ms = 0;
  let answered = null;
  let decoded = null;
  for (const type of ['pointermove', 'input']) {
    window.addEventListener(type, ({timeStamp}) => { event_ms = timeStamp; }, true);
  }
  const {preview, onPreview, afterPicture} = mareyPage;
  mareyPage.preview = function(...words) {
    log.moves.push({event_ms});
    return preview.apply(this, words);
  };
  const {send} = edit;
  edit.send = (message) => {
    if (message.type === 'preview') {
      log.sent.push({last: log.moves.length - 1, sent_ms: performance.now()});
    }
    return send(message);
  };
  mareyPage.onPreview = function(parts, ...rest) {
    answered = log.sent[log.sent.length - 1];
    if (answered) answered.answer_ms = performance.now();
    log.message = JSON.stringify(parts).length;
    return onPreview.call(this, parts, ...rest);
  };
  const {setPreview} = reel;
  reel.setPreview = function(part) {
    if (part && answered) {
      decoded = answered;
      decoded.decoded_ms = performance.now();
      log.frames = part.block.frames;
    }
    return setPreview.call(this, part);
  };
  mareyPage.afterPicture = function() {
    afterPicture.call(this);
    if (!decoded) return;
    if (log.wait) mareyPage.stage.renderer.pixels();
    decoded.drawn_ms = performance.now();
    decoded = null;
  };
});

/** Processor time of a process, in steps of 10 ms. [ms] */
function process_ms(pid) {
  const parts = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return 10 * (Number(parts[11]) + Number(parts[12]));
}

/** Times of the changes that `act` makes; each change counts with the first picture of it, or
 *  of a newer one. */
async function measure({page, marey, client}, label, act) {
  const page_ms = async () => 1000 * (await client.send('Performance.getMetrics')).metrics
    .find(({name}) => name === 'TaskDuration').value;
  for (const draws of [true, false]) {
    await page.evaluate((on) => {
      const {stage: {renderer}} = window.mareyPage;
      Object.assign(window.editLog, {moves: [], sent: [], wait: on});
      window.ownRender ??= renderer.render;
      renderer.render = on ? window.ownRender : () => {};
    }, draws);
    const before = [process_ms(marey.pid), await page_ms()];
    await act();
    const used = [process_ms(marey.pid), await page_ms()].map((ms, k) => ms - before[k]);
    const {moves, sent, message, frames} = await page.evaluate(() => window.editLog);
    const done = sent.filter(({drawn_ms}) => drawn_ms);
    const ends = moves.map((move, i) => {
      const first = done.find(({last}) => last >= i);
      return first && {all: first.drawn_ms - move.event_ms};
    }).filter(Boolean);
    const [marey_ms, thread_ms] = used.map((ms) => (ms / Math.max(done.length, 1)).toFixed(1));
    const parts = (from, to) => words(done.map((one) => one[to] - one[from]));
    console.log(`${label}, ${draws ? 'drawn in software' : 'without drawing'}, ` +
      `load ${loadavg()[0].toFixed(1)}: ${moves.length} changes, ${done.length} pictures\n` +
      `  event to ${draws ? 'pixels' : 'decoded frames'}: ${words(ends.map(({all}) => all))}\n` +
      `  request to answer: ${parts('sent_ms', 'answer_ms')}\n` +
      `  fetch and decode: ${parts('answer_ms', 'decoded_ms')}\n` +
      `  processor time of marey, of the page's main thread: ${marey_ms}, ${thread_ms} ms\n` +
      `  size of an answer: ${message} bytes, ${frames} frames`);
  }
}

const pause = () => new Promise((done) => setTimeout(done, STEP_MS));
/** Presses at a place, moves MOVES times there and back, and gives up. */
async function dragAt(page, [x, y], [by_x, by_y]) {
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= MOVES; ++i) {
    const part = Math.sin(i / MOVES * 4 * Math.PI);
    await page.mouse.move(x + by_x * part, y + by_y * part);
    await pause();
  }
  await page.waitForTimeout(1500);
  await page.keyboard.press('Escape');
  await page.mouse.up();
  await page.evaluate(() => window.mareyPage.cancel());
}

/** Types MOVES values into a field of an operation, and gives up. */
async function typeInto(page, field) {
  for (let i = 0; i < MOVES; ++i) {
    await field.fill(String(10 + (i % 50) / 10));
    await pause();
  }
  await page.waitForTimeout(3000);
  await field.press('Escape');
}

/** The place of an edge of a contact of the left heel near the shown instant. */
const edge = (page) => page.evaluate(() => {
  const {timeline, output} = window.mareyPage;
  const [first] = output.contacts[0].spans.find(([start]) => start > timeline.window.from + 20);
  const {left, top} = timeline.element.getBoundingClientRect();
  const band = timeline.bands.find(({strip, row}) => strip?.kind === 'contacts' && row === 0);
  return [left + timeline.gutter + timeline.window.x(first - 0.5, timeline.plot),
    top + band.top + band.height / 2];
});

async function run(browser, file) {
  const {address, marey} = await serve('edit', file, '--page');
  const {page} = await openPage(browser, address, {viewport: {width: 1280, height: 800}});
  await shown(page, 0);
  await page.evaluate(() => window.mareyPage.commit(() => [
    {insert: 0, op: {do: 'cut@1', from_s: 0.5}},
    {insert: 1, op: {do: 'filter@1', method: 'butterworth', cutoff_hz: 12}},
    {insert: 2, op: {do: 'plant@1'}}]));
  await shown(page, 3);
  await page.evaluate(() => {
    const {mareyPage} = window;
    mareyPage.seek(Math.round(mareyPage.reel.playback.last / 2));
  });
  await page.waitForTimeout(1000);
  await hook(page);
  const client = await page.context().newCDPSession(page);
  await client.send('Performance.enable', {timeDomain: 'threadTicks'});
  const all = {page, marey, client};
  const {frames, rate_hz} = await page.evaluate(() => window.mareyPage.output);
  console.log(`${frames} frames at ${rate_hz} Hz; bar: p95 100 ms`);
  await measure(all, 'left hand in the scene', async () =>
    dragAt(page, await handle_at(page, 'Left hand'), [30, 60]));
  await page.locator('.op-open').nth(1).click();
  await measure(all, 'cut-off of the filter', () =>
    typeInto(page, page.locator('[data-key=cutoff_hz] input').first()));
  await page.locator('.op-open').nth(1).click();
  await page.evaluate(() => window.mareyPage.cancel());
  if (!await page.evaluate(() => window.mareyPage.timeline.element.offsetHeight > 200)) {
    await page.keyboard.press('d');
  }
  await page.evaluate(() => {
    const {timeline, reel: {playback}} = window.mareyPage;
    const {from, to} = timeline.window;
    timeline.window.zoom(200 / (to - from), playback.frame);
  });
  await page.waitForTimeout(500);
  await measure(all, 'edge of a contact', async () => dragAt(page, await edge(page), [40, 0]));
}

const why = missing({built: false});
const [motion] = process.argv.slice(2);
if (why || !motion || !MAREY_PROGRAM) {
  console.log(why ? `skipped: ${why}` :
    'usage: MAREY_PROGRAM=... npm run measure:edit -- MOTION.npz [SECONDS]');
  process.exit(why ? 0 : 1);
}
const folder = mkdtempSync(join(tmpdir(), 'marey-measure-'));
const browser = await openBrowser();
try {
  await run(browser, longMotion(folder, motion));
} finally {
  await end_all();
  await browser.close();
  rmSync(folder, {recursive: true});
}
