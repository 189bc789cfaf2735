// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Gestures on the timeline of the edit page as changes of the recipe.

import assert from 'node:assert/strict';
import test from 'node:test';
import {clearContact, moveContactEdge, setContact} from '../src/edit_time/contact_patches';
import type {Change} from '../src/edit/edit_document';
import type {ShownView} from '../src/edit_time/op_times';
import {annotationTime, offset_s, shownBy, withInstant, withTable} from '../src/edit_time/op_times';
import {
  addCurve, addOverSpan, keepSpan, moveAnnotation, moveConstraintTime, moveInstants, moveSpanOf,
  removeSpan, trim,
} from '../src/edit_time/patches';
import {handlesIn, handleWords} from '../src/edit_time/timeline_handles';
import type {OpKeys, OpStep, OpWords, OutputWords} from '../src/protocol/edit_protocol';

const OFF = Symbol('off');
type Op = OpKeys & {[OFF]?: boolean};

function off(op: OpKeys): Op {
  return {...op, [OFF]: true};
}

function words(op: Op): OpWords {
  const {[OFF]: isOff, ...keys} = op;
  return {do: op.do, off: isOff ?? false, text: '', keys};
}

/** 301 frames at 100 Hz: 3 s. */
function view(ops: readonly Op[], output: Partial<OutputWords> = {},
  place: {until?: number | null; outputIndex?: number} = {}): ShownView {
  const shown = {name: 'walk', frames: 301, rate_hz: 100, span: [0, 300], block: '', contacts: [],
    trust: [], tracks: [], lineage: [[0, 300, 0, 0, 300]], touched: [], annotations: [],
    value_curves: [], constraints: [], graphs: [], figures: null, ...output};
  return {document: {ops: ops.map(words), revision: {sources: [{id: '', file: 'walk.bvh',
    frames: 2000, rate_hz: 100}]}}, until: null, outputIndex: 0, output: shown,
  ...place} as unknown as ShownView;
}

/** The recipe after a change, computed with an implementation of the steps of its own. */
function after(seen: ShownView, change: Change): OpKeys[] {
  const steps = change(seen.document.ops);
  assert.ok(steps, 'the change is meaningless');
  const ops = seen.document.ops.map(({keys}) => keys);
  for (const step of steps as OpStep[]) {
    if ('insert' in step) ops.splice(step.insert, 0, step.op);
    else if ('replace' in step) ops[step.replace] = step.op;
    else if ('remove' in step) ops.splice(step.remove, 1);
    else assert.fail('a step of another kind');
  }
  return ops;
}

const LEFT_HEEL = {foot: 'left', part: 'heel'} as const;
const heelStart = {...LEFT_HEEL, edge: 'start', other_s: 1.7} as const;
const FILTER: OpKeys = {do: 'filter@1'};

// --- Trim ---

test('a trim without a cut before inserts one with the ends that were moved', () => {
  const seen = view([FILTER]);
  assert.deepEqual(after(seen, trim(seen, 0.5, 3)), [FILTER, {do: 'cut@1', from_s: 0.5}]);
  assert.deepEqual(after(seen, trim(seen, 0, 2.25)), [FILTER, {do: 'cut@1', to_s: 2.25}]);
  assert.deepEqual(after(seen, trim(seen, 0.5, 2.25)),
    [FILTER, {do: 'cut@1', from_s: 0.5, to_s: 2.25}]);
  assert.equal(trim(seen, 0, 3)(seen.document.ops), null);
});

test('a trim changes the cut before, in the times of its input', () => {
  const seen = view([{do: 'cut@1', from_s: 1.2, to_s: 4.2, why: 'start'}]);
  assert.deepEqual(after(seen, trim(seen, 0.5, 3)),
    [{do: 'cut@1', from_s: 1.7, to_s: 4.2, why: 'start'}]);
  assert.deepEqual(after(seen, trim(seen, 0, 2)),
    [{do: 'cut@1', from_s: 1.2, to_s: 3.2, why: 'start'}]);
});

test('only the end that moved becomes seconds', () => {
  const seen = view([{do: 'cut@1', from_frame: 120, to: 'left.strike[2]'}]);
  assert.deepEqual(after(seen, trim(seen, 0.5, 3)),
    [{do: 'cut@1', from_s: 1.7, to: 'left.strike[2]'}]);
  assert.deepEqual(after(seen, trim(seen, 0, 2.5)), [{do: 'cut@1', from_frame: 120, to_s: 3.7}]);
});

