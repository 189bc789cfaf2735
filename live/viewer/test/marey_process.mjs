// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Runs marey for tests of its page, and waits for what it does.

import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';

const {MAREY_PROGRAM} = process.env;
const running = [];

/** Starts marey with a page and returns its address and its process. */
export async function serve(...words) {
  const marey = spawn(MAREY_PROGRAM, [...words, '--port', '0', '--no-open'],
    {stdio: ['ignore', 'pipe', 'inherit']});
  running.push(marey);
  for await (const bytes of marey.stdout) {
    const [address] = /http:\S+/.exec(String(bytes)) ?? [];
    if (address) {
      marey.stdout.resume();
      return {address, marey};
    }
  }
  throw new Error('marey printed no address');
}

/** Ends a process that serve() started; `signal` as SIGINT or SIGKILL. */
export async function end(marey, signal = 'SIGINT') {
  if (marey.exitCode !== null || marey.signalCode !== null) return;
  const ended = new Promise((done) => marey.once('exit', done));
  marey.kill(signal);
  await ended;
}

export async function end_all() {
  await Promise.all(running.map((marey) => end(marey)));
}

/** Waits until `holds` returns true. */
export async function until(what, holds, limit_ms = 25000) {
  const limit = performance.now() + limit_ms;
  while (!(await holds())) {
    assert.ok(performance.now() < limit, `this did not happen: ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

/** Distance of two places. [m] */
export const apart = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));

/** Returns the drawn position of a body's joint, without the body's offset in the row. [m] */
export const joint = (page, body, bone) => page.evaluate(([which, name]) => {
  const {pose, words} = window.mareyPage.stage.bodies[which];
  const i = words.joints.findIndex((one) => one.bone === name);
  return [...pose.p_in_world.slice(3 * i, 3 * i + 3)];
}, [body, bone]);

/** Returns the position of a handle on the page. [px] */
export const handle_at = (page, id) => page.evaluate((name) => {
  const {left, top} = document.querySelector('.stage canvas').getBoundingClientRect();
  const [x, y] = window.mareyPage.stage.pixelOfHandle(name);
  return [x + left, y + top];
}, id);

/** Drags a handle by this many pixels. */
export async function drag(page, id, by_x, by_y) {
  const [x, y] = await handle_at(page, id);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + by_x, y + by_y, {steps: 6});
  await page.mouse.up();
}
