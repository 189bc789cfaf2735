// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Changes by hand of constraints that an operation has found: the key `changes` of constrain@1
// (docs/formats/edit_recipe.md).

import {placeIndex} from './edit_view';
import type {OpKeys, OpStep, OpValue, OpWords} from '../protocol/edit_protocol';

type Table = Record<string, OpValue>;

const isTable = (value: OpValue): value is Table => typeof value === 'object' &&
  !Array.isArray(value);

/** Returns the index of the operation that takes changes of the shown constraints: the last one
 *  that acts, if it finds or changes constraints; -1: none. */
function openOp(ops: readonly OpWords[], end: number): number {
  for (let i = end - 1; i >= 0; --i) {
    const {do: name, off, keys} = ops[i];
    if (off || ['tag@1', 'event@1', 'curve@1'].includes(name)) continue;
    return name === 'constrain@1' && !('constraint' in keys) ? i : -1;
  }
  return -1;
}

/** Returns the steps that set keys of a constraint by its id in the shown motion. A change of the
 *  same constraint in the operation before is replaced. */
export function stepsForFound(ops: readonly OpWords[], until: number | null, id: string,
  keys: Table): OpStep[] {
  const end = placeIndex(ops, until);
  const index = openOp(ops, end);
  if (index < 0) {
    const op: OpKeys = {do: 'constrain@1', changes: [{name: id, ...keys}], adapt: true};
    return [{insert: end, op}];
  }
  const op = ops[index].keys;
  const changes = (Array.isArray(op.changes) ? op.changes : []).filter(isTable);
  // A changed constraint loses the word "found"; its change keeps the earlier name.
  const same = changes.findIndex(({name}) => name === id || name === `found ${id}`);
  const entry = {...(same < 0 ? {name: id} : changes[same]), ...keys};
  const list = same < 0 ? [...changes, entry] : changes.map((one, i) => (i === same ? entry : one));
  return [{replace: index, op: {...op, changes: list}}];
}
