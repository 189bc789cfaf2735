// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A person is measured by `marey live`, whose page does the asking: the sample session's
// videos stand before the cameras. MAREY_PROGRAM is the program, MAREY_SAMPLE the session's
// folder, MAREY_RESULTS has its calibration and the body that marey process found.
// Prints "skipped:" if there is no browser.

import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {missing, openBrowser, openPage} from './browser.mjs';

const why = missing() ?? (existsSync(`${process.env.MAREY_RESULTS}/subject.toml`) ? null
  : 'the sample session has no results');
if (why) {
  console.log(`skipped: ${why}`);
  process.exit(0);
}

class StepNotReached extends Error {}

/** The sample's own trials, so slow that a busy machine keeps up. */
function makeSession(folder) {
  const session = readFileSync(`${process.env.MAREY_SAMPLE}/session.toml`, 'utf8');
  writeFileSync(`${folder}/session.toml`,
    session.replace(/^name = "(static|rom)"$/gm, '$&\nfps = 10.0'));
  for (const name of ['calibration.toml', 'subject.toml']) {
    copyFileSync(`${process.env.MAREY_RESULTS}/${name}`, `${folder}/${name}`);
  }
}

/** Resolves with the address that it prints. */
function startMarey(folder) {
  const marey = spawn(process.env.MAREY_PROGRAM, ['live', folder, '--results', folder,
    '--media', process.env.MAREY_SAMPLE, '--play', 'static', '--play', 'rom', '--loop',
    '--stand-s', '0.6', '--move-s', '60', '--wait-ms', '900']);
  let said = '';
  const address = new Promise((found, failed) => {
    const hear = (bytes) => {
      said += bytes;
      const at = /http:\S+/.exec(said);
      if (at) found(at[0]);
    };
    marey.stdout.on('data', hear);
    marey.stderr.on('data', hear);
    marey.on('exit', () => failed(new Error(said)));
  });
  const ended = new Promise((done) => { marey.on('exit', (code) => done({code, said})); });
  return {address, ended, stop: () => marey.kill('SIGINT')};
}

/** Lengths of limbs in centimetres. The length of a limb is the distance of the joint at its
 *  end. */
function limbsIn(file) {
  const ends = {leftLowerArm: 'left upper arm', leftHand: 'left lower arm',
    rightLowerArm: 'right upper arm', rightHand: 'right lower arm',
    leftLowerLeg: 'left upper leg', leftFoot: 'left lower leg',
    rightLowerLeg: 'right upper leg', rightFoot: 'right lower leg'};
  const text = readFileSync(file, 'utf8');
  return Object.fromEntries(Object.entries(ends).map(([joint, limb]) => [limb,
    100 * Number(new RegExp(`\\[joint\\.${joint}\\][^[]*\\[.*\\]\nlength_m = (\\S+)`)
      .exec(text)[1])]));
}

async function drive(page, folder) {
  const wizard = page.locator('.section-wizard');
  const press = (name) => wizard.getByRole('button', {name, exact: true})
    .click({timeout: 60_000});
  const title = async (words) => {
    try {
      await wizard.getByRole('heading', {name: words, exact: true}).waitFor({timeout: 100_000});
    } catch {
      throw new StepNotReached(`"${words}" is not reached; the page shows: ` +
        await wizard.textContent());
    }
  };
  const guidance = page.locator('.guidance');
  await wizard.locator('summary').click();
  assert.ok(!await guidance.isVisible());

  await press('Start');
  await title('Stand still');
  assert.match(await guidance.textContent(), /^Stand still/);
  await title('Move every joint');
  await press('Next');
  // The program rejects the request, and the page shows the reason next to the button.
  await wizard.getByText('move for at least five seconds').waitFor();
  await press('Cancel');
  await title('Measure a subject');
  assert.ok(!await guidance.isVisible(), 'what was cancelled is not asked for');

  await press('Start');
  await title('Move every joint');
  await wizard.getByText('cam0: ').waitFor();
  await page.waitForTimeout(20_000);  // With less movement, left and right can be ambiguous.
  assert.deepEqual((await wizard.locator('figcaption').allTextContents()).map((words) =>
    words.replace(/\d+ %, \d\.\d\d/, '')), ['cam0:  px', 'cam1:  px', 'cam2:  px', 'cam3:  px']);
  const painted = await wizard.locator('canvas').evaluateAll((grids) => grids.map((grid) =>
    grid.getContext('2d').getImageData(0, 0, 8, 6).data.filter((_, i) => i % 4 === 3)
      .filter((alpha) => alpha > 0).length));
  assert.ok(painted.every((cells) => cells >= 2 && cells < 40), `cells painted: ${painted}`);
  await goOn(page, press);

  await title('The body is measured');
  const rows = await wizard.locator('.quality li').evaluateAll((all) => all.map((row) =>
    [row.children[0].textContent, row.children[1].textContent, row.className]));
  assert.equal(rows.length, 11);
  for (const [name, value, look] of rows) {
    assert.match(value, look === 'poor' ? / ✗$/ : / ✓$/, name);
  }
  const poor = rows.filter(([, , look]) => look === 'poor').length;
  assert.equal(await wizard.locator('.verdict').textContent(),
    poor ? `${poor} of 11 are poor.` : 'All results are good.');
  const before = readFileSync(`${folder}/subject.toml`, 'utf8');
  await press(poor ? 'Accept anyway' : 'Accept');
  await title('Measured');

  const after = limbsIn(`${folder}/subject.toml`);
  for (const [name, value] of rows.slice(0, 8)) {
    assert.ok(Math.abs(after[name] - parseFloat(value)) < 0.051,
      `${name}: ${value} on the page, ${after[name]} in the file`);
  }
  assert.notEqual(readFileSync(`${folder}/subject.toml`, 'utf8'), before);
  assert.equal(readFileSync(`${folder}/subject.toml.before`, 'utf8'), before);
  // The subject is tracked with the new body.
  await page.locator('.pill', {hasText: 'tracked'}).waitFor();
}

/** Presses Next until five seconds of movement were seen; lost pictures do not count. */
async function goOn(page, press) {
  const end = performance.now() + 120_000;
  while (await page.locator('.section-wizard h3').textContent() === 'Move every joint') {
    assert.ok(performance.now() < end, 'Next had no effect');
    await press('Next').catch(() => {}); // The step ended without Next.
    await page.waitForTimeout(700);
  }
}

/** Runs the program and the page once, from a new session. */
async function measureOnce() {
  const folder = mkdtempSync(`${tmpdir()}/marey-wizard-`);
  makeSession(folder);
  const marey = startMarey(folder);
  const browser = await openBrowser();
  try {
    const {page, troubles} = await openPage(browser, await marey.address);
    await drive(page, folder);
    assert.deepEqual(troubles, []);
    marey.stop();
    const {code, said} = await marey.ended;
    assert.equal(code, 0, said);
  } finally {
    marey.stop();
    await browser.close();
    rmSync(folder, {recursive: true, force: true});
  }
}

// A run in real time loses pictures on a busy machine, and a fit of too few is refused. The
// second run must reach every step; a wrong result fails at once.
try {
  await measureOnce();
} catch (error) {
  if (!(error instanceof StepNotReached)) throw error;
  console.log(`first run: ${error.message}`);
  await measureOnce();
}
