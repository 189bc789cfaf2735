// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Gestures on contacts write edits. marey's result must be the contacts that the user sees. It is
// compared with an independent model of marey's edits, written from docs/formats/edit_recipe.md.

import assert from 'node:assert/strict';
import test from 'node:test';
import {clearContact, moveContactEdge, setContact} from '../src/edit_time/contact_patches';
import type {ShownView} from '../src/edit_time/op_times';
import type {OpKeys, OpStep} from '../src/protocol/edit_protocol';

const FRAMES = 300;
const HEEL = {foot: 'left', part: 'heel'} as const;

interface Edit {do: string; from_s: number; to_s: number}
type Runs = [number, number][];

function runsOf(marks: readonly boolean[]): Runs {
  const out: Runs = [];
  marks.forEach((on, i) => {
    if (on && !marks[i - 1]) out.push([i, i]);
    else if (on) out[out.length - 1][1] = i;
  });
  return out;
}

function fill(marks: boolean[], first: number, last: number, on: boolean): void {
  for (let i = Math.max(first, 0); i <= Math.min(last, FRAMES - 1); ++i) marks[i] = on;
}

function moveRun(marks: boolean[], [first, last]: [number, number], start: number, end: number):
  void {
  fill(marks, first, last, false);
  fill(marks, start, end, true);
}

function applied(before: readonly boolean[], edits: readonly Edit[], rate_hz: number): boolean[] {
  const marks = [...before];
  for (const edit of edits) {
    const [from, to] = [edit.from_s, edit.to_s].map((time_s) => Math.round(time_s * rate_hz));
    if (edit.do === 'set' || edit.do === 'clear') fill(marks, from, to, edit.do === 'set');
    else {
      const end = edit.do === 'move_start' ? 0 : 1;
      const near = runsOf(marks).filter((run) => Math.abs(run[end] - from) <= 0.1 * rate_hz + 0.5)
        .sort((a, b) => Math.abs(a[end] - from) - Math.abs(b[end] - from))[0];
      if (near) moveRun(marks, near, end === 0 ? to : near[0], end === 0 ? near[1] : to);
    }
  }
  return marks;
}

/** The same numbers in every run. */
function random(seed: number): (below: number) => number {
  let state = seed;
  return (below) => {
    state = (state * 1103515245 + 12345) % 2147483648;
    return Math.floor(state / 2147483648 * below);
  };
}

for (const rate_hz of [30, 100, 120]) {
  test(`at ${rate_hz} Hz, gestures in any order give the contacts that they show`, () => {
    let mostEdits = 0;
    for (let seed = 1; seed <= 300; ++seed) {
      const below = random(seed);
      const before = new Array<boolean>(FRAMES).fill(false);
      for (let at = below(20); at < FRAMES; at += 20 + below(50)) {
        fill(before, at, at += below(40), true);
      }
      let edits: Edit[] = [];
      let shown = before;
      for (let step = 0; step < 12; ++step) {
        const ops = edits.length === 0 ? [] : [{do: 'contacts@1', off: false, text: '',
          keys: {do: 'contacts@1', edits} as unknown as OpKeys}];
        const view = {document: {ops, revision: null}, until: null, outputIndex: 0,
          output: {frames: FRAMES, rate_hz}} as unknown as ShownView;
        const wanted = [...shown];
        const runs = runsOf(shown);
        const kind = below(runs.length > 0 ? 6 : 1);
        const change = kind < 2 ? brush(view, wanted) : drag(view, wanted, runs);
        const steps = change(view.document.ops);
        if (steps) edits = editsAfter(steps);
        shown = applied(before, edits, rate_hz);
        assert.deepEqual(runsOf(shown), runsOf(wanted), `seed ${seed}, step ${step}: ` +
          JSON.stringify(edits));
        mostEdits = Math.max(mostEdits, edits.length);
      }

      function brush(view: ShownView, wanted: boolean[]): ReturnType<typeof setContact> {
        const first = below(FRAMES - 1);
        const last = Math.min(first + below(40), FRAMES - 1);
        const on = below(2) === 0;
        fill(wanted, first, last, on);
        return (on ? setContact : clearContact)(view, HEEL.foot, HEEL.part, first / rate_hz,
          last / rate_hz);
      }

      function drag(view: ShownView, wanted: boolean[], runs: Runs):
        ReturnType<typeof moveContactEdge> {
        const at = below(runs.length);
        const [first, last] = runs[at];
        const isStart = below(2) === 0;
        const from = isStart ? first : last;
        // A contact that was joined to another appears again when the edge is moved back.
        const to = Math.min(Math.max(from + below(41) - 20, (runs[at - 1]?.[1] ?? -2) + 2),
          (runs[at + 1]?.[0] ?? FRAMES + 1) - 2);
        moveRun(wanted, [first, last], isStart ? to : first, isStart ? last : to);
        return moveContactEdge(view, {...HEEL, edge: isStart ? 'start' : 'end',
          other_s: (isStart ? last : first) / rate_hz}, from / rate_hz, to / rate_hz);
      }
    }
    assert.ok(mostEdits > 3, 'edits were collected');
  });
}

function editsAfter(steps: readonly OpStep[]): Edit[] {
  assert.equal(steps.length, 1);
  const [step] = steps;
  return 'op' in step ? step.op.edits as unknown as Edit[] : [];
}
