// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Parts that changes of the recipe by the tools in the scene have in common.

import type {OpKeys, OpWords} from '../protocol/edit_protocol';
import type {Vector} from '../protocol/protocol';

/** Operations that change no pose and no time. */
const NOTES = ['tag@1', 'event@1', 'curve@1'];

/** Rounds to three decimals: times to milliseconds, lengths to millimetres. */
export function rounded(value: number): number {
  const whole = Math.round(1000 * value);
  return whole === 0 ? 0 : whole / 1000;
}

export function roundedVector([x, y, z]: Vector): Vector {
  return [rounded(x), rounded(y), rounded(z)];
}

/** Returns whether an operation changes the motion. */
export function acts({do: name, off}: OpWords): boolean {
  return !off && !NOTES.includes(name);
}

/** Returns the index of the operation before `end` that acts last; -1: none. */
export function lastActing(ops: readonly OpWords[], end: number): number {
  for (let i = end - 1; i >= 0; --i) if (acts(ops[i])) return i;
  return -1;
}

/** Returns the index of the operation whose result one that is inserted at `end` receives, if
 *  it is one of `name` that fits; null otherwise. A gesture changes such an operation, so that
 *  recipes stay short. */
export function opToChange(ops: readonly OpWords[], end: number, name: string,
  fits: (keys: OpKeys) => boolean = () => true): number | null {
  const i = lastActing(ops, end);
  return i >= 0 && ops[i].do === name && fits(ops[i].keys) ? i : null;
}

/** Returns the keys without those of this instant: `at`, `at_s`, `at_frame`. */
export function withoutInstant(keys: OpKeys, name: string): OpKeys {
  const {[name]: _name, [`${name}_s`]: _s, [`${name}_frame`]: _frame, ...rest} = keys;
  return rest as OpKeys;
}