test('the start of a cut at an annotation is found from the source frames', () => {
  const seen = view([{do: 'cut@1', from_s: 1}, {do: 'cut@1', from: 'left.strike'}],
    {lineage: [[0, 300, 0, 340, 640]]});
  // Frame 340 of the source is 3.4 s; the first cut removes 1 s of it.
  assert.deepEqual(after(seen, trim(seen, 0.1, 2)),
    [{do: 'cut@1', from_s: 1}, {do: 'cut@1', from_s: 2.5, to_s: 4.4}]);
});

test('a cut whose start is not known stays, and another one follows', () => {
  const ops: OpKeys[] = [{do: 'retime@1', speed: 2}, {do: 'cut@1', from: 'left.strike'}];
  const seen = view(ops);
  assert.deepEqual(after(seen, trim(seen, 0.1, 3)), [...ops, {do: 'cut@1', from_s: 0.1}]);
});

test('operations that are off are no obstacle, annotations keep their poses', () => {
  const ops: Op[] = [{do: 'cut@1', from_s: 1}, off({do: 'filter@1', from_s: 1}),
    {do: 'tag@1', text: 'a', from_s: 0.2, to_s: 2.5},
    {do: 'event@1', text: 'b', at_frame: 150},
    {do: 'curve@1', name: 'c', keys: [{at_s: 1, value: 0}, {at: 'b', value: 1}]}];
  const seen = view(ops);
  assert.deepEqual(after(seen, trim(seen, 0.5, 2)), [{do: 'cut@1', from_s: 1.5, to_s: 3},
    {do: 'filter@1', from_s: 1}, {do: 'tag@1', text: 'a', from_s: 0, to_s: 1.5},
    {do: 'event@1', text: 'b', at_s: 1},
    {do: 'curve@1', name: 'c', keys: [{at_s: 0.5, value: 0}, {at: 'b', value: 1}]}]);
  // The event would be outside of the cut.
  assert.deepEqual(after(seen, trim(seen, 1.6, 3)).at(-1), {do: 'cut@1', from_s: 1.6});
});

test('a cut that is off, or follows, is not the one before', () => {
  const cut = {do: 'cut@1', from_s: 1};
  const switched = view([off(cut)]);
  assert.deepEqual(after(switched, trim(switched, 0.5, 3)), [cut, {do: 'cut@1', from_s: 0.5}]);
  const before = view([FILTER, cut], {}, {until: 1});
  assert.deepEqual(after(before, trim(before, 0.5, 3)), [FILTER, {do: 'cut@1', from_s: 0.5}, cut]);
});

test('a trim comes before a last retarget', () => {
  const put: OpKeys = {do: 'retarget@1', avatar: 'a.vrm'};
  const seen = view([{do: 'cut@1', to_s: 4}, put]);
  assert.deepEqual(after(seen, trim(seen, 0.5, 3)), [{do: 'cut@1', to_s: 4, from_s: 0.5}, put]);
});

test('a trim of one of the kept motions changes its span', () => {
  const keep = {do: 'keep@1', spans: [{from_s: 1, to_s: 2}, {from_s: 3, to_s: 6}]};
  const seen = view([keep], {}, {outputIndex: 1});
  assert.deepEqual(after(seen, trim(seen, 0.25, 2.5)),
    [{do: 'keep@1', spans: [{from_s: 1, to_s: 2}, {from_s: 3.25, to_s: 5.5}]}]);
});

test('whole frames stay whole: a cut is in frames where milliseconds would resample', () => {
  const seen = view([], {rate_hz: 120, frames: 361});
  assert.deepEqual(after(seen, trim(seen, 48 / 120, 301 / 120)),
    [{do: 'cut@1', from_s: 0.4, to_frame: 301}]);
});

test('a cut that follows has its handles in the motion before it', () => {
  const seen = view([FILTER, {do: 'cut@1', from_s: 1, to_s: 2}], {frames: 501}, {until: 1});
  const [start, end] = handlesIn(seen, null, 'axis', 0);
  assert.deepEqual([start.frame, end.frame], [100, 200]);
  assert.deepEqual(after(seen, start.change(50)!)[1], {do: 'cut@1', from_s: 0.5, to_s: 2});
  assert.deepEqual(after(seen, end.change(450)!)[1], {do: 'cut@1', from_s: 1, to_s: 4.5});
  // This motion has no such annotation.
  const named = view([{do: 'cut@1', from_s: 1, to: 'end of it'}], {}, {until: 0});
  assert.deepEqual(handlesIn(named, null, 'axis', 0).map(({side, frame}) => [side, frame]),
    [['start', 100]]);
});

