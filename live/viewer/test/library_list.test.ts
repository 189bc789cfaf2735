// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The list of the page of a library, without a browser: requests, pages of rows, drawings, words.

import assert from 'node:assert/strict';
import {test} from 'node:test';
import {ClipStore, PAGE_ROWS} from '../src/library/clip_store';
import {clipTimeline} from '../src/library/clip_time';
import {figureName, figureValue, verdictOfKind, worstFirst} from '../src/library/figure_words';
import {BONES, scaleOf, strokesOf} from '../src/library/pose_strokes';
import {Questions} from '../src/library/questions';
import type {Reply} from '../src/library/questions';
import {scrolledTo, visibleRows} from '../src/library/visible_rows';
import type {ClipRow, ClipWords, ListOrder} from '../src/protocol/library_protocol';
import type {PageWords} from '../src/protocol/protocol';

const ORDER: ListOrder = {query: '', quality: null, sort: 'number', descending: false};
const row = (clip: number): ClipRow => ({clip, clip_id: `id${clip}`, name: `clip ${clip}`,
  seconds: 2, rate_hz: 30, quality: 'pass', licence: 'CC0-1.0', subject: '', split: '', labels: [],
  found_labels: []});
const page = (offset: number, count: number, found: number): Reply => ({kind: 'answer', words: {
  type: 'clips', id: '', revision: 1, offset, found, counts: {pass: found, warn: 0, fail: 0},
  remarks: [], rows: Array.from({length: Math.min(count, found - offset)}, (_, i) =>
    row(offset + i))}});

test('visible rows cover the window with some to spare, and never leave the list', () => {
  assert.deepEqual(visibleRows(0, 100, 10, 50, 2), {first: 0, last: 11});
  assert.deepEqual(visibleRows(205, 100, 10, 50, 0), {first: 20, last: 30});
  assert.deepEqual(visibleRows(450, 100, 10, 50, 3), {first: 42, last: 49});
  assert.deepEqual(visibleRows(0, 100, 10, 0, 3), {first: 0, last: -1});
});

test('a list scrolls only as far as a row needs', () => {
  assert.equal(scrolledTo(3, 0, 100, 10), 0);
  assert.equal(scrolledTo(12, 0, 100, 10), 30);
  assert.equal(scrolledTo(2, 50, 100, 10), 20);
});

test('the store fetches each page of rows once', async () => {
  const asked: number[] = [];
  let changes = 0;
  const store = new ClipStore(ORDER, (_order, offset, count) => {
    asked.push(offset);
    return Promise.resolve(page(offset, count, 350));
  }, {rowsChanged: () => { ++changes; }, orderRefused: () => {}, outdated: () => {}});
  assert.ok(await store.setOrder(ORDER));
  assert.equal(store.found, 350);
  assert.equal(store.row(0)?.clip, 0);
  assert.equal(store.row(PAGE_ROWS + 20), null);
  store.want(90, 230);
  store.want(95, 240);
  await new Promise((done) => setTimeout(done, 0));
  assert.deepEqual(asked, [0, 100, 200]);
  assert.equal(store.row(PAGE_ROWS + 20)?.clip, 120);
  assert.equal(store.indexOf('id230'), 230);
  assert.equal(changes, 3);
});

test('a refused expression keeps the list, and an older answer does not replace a newer one',
  async () => {
    const waiting: ((reply: Reply) => void)[] = [];
    const refused: string[] = [];
    const store = new ClipStore(ORDER, () => new Promise((done) => waiting.push(done)),
      {rowsChanged: () => {}, orderRefused: (text) => refused.push(text), outdated: () => {}});
    const first = store.setOrder(ORDER);
    waiting[0](page(0, 100, 10));
    assert.ok(await first);
    const wrong = store.setOrder({...ORDER, query: 'x='});
    waiting[1]({kind: 'refused', text: 'column 3'});
    assert.ok(!await wrong);
    assert.deepEqual([store.found, store.order.query, refused], [10, '', ['column 3']]);
    const slow = store.setOrder({...ORDER, query: 'a'});
    const fast = store.setOrder({...ORDER, query: 'ab'});
    waiting[3](page(0, 100, 2));
    waiting[2](page(0, 100, 7));
    assert.ok(await fast);
    assert.ok(!await slow);
    assert.deepEqual([store.found, store.order.query], [2, 'ab']);
  });

