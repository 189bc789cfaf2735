// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Playing, looking back, and the timeline's arithmetic.

import assert from 'node:assert/strict';
import test from 'node:test';
import {ABSENT, FrameRing} from '../src/timeline/frame_ring';
import {Playback} from '../src/timeline/playback';
import {clockWords, TimeWindow, tickStep_s} from '../src/timeline/time_window';
import {rangeOf} from '../src/timeline/graph';
import {layOut, sourceStrip} from '../src/timeline/timeline_paint';
import {BEARS, FileContacts, FileRows, RingContacts, RingResidual, RingRows}
  from '../src/timeline/timeline_rows';

const view = (frame: number): DataView => {
  const made = new DataView(new ArrayBuffer(4));
  made.setUint32(0, frame, true);
  return made;
};

function playback(last: number): Playback {
  const made = new Playback();
  made.setRange(0, last);
  return made;
}

test('playing takes as long as it was recorded, times the speed', () => {
  const film = playback(300);
  film.rate_hz = 30;
  film.speed = 0.5;
  film.play();
  for (let i = 0; i < 60; ++i) film.advance(1 / 60, false);
  assert.ok(Math.abs(film.time - 15) < 1e-9);
});

test('at the end it stops, or starts again; play at the end goes to the start', () => {
  const film = playback(10);
  film.seek(9.5);
  film.play();
  film.advance(1, false);
  assert.equal(film.time, 10);
  assert.equal(film.playing, false);
  film.play();
  assert.equal(film.time, 0);
  film.loop = true;
  film.advance(12 / 30, false);
  assert.ok(Math.abs(film.time - 2) < 1e-9);
  assert.ok(film.playing);
});

test('steps go to whole frames and stay within the recording', () => {
  const film = playback(10);
  film.seek(4.4);
  film.step(1);
  assert.equal(film.time, 5);
  film.step(-100);
  assert.equal(film.time, 0);
  film.step(100);
  assert.equal(film.time, 10);
});

test('live, the newest frame is shown until the user seeks; then the past stays', () => {
  const live = playback(0);
  live.follow();
  live.setRange(0, 50);
  assert.equal(live.time, 50);
  live.seek(20);
  live.setRange(0, 60);
  assert.equal(live.time, 20);
  live.setRange(30, 90);
  assert.equal(live.time, 30, 'dropped frames cannot be shown');
  live.play();
  live.advance(10, true);
  assert.ok(live.following, 'having caught up it follows');
});

test('the ring keeps the newest frames and counts on', () => {
  const ring = new FrameRing(3, 2);
  for (let i = 0; i < 5; ++i) ring.push(view(i), i === 4 ? null : new Uint8Array([i % 3, 1]));
  assert.deepEqual([ring.first, ring.last], [2, 4]);
  assert.equal(ring.at(1), null);
  assert.equal(ring.at(5), null);
  assert.equal(ring.at(3)!.getUint32(0, true), 3);
  assert.equal(ring.source(2, 0), 2);
  assert.equal(ring.source(4, 1), ABSENT);
});

test('rows of a ring have the runs that were not measured', () => {
  const ring = new FrameRing(100, 1);
  [0, 0, 1, 1, 2, 0, 0, 1].forEach((source, i) => ring.push(view(i), new Uint8Array([source])));
  const rows = new RingRows(['hips'], ring);
  const spans: number[][] = [];
  rows.spans(0, 0, 7, 1, (...span) => spans.push(span));
  assert.deepEqual(spans, [[2, 3, 1], [4, 4, 2], [7, 7, 1]]);
  assert.equal(rows.source(0, 200), ABSENT);
});

test('rows of a file have the visible gaps', () => {
  const rows = new FileRows({frames: 100, first_frame: 10, block: null, points_block: null,
    tracks: [{name: 'a', gaps: [[13, 18, 'repaired'], [60, 70, 'inferred']]}], contacts: [],
    graphs: [], notes: []});
  const spans: number[][] = [];
  rows.spans(0, 8, 40, 1, (...span) => spans.push(span));
  assert.deepEqual(spans, [[3, 8, 1]]);
  assert.equal(rows.source(0, 55), 2);
  assert.equal(rows.source(0, 9), 0);
});