// --- Contacts ---

test('edges of contacts are collected in one operation', () => {
  const first = view([FILTER]);
  const moved = {do: 'move_start', ...LEFT_HEEL, from_s: 1.31, to_s: 1.283};
  const once = after(first, moveContactEdge(first, heelStart, 1.31, 1.283));
  assert.deepEqual(once, [FILTER, {do: 'contacts@1', edits: [moved]}]);
  const second = view([...once, {do: 'event@1', text: 'a', at_s: 1}]);
  const ball = {foot: 'right', part: 'ball', edge: 'end', other_s: 0.5} as const;
  assert.deepEqual(after(second, moveContactEdge(second, ball, 0.9, 0.95))[1], {do: 'contacts@1',
    edits: [moved, {do: 'move_end', foot: 'right', part: 'ball', from_s: 0.9, to_s: 0.95}]});
});

test('an edge that is moved again keeps its original time; moved back, the edit is gone', () => {
  const edits = [{do: 'move_start', ...LEFT_HEEL, from_s: 1.31, to_s: 1.28},
    {do: 'move_end', ...LEFT_HEEL, from_s: 1.7, to_s: 1.75}];
  const seen = view([{do: 'contacts@1', edits}]);
  assert.deepEqual(after(seen, moveContactEdge(seen, heelStart, 1.28, 1.2)),
    [{do: 'contacts@1', edits: [{...edits[0], to_s: 1.2}, edits[1]]}]);
  assert.deepEqual(after(seen, moveContactEdge(seen, heelStart, 1.28, 1.31)),
    [{do: 'contacts@1', edits: [edits[1]]}]);
  const alone = view([{do: 'contacts@1', edits: [edits[0]]}]);
  assert.deepEqual(after(alone, moveContactEdge(alone, heelStart, 1.28, 1.31)), []);
  const detected = view([{do: 'contacts@1', detect: true, edits: [edits[0]]}]);
  assert.deepEqual(after(detected, moveContactEdge(detected, heelStart, 1.28, 1.31)),
    [{do: 'contacts@1', detect: true}]);
});

test('an edge that a later edit depends on is moved by a further edit', () => {
  const edits = [{do: 'move_start', ...LEFT_HEEL, from_s: 1.31, to_s: 1.28},
    {do: 'clear', ...LEFT_HEEL, from_s: 1.1, to_s: 1.2}];
  const seen = view([{do: 'contacts@1', edits}]);
  assert.deepEqual(after(seen, moveContactEdge(seen, heelStart, 1.28, 1.25)),
    [{do: 'contacts@1', edits: [...edits, {...edits[0], from_s: 1.28, to_s: 1.25}]}]);
});

test('an edge beyond the other one clears the contact', () => {
  const seen = view([]);
  assert.deepEqual(after(seen, moveContactEdge(seen, heelStart, 1.31, 1.8)),
    [{do: 'contacts@1', edits: [{do: 'clear', ...LEFT_HEEL, from_s: 1.31, to_s: 1.7}]}]);
  const end = {...LEFT_HEEL, edge: 'end', other_s: 1.31} as const;
  assert.deepEqual(after(seen, moveContactEdge(seen, end, 1.7, 1.2)),
    [{do: 'contacts@1', edits: [{do: 'clear', ...LEFT_HEEL, from_s: 1.31, to_s: 1.7}]}]);
});

test('contacts that are off are not changed', () => {
  const old = off({do: 'contacts@1', detect: true});
  const seen = view([old]);
  assert.equal(after(seen, moveContactEdge(seen, heelStart, 1.31, 1.3)).length, 2);
});

test('a brushed span of a row bears or not; edits that it covers are dropped', () => {
  const seen = view([]);
  const cleared = after(seen, clearContact(seen, 'left', 'heel', 1, 1.2));
  assert.deepEqual(cleared,
    [{do: 'contacts@1', edits: [{do: 'clear', ...LEFT_HEEL, from_s: 1, to_s: 1.2}]}]);
  const again = view(cleared);
  const set = {do: 'set', ...LEFT_HEEL, from_s: 0.9, to_s: 1.3};
  assert.deepEqual(after(again, setContact(again, 'left', 'heel', 0.9, 1.3)),
    [{do: 'contacts@1', edits: [set]}]);
  assert.deepEqual(after(again, setContact(again, 'left', 'ball', 0.9, 1.3)),
    [{do: 'contacts@1', edits: [...cleared[0].edits as [], {...set, part: 'ball'}]}]);
});

