// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page of `marey stage --live` on the sample scene of forty bodies.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {copyFileSync, mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {openBrowser, openPage} from './browser.mjs';
import {apart, drag, end, end_all, handle_at, joint, serve, until} from './marey_process.mjs';

const {MAREY_PROGRAM, MAREY_SCENES} = process.env;

let browser;
let folder;
before(async () => {
  browser = await openBrowser();
  folder = mkdtempSync(join(tmpdir(), 'marey-stage-'));
  copyFileSync(join(MAREY_SCENES, 'forty.toml'), join(folder, 'forty.toml'));
  execFileSync(MAREY_PROGRAM, ['base', 'build', join(MAREY_SCENES, 'clips/idle.bvh'), '--loops',
    'idle', '--out', join(folder, 'moves.marey')], {stdio: ['ignore', 'ignore', 'inherit']});
});
after(async () => {
  await end_all();
  await browser.close();
  rmSync(folder, {recursive: true});
});

const target = (page, id) => page.evaluate((name) => {
  const {words} = window.mareyPage.stage.handles.handles.find((one) => one.words.id === name);
  return {p: [...words.p_in_world], held: words.active};
}, id);

test('forty bodies reach for a dragged target; it returns; pause, restart, bad messages',
  {timeout: 120000}, async () => {
    const {address, marey} = await serve('stage', join(folder, 'forty.toml'), '--live');
    const {page, troubles, close} = await openPage(browser, address);
    assert.equal(await page.evaluate(() => window.mareyPage.stage.bodies.length), 40);
    // Distance of the wrist from the target of the first body. [m]
    const error = async () => apart(await joint(page, 0, 'leftHand'), (await target(page, 'left')).p);
    await until('the wrist to be at the moving target', async () => await error() < 0.05);

    const path = (await target(page, 'left')).p;
    const other = await joint(page, 39, 'leftHand');
    await drag(page, 'left', 0, -15);
    await until('the target to be held', async () => (await target(page, 'left')).held);
    const held = (await target(page, 'left')).p;
    assert.ok(apart(held, path) > 0.02, `it moved from ${path} to ${held}`);
    await until('the wrist to be at the target', async () => await error() < 0.002);
    assert.ok(apart((await target(page, 'left')).p, held) < 1e-6, 'the target stays');
    await until('the last body to follow in proportion', async () =>
      apart(await joint(page, 39, 'leftHand'), other) > 0.005);

    await until('the target to return to its path', async () => {
      await page.mouse.dblclick(...await handle_at(page, 'left'));
      return !(await target(page, 'left')).held;
    });
    await until('the path to continue', async () => {
      const {p, held: isHeld} = await target(page, 'left');
      return !isHeld && apart(p, held) > 0.02 && await error() < 0.05;
    });

    const clock = () => page.locator('.section-run .clock').textContent();
    await page.getByRole('button', {name: 'Pause scene'}).click();
    await until('the pause', async () => /paused/.test(await page.locator('.pill').textContent()));
    const time = await clock();
    await page.evaluate(() => window.mareyPage.connection.send({type: 'drag', id: 'none',
      p_in_world: [0, 0, 0], phase: 'move'}));
    await page.evaluate(() => window.mareyPage.connection.send({type: 'nothing'}));
    await until('the refusal', async () =>
      /unknown|no target/.test(await page.locator('.section-status').textContent()));
    assert.equal(await clock(), time, 'time stands still');
    await page.getByRole('button', {name: 'Restart'}).click();
    await until('the scene to play', async () => /runs/.test(await page.locator('.pill').textContent()));
    await until('a figure', async () =>
      /wrist_error leftHand0\.\d+ mm/.test(await page.locator('.section-run').textContent()));
    assert.deepEqual(troubles, []);
    await close();
    await end(marey);
    assert.equal(marey.exitCode, 0);
  });