test('questions wait for a free place, and none is left without a reply', async () => {
  const sent: (PageWords & {id?: string})[] = [];
  const questions = new Questions((words) => sent.push(words as PageWords & {id?: string}) > 0);
  questions.revision = 4;
  const replies = Array.from({length: 10}, (_, clip) =>
    questions.ask({type: 'clip', clip, mirrored: false}));
  assert.equal(sent.length, 8);
  assert.ok(questions.hear({type: 'error', id: sent[0].id, text: 'no such clip'}));
  assert.deepEqual(await replies[0], {kind: 'refused', text: 'no such clip'});
  assert.equal(sent.length, 9);
  assert.ok(questions.hear({type: 'outdated', id: sent[1].id!, revision: 5, about: 'clip'}));
  assert.deepEqual(await replies[1], {kind: 'outdated'});
  assert.ok(!questions.hear({type: 'error', id: 'other', text: ''}));
  questions.lose();
  for (const reply of replies.slice(2)) assert.deepEqual(await reply, {kind: 'lost'});
});

test('postures stand on the lower edge of their box, in scale', () => {
  // An upright line: hips at 900 mm, head at 1600 mm.
  const points = BONES.flatMap((bone) => [0, bone === 'head' ? 1600 : bone === 'neck' ? 1500
    : /Foot|Toes/.test(bone) ? 0 : 900]);
  const scale = scaleOf([points], 40, 60);
  assert.ok(Math.abs(scale - 60 / 1900) < 1e-9);
  const {strokes, head, ground_px} = strokesOf(points, scale, {left: 10, top: 5, width: 40,
    height: 60});
  assert.equal(ground_px, 65);
  for (const {points: places} of strokes) assert.equal(places[0], 30);
  const leg = strokes.find(({side, points: places}) => side === 'front' && places.length === 10)!;
  assert.equal(leg.points[9], 65);
  assert.ok(head.y < 65 - 1600 * scale && head.y - head.radius > 5);
});

test('figures are words with units, worst first', () => {
  assert.equal(figureName('slide_cm_s'), 'slide');
  assert.equal(figureValue('slide_cm_s', 4.2), '4.20\u00a0cm/s');
  assert.equal(figureValue('still_share', 0.25), '25.0\u00a0%');
  assert.equal(figureValue('flip_count', 3), '3');
  const figure = (name: string, verdict: 'pass' | 'warn' | 'fail' | null, kind: string) =>
    ({name, value: 1, verdict, joint: '', frames: null, kind, warn: null, fail: null});
  const figures = [figure('sparc', null, 'sparc'), figure('spike', 'pass', 'spike'),
    figure('slide_cm_s', 'warn', 'slide'), figure('drift_mm', 'fail', 'slide')];
  assert.deepEqual(worstFirst(figures).map(({name}) => name),
    ['drift_mm', 'slide_cm_s', 'spike', 'sparc']);
  assert.equal(verdictOfKind({figures}, 'slide'), 'fail');
  assert.equal(verdictOfKind({figures}, 'unknown'), 'warn');
});

test('the timeline has rows of problems, then of labels by people, then of those by marey', () => {
  const label = (text: string, by: string) => ({start_s: 0, end_s: 1, text, by, certainty: 1});
  const clip = {frame_step: 2, figures: [], problems: [
    {frames: [10, 20], kind: 'spike', joint: 'leftHand', value: 9}],
  labels: [label('moving', 'marey'), label('walk', 'Anna')], events: [{frame: 30, name: 'strike'}],
  } as unknown as ClipWords;
  const {strips, notes} = clipTimeline(clip, 15);
  assert.deepEqual(strips.map(({rows}) => rows.names), [['spike'], ['walk'], ['moving']]);
  assert.notEqual(strips[0].rows.source(0, 7), 0);
  assert.deepEqual(notes, [{frame: 15, text: 'strike'}]);
  assert.match(strips[1].words(0, 5), /by Anna/);
});