// --- Spans and instants ---

test('operations over a span receive the shown motion', () => {
  const seen = view([FILTER, {do: 'mirror@1'}], {}, {until: 1});
  assert.deepEqual(after(seen, addOverSpan(seen, 'exaggerate@1', {gain: 2}, 1.0004, 2))[1],
    {do: 'exaggerate@1', from_s: 1, to_s: 2, gain: 2, blend_s: 0.1});
  assert.deepEqual(after(seen, addOverSpan(seen, 'filter@1', {}, 0, 3))[1], {do: 'filter@1'});
  assert.deepEqual(after(seen, addOverSpan(seen, 'tag@1', {text: 'walk'}, 1, 2))[1],
    {do: 'tag@1', from_s: 1, to_s: 2, text: 'walk'});
  assert.deepEqual(after(seen, addCurve(seen, 'weight', 0, 2))[1],
    {do: 'curve@1', name: 'weight', keys: [{at_s: 0, value: 0}, {at_s: 2, value: 1}]});
});

test('a further span is added to a keep operation that follows', () => {
  const seen = view([FILTER]);
  assert.deepEqual(after(seen, keepSpan(seen, 1, 2))[1],
    {do: 'keep@1', spans: [{from_s: 1, to_s: 2}]});
  const keep = {do: 'keep@1', spans: [{from_s: 1, to_s: 2}]};
  const before = view([FILTER, keep], {}, {until: 1});
  assert.deepEqual(after(before, keepSpan(before, 2, 3)),
    [FILTER, {do: 'keep@1', spans: [{from_s: 1, to_s: 2}, {from_s: 2, to_s: 3}]}]);
});

test('a span is removed at an end, not in the middle', () => {
  const seen = view([]);
  assert.deepEqual(after(seen, removeSpan(seen, 0, 1)!), [{do: 'cut@1', from_s: 1.01}]);
  assert.deepEqual(after(seen, removeSpan(seen, 2, 3)!), [{do: 'cut@1', to_s: 1.99}]);
  assert.equal(removeSpan(seen, 1, 2), null);
  assert.equal(removeSpan(seen, 0, 3), null);
});

test('the span of a selected operation moves; ends without a change keep their keys', () => {
  const seen = view([{do: 'filter@1', from: 'left.strike', to_frame: 250, method: 'gcv'}]);
  assert.deepEqual(after(seen, moveSpanOf(seen, 0, 0.5, null)),
    [{do: 'filter@1', from_s: 0.5, to_frame: 250, method: 'gcv'}]);
  assert.deepEqual(after(seen, moveSpanOf(seen, 0, null, 2)),
    [{do: 'filter@1', from: 'left.strike', to_s: 2, method: 'gcv'}]);
});

test('times of an operation before a cut are later than shown, of one after it are not', () => {
  const seen = view([{do: 'filter@1', from_s: 1.5}, {do: 'cut@1', from_s: 1},
    {do: 'filter@1', from_s: 1.5}]);
  assert.equal(offset_s(shownBy(seen)!, 0), 1);
  assert.deepEqual(after(seen, moveSpanOf(seen, 0, 0.75, null))[0], {do: 'filter@1', from_s: 1.75});
  assert.deepEqual(after(seen, moveSpanOf(seen, 2, 0.75, null))[2], {do: 'filter@1', from_s: 0.75});
  const early = view([{do: 'cut@1', from_s: 1}, {do: 'filter@1', from_s: 1.5}], {}, {until: 0});
  assert.deepEqual(after(early, moveSpanOf(early, 1, 1.75, null))[1],
    {do: 'filter@1', from_s: 0.75});
  const retimed = view([{do: 'filter@1', from_s: 1}, {do: 'retime@1', speed: 2}]);
  assert.equal(moveSpanOf(retimed, 0, 0.5, null)(retimed.document.ops), null);
});

