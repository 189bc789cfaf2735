// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Changes of the recipe by handles of the body: keys of a pose and constraints.

import type {Change} from '../edit/edit_document';
import {stepsForFound} from '../edit/constraint_changes';
import {placeIndex} from '../edit/edit_view';
import {opToChange, rounded, roundedVector} from './op_to_change';
import type {EditConstraintWords, OpKeys, OpValue, OpWords} from '../protocol/edit_protocol';
import type {Vector} from '../protocol/protocol';
import {boneWords} from '../base/words';

/** Fade before and after a key. */
const WIDTH_S = 0.5;
/** Duration of a new constraint, and of its fades, which are part of it. */
const WINDOW_S = 0.5;
const FADE_S = 0.2;

/** The shown instant, in the motion that an inserted operation receives. */
export interface Instant {
  frame: number; rate_hz: number;
  /** Number of frames. */
  frames: number;
  /** As in EditView. */
  until: number | null;
}

function isVector(value: OpValue | undefined): value is Vector {
  return Array.isArray(value) && value.length === 3 &&
    value.every((part) => typeof part === 'number');
}

function vectorOf(value: OpValue | undefined): Vector {
  return isVector(value) ? value : [0, 0, 0];
}

function sum(a: Vector, b: Vector): Vector {
  return roundedVector([a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
}

/** Returns whether a key is at this frame, to half a frame. */
function isAt(keys: OpKeys, {frame, rate_hz}: Instant): boolean {
  const at = typeof keys.at_s === 'number' ? keys.at_s * rate_hz : keys.at_frame;
  return typeof at === 'number' && Math.abs(at - frame) <= 0.5;
}

/** Moves a hand, a foot or the hips at an instant. A key of the same bone and instant just
 *  before is changed, and removed if it moves nothing any more. */
export function poseChange(bone: string, moved_m: Vector, at: Instant): Change {
  return (ops) => {
    const end = placeIndex(ops, at.until);
    const i = opToChange(ops, end, 'pose@1', (keys) => keys.bone === bone && isAt(keys, at));
    if (i === null) {
      return [{insert: end, op: {do: 'pose@1',
        at_s: rounded(at.frame / at.rate_hz), bone, moved_m: roundedVector(moved_m),
        width_s: WIDTH_S}}];
    }
    const {moved_m: before, ...rest} = ops[i].keys;
    const moved = sum(vectorOf(before), moved_m);
    if (moved.some((part) => part !== 0)) {
      return [{replace: i, op: {...rest, moved_m: moved} as OpKeys}];
    }
    const turns = 'rotation_deg' in rest || 'rotation_wxyz' in rest;
    return turns ? [{replace: i, op: rest as OpKeys}] : [{remove: i}];
  };
}

/** Returns the constraint of a recipe's operation; null if it has none. */
function inlineConstraint({keys}: OpWords): {[key: string]: OpValue} | null {
  const {constraint} = keys;
  return keys.do === 'constrain@1' && typeof constraint === 'object' &&
    !Array.isArray(constraint) ? constraint : null;
}

/** Returns a name that no constraint has: "left hand 1". */
export function newConstraintName(bone: string, ops: readonly OpWords[],
  ids: readonly string[]): string {
  const taken = new Set<OpValue | undefined>([...ids,
    ...ops.map((op) => inlineConstraint(op)?.name)]);
  for (let k = 1; ; ++k) {
    const name = `${boneWords(bone)} ${k}`;
    if (!taken.has(name)) return name;
  }
}

/** Returns the time of a new constraint. At the ends of the motion it has no fade. */
function windowAt({frame, rate_hz, frames}: Instant): {[key: string]: number} {
  const end_s = (frames - 1) / rate_hz;
  const start_s = frame / rate_hz - WINDOW_S / 2;
  const stop_s = frame / rate_hz + WINDOW_S / 2;
  return {
    ...(start_s > 0 ? {start_s: rounded(start_s), start_duration_s: FADE_S} : {start_s: 0}),
    ...(stop_s < end_s ? {stop_s: rounded(stop_s), stop_duration_s: FADE_S}
      : {stop_s: rounded(end_s)}),
  };
}

/** Holds a joint at a place around an instant. `ids`: those of all constraints. */
export function newConstraint(bone: string, position_m: Vector, at: Instant,
  ids: readonly string[]): Change {
  return (ops) => [{insert: placeIndex(ops, at.until), op: {do: 'constrain@1',
    constraint: {type: 'Distance', name: newConstraintName(bone, ops, ids), segment: bone,
      position_m: roundedVector(position_m), ...windowAt(at)}, adapt: true}}];
}

/** Body of the shown motion. */
export interface ShownBody {
  /** As in EditView. */
  until: number | null;
  /** Length of the source's legs to the shown ones. */
  scale: number;
}

/** Returns the change that moves a constraint of the shown motion by `moved_m`; null if it has no
 *  place. A found constraint gets its new place. For one of the recipe only the difference
 *  counts, as operations after its own may have moved it; a retarget after it has scaled it. */
export function constraintChange(constraint: EditConstraintWords, moved_m: Vector,
  ops: readonly OpWords[], {until, scale}: ShownBody): Change | null {
  const own = (op: OpWords): boolean => {
    const inline = inlineConstraint(op);
    return inline?.name === constraint.id && isVector(inline.position_m);
  };
  if (!ops.some(own)) {
    const {id, p_in_world: place, draggable} = constraint;
    if (!place || !draggable || ops.some((op) => inlineConstraint(op)?.name === id)) return null;
    return (now) => stepsForFound(now, until, id, {position_m: sum(place, moved_m)});
  }
  return (now) => {
    const i = now.findIndex(own);
    const inline = i < 0 ? null : inlineConstraint(now[i]);
    if (!inline) return null;
    const isScaled = now.slice(i + 1, until ?? now.length).some(({do: name, off}) =>
      !off && name === 'retarget@1');
    const [x, y, z] = moved_m;
    const k = isScaled ? scale : 1;
    const position_m = sum(vectorOf(inline.position_m), [k * x, k * y, k * z]);
    return [{replace: i, op: {...now[i].keys, constraint: {...inline, position_m}}}];
  };
}

/** Returns whether a constraint acts at this time. */
export function isActiveAt({start_s, stop_s}: EditConstraintWords, time_s: number): boolean {
  const SLACK_S = 1e-3; // Times in recipes are rounded.
  return time_s >= (start_s ?? -Infinity) - SLACK_S && time_s <= (stop_s ?? Infinity) + SLACK_S;
}
