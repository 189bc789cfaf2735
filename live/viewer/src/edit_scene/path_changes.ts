// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Changes of the recipe by the tool for the path.

import type {Change} from '../edit/edit_document';
import {insertIndex, placeIndex} from '../edit/edit_view';
import {opToChange, rounded} from './op_to_change';
import type {OpKeys, OpValue, OpWords} from '../protocol/edit_protocol';

/** x and z on the floor. [m] */
export type Place = [number, number];

function isPlace(value: OpValue): value is Place {
  return Array.isArray(value) && value.length === 2 &&
    value.every((part) => typeof part === 'number');
}

/** Returns the points of a path; null if it has none. */
export function pointsOf(keys: OpKeys): Place[] | null {
  const points = keys.points_xz_m;
  return keys.do === 'path@1' && Array.isArray(points) && points.length > 1 &&
    points.every(isPlace) ? points.map(([x, z]): Place => [x, z]) : null;
}

/** Returns the index of the operation whose points are shown: the selected one, if it is
 *  applied, or that just before; null: none. */
export function pathOpWithPoints(ops: readonly OpWords[], until: number | null,
  selected: number | null): number | null {
  const isApplied = selected !== null && selected < (until ?? ops.length) &&
    !(ops[selected]?.off ?? true);
  if (isApplied && pointsOf(ops[selected].keys)) return selected;
  return opToChange(ops, placeIndex(ops, until), 'path@1', (keys) => pointsOf(keys) !== null);
}

/** Leads the motion along these points. */
export function pointsChange(points: readonly Place[], until: number | null,
  selected: number | null): Change {
  const points_xz_m = points.map(([x, z]): Place => [rounded(x), rounded(z)]);
  return (ops) => {
    const i = pathOpWithPoints(ops, until, selected);
    if (i === null) return [{insert: placeIndex(ops, until), op: {do: 'path@1', points_xz_m}}];
    return [{replace: i, op: {...ops[i].keys, points_xz_m}}];
  };
}

/** Parameters of a path without points. */
export interface PathShape {turn_deg: number; length: number; straight: boolean}

const SAME: PathShape = {turn_deg: 0, length: 1, straight: false};

function shapeOf(keys: OpKeys): PathShape {
  return {turn_deg: Number(keys.turn_deg ?? 0), length: Number(keys.length ?? 1),
    straight: keys.straight === true};
}

function shapedOp(ops: readonly OpWords[], until: number | null): number | null {
  return opToChange(ops, insertIndex(ops, until), 'path@1',
    (keys) => !('points_xz_m' in keys));
}

/** Returns the parameters of the operation that shapeChange() changes. */
export function shownShape(ops: readonly OpWords[], until: number | null): PathShape {
  const i = shapedOp(ops, until);
  return i === null ? SAME : shapeOf(ops[i].keys);
}

/** Bends or stretches the path. A path without points just before is changed, and removed if
 *  it changes nothing any more. */
export function shapeChange(shaped: (shape: PathShape) => Partial<PathShape>,
  until: number | null): Change {
  return (ops) => {
    const i = shapedOp(ops, until);
    const before = i === null ? SAME : shapeOf(ops[i].keys);
    const {turn_deg, length, straight} = {...before, ...shaped(before)};
    const {turn_deg: _turn, length: _length, straight: _straight, ...rest} =
      i === null ? {do: 'path@1'} as OpKeys : ops[i].keys;
    const op = {...rest, ...(turn_deg !== 0 ? {turn_deg: Math.round(10 * turn_deg) / 10} : {}),
      ...(length !== 1 ? {length: rounded(length)} : {}),
      ...(straight ? {straight} : {})} as OpKeys;
    const changes = turn_deg !== 0 || length !== 1 || straight;
    if (i === null) return changes ? [{insert: insertIndex(ops, until), op}] : null;
    return changes ? [{replace: i, op}] : [{remove: i}];
  };
}