test('contacts and the residual are kept as long as frames', () => {
  const ring = new FrameRing(4, 0);
  // Left heel; both balls; nothing; right ball; left heel.
  [1, 10, 0, 8, 1].forEach((bears, i) => ring.push(view(i), null, bears, i === 2 ? NaN : i / 4));
  const contacts = new RingContacts(ring);
  const spans = (row: number): number[][] => {
    const found: number[][] = [];
    contacts.spans(row, 0, 10, 1, (...span) => found.push(span));
    return found;
  };
  assert.deepEqual(spans(0), [[4, 4, BEARS]], 'the first frame is dropped');
  assert.deepEqual(spans(1), [[1, 1, BEARS]]);
  assert.deepEqual(spans(3), [[1, 1, BEARS], [3, 3, BEARS]]);
  assert.equal(contacts.source(3, 3), BEARS);
  assert.equal(contacts.source(0, 0), 0);
  const residual = new RingResidual(ring);
  assert.deepEqual([residual.first, residual.end], [1, 5]);
  assert.deepEqual([0, 1, 2, 3, 4, 5].map((i) => residual.at(i)),
    [null, 0.25, null, 0.75, 1, null]);
});

test('contacts of a file are counted from its first frame', () => {
  const contacts = new FileContacts({frames: 100, first_frame: 10, block: null,
    points_block: null, tracks: [], contacts: [{name: 'left heel', spans: [[12, 20]]}],
    graphs: [], notes: []});
  const spans: number[][] = [];
  contacts.spans(0, 0, 50, 1, (...span) => spans.push(span));
  assert.deepEqual(spans, [[2, 10, BEARS]]);
  assert.equal(contacts.source(0, 11), 0);
});

test('zooming keeps the frame under the pointer, and never leaves the recording', () => {
  const seen = new TimeWindow();
  seen.setRange(0, 1000);
  const before = seen.frame(250, 1000);
  seen.zoom(0.5, before);
  assert.ok(Math.abs(seen.x(before, 1000) - 250) < 1e-9);
  assert.ok(Math.abs(seen.to - seen.from - 500) < 1e-9);
  seen.pan(1e6);
  assert.deepEqual([seen.from, seen.to], [500, 1000]);
  for (let i = 0; i < 50; ++i) seen.zoom(0.5, 700);
  assert.ok(seen.to - seen.from >= 8);
  for (let i = 0; i < 50; ++i) seen.zoom(2, 700);
  assert.ok(seen.whole);
});

test('a window on all of it grows with it; a zoomed one stays', () => {
  const seen = new TimeWindow();
  seen.setRange(0, 100);
  seen.setRange(0, 200);
  assert.deepEqual([seen.from, seen.to], [0, 200]);
  seen.zoom(0.25, 100);
  const {from, to} = seen;
  seen.setRange(0, 210);
  assert.deepEqual([seen.from, seen.to], [from, to]);
  seen.setRange(150, 360);
  assert.equal(seen.from, 150, 'dropped frames cannot be visible');
  seen.reveal(300);
  assert.ok(seen.to >= 300);
});

test('axes have round steps and clocks carry over', () => {
  assert.equal(tickStep_s(0.03), 0.05);
  assert.equal(tickStep_s(0.5), 0.5);
  assert.equal(tickStep_s(7), 10);
  assert.equal(tickStep_s(12), 30);
  assert.equal(tickStep_s(45), 60);
  assert.equal(clockWords(59.999), '1:00.00');
  assert.equal(clockWords(-2.5, 1), '−0:02.5');
  assert.equal(clockWords(3725, 0), '1:02:05');
});

test('bands do not overlap, and folded there is one', () => {
  const summary = new RingRows(['a', 'b'], new FrameRing(1, 2));
  const data = {summary, strips: [sourceStrip(summary),
    sourceStrip(new RingRows(['heel'], new FrameRing(1, 1)))]};
  const bands = layOut(data, false);
  assert.equal(bands.length, 4);
  bands.slice(1).forEach(({top}, i) => assert.ok(top >= bands[i].top + bands[i].height));
  assert.equal(layOut(data, true).length, 1);
});

test('graphs begin at zero unless that squeezes them; unknown values do not count', () => {
  assert.deepEqual(rangeOf([null, 0.2, NaN, 0.8]), [0, 0.8]);
  assert.deepEqual(rangeOf([100, 101]), [100, 101]);
  assert.equal(rangeOf([null]), null);
});
