// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Search in a map of loops, and the change of the recipe that makes a loop.

import type {Change} from '../edit/edit_document';
import {insertIndex} from '../edit/edit_view';
import {acts, lastActing, withoutInstant} from './op_to_change';
import type {LoopCandidateWords, LoopMapWords, OpWords} from '../protocol/edit_protocol';

/** Rows are starts, columns are ends. */
export interface Cell {row: number; column: number}

/** First and last frame of a cycle; the last one repeats the first. */
export interface Cycle {first: number; last: number}

/** Returns the distance of a pair; Infinity below the diagonal and outside. */
export function distanceAt({cells, distance_mm}: LoopMapWords, row: number,
  column: number): number {
  return row < 0 || column >= cells || column < row ? Infinity : distance_mm[row * cells + column];
}

function isMinimum(map: LoopMapWords, row: number, column: number): boolean {
  const here = distanceAt(map, row, column);
  // Pairs on the diagonal are the same frames.
  if (column <= row || !Number.isFinite(here)) return false;
  let isLower = false;
  for (let r = row - 1; r <= row + 1; ++r) {
    for (let c = column - 1; c <= column + 1; ++c) {
      const other = distanceAt(map, r, c);
      if (other < here) return false;
      if (other > here && Number.isFinite(other)) isLower = true;
    }
  }
  return isLower;
}

/** Returns the local minimum nearest to a cell, at most `reach` rows and columns away, or null.
 *  If two are equally near, it is the lower one. */
export function nearestMinimum(map: LoopMapWords, {row, column}: Cell, reach = 3): Cell | null {
  let best: Cell | null = null;
  let away = Infinity;
  for (let r = row - reach; r <= row + reach; ++r) {
    for (let c = column - reach; c <= column + reach; ++c) {
      const square = (r - row) ** 2 + (c - column) ** 2;
      if (square > away || !isMinimum(map, r, c)) continue;
      if (best && square === away &&
        distanceAt(map, r, c) >= distanceAt(map, best.row, best.column)) continue;
      best = {row: r, column: c};
      away = square;
    }
  }
  return best;
}

/** Returns the frames of a cell: those of a candidate in it, or its middle. */
export function cycleOfCell(map: LoopMapWords, {row, column}: Cell,
  candidates: readonly LoopCandidateWords[]): Cycle {
  const size = map.cell_frames;
  const known = candidates.find(({first, last}) =>
    Math.floor(first / size) === row && Math.floor(last / size) === column);
  if (known) return {first: known.first, last: known.last};
  // The last cell may have fewer frames.
  const middle = column < map.cells - 1 ? Math.floor((size - 1) / 2) : 0;
  return {first: row * size + middle, last: column * size + middle};
}

export function cellOfCycle({cells, cell_frames}: LoopMapWords, {first, last}: Cycle): Cell {
  const cell = (frame: number): number => Math.min(Math.floor(frame / cell_frames), cells - 1);
  return {row: cell(first), column: cell(last)};
}

/** Returns the distance at the dark end of the scale: 90 % of the pairs are below it. A round
 *  number of millimetres. */
export function scaleEnd_mm({cells, distance_mm}: LoopMapWords): number {
  const values: number[] = [];
  for (let row = 0; row < cells; ++row) {
    for (let column = row + 1; column < cells; ++column) {
      const value = distance_mm[row * cells + column];
      if (Number.isFinite(value)) values.push(value);
    }
  }
  if (values.length === 0) return 1;
  values.sort((a, b) => a - b);
  const end = values[Math.floor(0.9 * (values.length - 1))];
  const step = 10 ** Math.floor(Math.log10(Math.max(end, 1)));
  return Math.max(Math.ceil(2 * end / step) * step / 2, 1);
}

/** Returns distances of ticks of an axis over `length`, at most `count` of them: 1, 2 or 5
 *  times a power of ten. */
export function tickStep(length: number, count: number): number {
  const least = length / Math.max(count, 1);
  if (!(least > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5].find((factor) => factor * power >= least) ?? 10);
}

/** Returns the number of operations before the loop: they make the motion in which loops are
 *  searched. A cyclify just before is made again, so that the motion that it receives counts. */
export function loopsUntil(ops: readonly OpWords[], until: number | null): number {
  const end = insertIndex(ops, until);
  const i = lastActing(ops, end);
  return i >= 0 && ops[i].do === 'cyclify@1' ? i : end;
}

/** Returns the index of the cyclify that receives the motion after `end` operations, or
 *  null. */
export function cyclifyAt(ops: readonly OpWords[], end: number): number | null {
  const i = ops.findIndex((op, k) => k >= end && acts(op));
  return i >= 0 && ops[i].do === 'cyclify@1' ? i : null;
}

/** Makes a loop of a cycle of the motion that was searched (see loopsUntil()). A cyclify that
 *  receives this motion is changed. */
export function loopChange(cycle: Cycle, until: number | null): Change {
  const ends = {cycle_from_frame: Math.round(cycle.first), cycle_to_frame: Math.round(cycle.last)};
  return (ops) => {
    const end = loopsUntil(ops, until);
    const i = cyclifyAt(ops, end);
    if (i === null) return [{insert: end, op: {do: 'cyclify@1', ...ends}}];
    const {min_period_s: _min, max_period_s: _max, ...rest} =
      withoutInstant(withoutInstant(ops[i].keys, 'cycle_from'), 'cycle_to');
    return [{replace: i, op: {...rest, do: 'cyclify@1', ...ends}}];
  };
}

/** Returns a text that differs if the motion after `end` operations does. */
export function motionKey(ops: readonly OpWords[], end: number): string {
  return JSON.stringify(ops.slice(0, end).filter(acts).map(({text}) => text));
}