test('instants of pose, curve and retime move alone', () => {
  const pose = {do: 'pose@1', at_frame: 50, bone: 'leftHand', moved_m: [0, 0.1, 0]};
  const curve = {do: 'curve@1', name: 'c', keys: [{at_s: 0, value: 0}, {at_s: 1, value: 1}]};
  const seen = view([pose, curve]);
  assert.deepEqual(after(seen, moveInstants(seen, 0, [], {at: 0.7}))[0],
    {do: 'pose@1', at_s: 0.7, bone: 'leftHand', moved_m: [0, 0.1, 0]});
  assert.deepEqual(after(seen, moveInstants(seen, 1, ['keys', 1], {at: 1.4}))[1],
    {...curve, keys: [{at_s: 0, value: 0}, {at_s: 1.4, value: 1}]});
  const retime = view([{do: 'retime@1', knots: [{at_s: 1, time_s: 2}]}], {}, {until: 0});
  assert.deepEqual(after(retime, moveInstants(retime, 0, ['knots', 0], {at: 1.2}))[0],
    {do: 'retime@1', knots: [{at_s: 1.2, time_s: 2}]});
});

test('a change whose operation has become another one is meaningless', () => {
  const seen = view([FILTER]);
  const change = moveSpanOf(seen, 0, 1, null);
  assert.equal(change([words({do: 'mirror@1'})]), null);
  assert.equal(change([]), null);
});

test('handles of instants stay between their neighbours', () => {
  const seen = view([{do: 'curve@1', name: 'c', keys: [{at_s: 0.5, value: 0}, {at_s: 1, value: 1},
    {at_s: 2, value: 0}]}]);
  const points = handlesIn(seen, 0, 'axis', 0).filter(({side}) => side === 'point');
  assert.deepEqual(points.map(({frame, low, high}) => [frame, low, high]),
    [[50, 0, 99], [100, 51, 199], [200, 101, 300]]);
});

// --- Constraints and annotations ---

test('a constraint gets other times: in its operation, or by hand if it was found', () => {
  const constraint = {type: 'Distance', name: 'rail', segment: 'rightHand', start: 'right.strike',
    stop_s: 2.5, position_m: [0, 1, 2]};
  const seen = view([{do: 'constrain@1', constraint}]);
  assert.deepEqual(after(seen, moveConstraintTime(seen, 'rail', 0.5, null)), [{do: 'constrain@1',
    constraint: {...constraint, start: undefined, start_s: 0.5}}].map((op) =>
    JSON.parse(JSON.stringify(op))));
  assert.deepEqual(after(seen, moveConstraintTime(seen, 'rail', null, 2))[0],
    {do: 'constrain@1', constraint: {...constraint, stop_s: 2}});
  const byHand = (name: string, ...entries: object[]): object => ({do: 'constrain@1',
    changes: entries.map((entry) => ({name, ...entry})), adapt: true});
  assert.deepEqual(after(seen, moveConstraintTime(seen, 'found left foot', 0.5, null))[1],
    byHand('found left foot', {start_s: 0.5}));
  const detected = view([{do: 'constrain@1', detect: 'supports', changes: [
    {name: 'found left foot', start_s: 0.5}]}, {do: 'tag@1', text: 'a'}]);
  assert.deepEqual(after(detected, moveConstraintTime(detected, 'left foot', null, 1))[0],
    {do: 'constrain@1', detect: 'supports', changes: [
      {name: 'found left foot', start_s: 0.5, stop_s: 1}]});
  assert.deepEqual(after(detected, moveConstraintTime(detected, 'found right foot', 2, null))[0],
    {do: 'constrain@1', detect: 'supports', changes: [{name: 'found left foot', start_s: 0.5},
      {name: 'found right foot', start_s: 2}]});
  const spanned = view([{do: 'constrain@1', from_s: 1, to_s: 2, constraint: {name: 'a'}},
    {do: 'cut@1', from_s: 0.5}]);
  assert.deepEqual(after(spanned, moveConstraintTime(spanned, 'a', 0.7, null))[0],
    {do: 'constrain@1', to_s: 2, constraint: {name: 'a', start_s: 1.2}});
});

test('an annotation of a tag or event moves with its operation', () => {
  const walk = {text: 'walk', start_s: 0, end_s: 1};
  const again = {text: 'walk', start_s: 1.5, end_s: 2};
  const beat = {text: 'beat', start_s: 1, end_s: 1};
  const seen = view([{do: 'tag@1', text: 'walk', from_s: 0.4, to_s: 1.5},
    {do: 'cut@1', from_s: 0.5}, {do: 'event@1', text: 'beat', at_s: 1},
    {do: 'tag@1', text: 'walk', from_s: 1.5, to_s: 2}], {annotations: [walk, beat, again]});
  // The first tag begins before the cut.
  assert.deepEqual(after(seen, moveAnnotation(seen, walk, 0, 0.8))[0],
    {do: 'tag@1', text: 'walk', from_s: 0.4, to_s: 1.3});
  assert.deepEqual(after(seen, moveAnnotation(seen, again, 1.6, 2))[3],
    {do: 'tag@1', text: 'walk', from_s: 1.6, to_s: 2});
  assert.deepEqual(after(seen, moveAnnotation(seen, beat, 1.25, 1.25))[2],
    {do: 'event@1', text: 'beat', at_s: 1.25});
  const other = {text: 'source note', start_s: 1, end_s: 1};
  assert.equal(moveAnnotation(seen, other, 2, 2)(seen.document.ops), null);
});

test('annotations of the same text have their handles in one row', () => {
  const seen = view([{do: 'tag@1', text: 'walk', from_s: 0.2, to_s: 1},
    {do: 'tag@1', text: 'walk', from_s: 1.5, to_s: 2}, {do: 'event@1', text: 'beat', at_s: 1}],
  {annotations: [{text: 'walk', start_s: 0.2, end_s: 1}, {text: 'walk', start_s: 1.5, end_s: 2},
    {text: 'beat', start_s: 1, end_s: 1}]});
  const framesIn = (row: number) => handlesIn(seen, null, 'annotations', row).map(({frame}) =>
    Math.round(frame));
  assert.deepEqual([framesIn(0), framesIn(1), framesIn(2)], [[20, 100, 150, 200], [100], []]);
  const near = handlesIn(seen, null, 'axis', 0, [90, 110]).filter(({role}) => role === 'mark');
  assert.deepEqual(near.map(({name}) => name), ['beat']);
  assert.ok(handlesIn(seen, null, 'axis', 0, [0, 90]).every(({role}) => role === 'trim'));
});

test('annotations and contact events have times in the shown motion', () => {
  const {output} = view([], {annotations: [{text: 'a', start_s: 1, end_s: 2}], contacts: [
    {name: 'left heel', foot: 'left', part: 'heel', spans: [[0, 40], [100, 140], [200, 240]]},
    {name: 'left ball', foot: 'left', part: 'ball', spans: [[10, 60], [110, 160], [230, 300]]}]});
  assert.equal(annotationTime(output!, 'a', 'end'), 2);
  // The first stance begins with the motion, the last one ends with it.
  assert.equal(annotationTime(output!, 'left.strike', 'start'), 1);
  assert.equal(annotationTime(output!, 'left.strike[1]', 'start'), 2);
  assert.equal(annotationTime(output!, 'left.toe_off[1]', 'start'), 1.6);
  assert.equal(annotationTime(output!, 'left.toe_off[2]', 'start'), null);
  assert.equal(annotationTime(output!, 'right.strike', 'start'), null);
});

test('contacts have a handle at each end, and its text has time and change', () => {
  const seen = view([], {contacts: [{name: 'left heel', foot: 'left', part: 'heel',
    spans: [[131, 170]]}]});
  const [start, end] = handlesIn(seen, null, 'contacts', 0);
  assert.deepEqual([start.frame + start.shift, end.frame + end.shift], [130.5, 170.5]);
  assert.equal(handleWords(start, 128, 100), 'start of left heel 1.280 s (−30 ms)');
  assert.equal(handleWords(start, 131, 100), 'start of left heel 1.310 s');
  assert.equal(handleWords(start, 180, 100), 'left heel: contact is cleared');
  assert.deepEqual(handlesIn(seen, null, 'contacts', 1), []);
});

// --- Keys ---

test('a key of an instant is replaced where it was', () => {
  assert.deepEqual(Object.keys(withInstant({a: 1, at: 'b', c: 2}, 'at', 1, 100)),
    ['a', 'at_s', 'c']);
  assert.deepEqual(withInstant({at_frame: 3, at_x: 1}, 'at', null, 100), {at_x: 1});
  assert.deepEqual(withTable({do: 'keep@1', spans: [{a: 1}, {a: 2}]}, ['spans', 1], {a: 3}),
    {do: 'keep@1', spans: [{a: 1}, {a: 3}]});
});
