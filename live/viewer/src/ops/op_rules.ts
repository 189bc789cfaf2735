// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Rules between the keys of an operation: keys that exclude or need each other. A change that
// breaks one by itself is completed, so that the operation stays valid.

import type {OpKeys, OpValue} from '../protocol/edit_protocol';
import {recipeKeys} from './op_fields';
import {COMMON, schemaOf} from './op_schema';
import {checkKeys, instantOf, isLater, tablesOf, withChanges} from './op_values';
import type {Changes, Keys, Problems} from './op_values';

/** Maximum bytes of an operation, below the limit of a message to marey. */
const MAX_OP_BYTES = 15_000;

/** Keys that exclude each other: setting one of a list removes those of the others. */
const EXCLUSIVE: Record<string, readonly (readonly string[])[]> = {
  retime: [['knots'], ['speed'], ['duration_s']],
  path: [['points_xz_m'], ['turn_deg', 'length', 'straight']],
  constrain: [['constraint'], ['detect', 'objects', 'changes']],
};

/** Keys of `jump`: setting the first one removes the others. */
const JUMP_EXCLUDES: readonly (readonly [string, readonly string[]])[] = [
  ['apex_m', ['apex_by_m']], ['apex_by_m', ['apex_m']], ['land_m', ['length_m', 'box_m']],
  ['length_m', ['land_m']], ['box_m', ['land_m']],
];

/** Operations that need at least one of these fields. */
const NEED_ONE: Record<string, readonly string[]> = {
  place: ['position_xz_m', 'heading_deg'],
  pose: ['rotation', 'moved_m'],
  offset: ['rotation', 'moved_m'],
  retime: ['knots', 'speed', 'duration_s', 'rate_hz'],
  contacts: ['detect', 'edits'],
  constrain: ['detect', 'constraint', 'changes', 'adapt'],
};

export const NEW_OBJECT: Keys =
  {name: 'box', min_m: [-0.5, 0, -0.5], max_m: [0.5, 1, 0.5]};
const NEW_CUTOFF_HZ = 6;

/** Returns the changes, and the changes of other keys that they need. */
export function completed(op: OpKeys, changes: Changes): Changes {
  const {name} = schemaOf(op);
  const all: Changes = {...changes};
  const isSet = (key: string): boolean => changes[key] !== undefined;
  const lists = EXCLUSIVE[name] ?? [];
  const chosen = lists.find((keys) => keys.some(isSet));
  for (const key of chosen ? lists.filter((keys) => keys !== chosen).flat() : []) {
    all[key] ??= undefined;
  }
  if (name === 'filter') completeFilter(op, changes, all);
  if (name === 'splice' && isSet('blend_s') && changes.blend_s !== 0) all.overlap_s ??= 0;
  if (name === 'splice' && 'overlap_s' in changes && changes.overlap_s !== 0) {
    all.blend_s ??= undefined;
  }
  if (name === 'constrain') completeConstrain(op, changes, all);
  if (name === 'jump') completeJump(changes, all);
  return all;
}

function completeFilter(op: OpKeys, changes: Changes, all: Changes): void {
  if ('method' in changes) {
    const idle = changes.method === 'butterworth' ? ['order'] : ['cutoff', 'cutoff_hz'];
    for (const key of idle) all[key] ??= undefined;
  }
  if ('cutoff' in changes) {
    all.cutoff_hz ??= changes.cutoff === 'given' ? op.cutoff_hz ?? NEW_CUTOFF_HZ : undefined;
  }
  if ('cutoff_hz' in changes) {
    all.cutoff ??= changes.cutoff_hz === undefined ? undefined : 'given';
  }
}

function completeConstrain(op: OpKeys, changes: Changes, all: Changes): void {
  if ('detect' in changes) {
    const objects = tablesOf(op.objects);
    all.objects ??= changes.detect === 'touches'
      ? (objects.length > 0 ? objects : [NEW_OBJECT]) : undefined;
  }
  const made = {...op, ...all};
  if (made.constraint === undefined) all.blend_s ??= undefined;
  if (made.constraint !== undefined || made.detect !== undefined) return;
  for (const key of ['from', 'to'].flatMap((one) => recipeKeys({key: one, kind: 'instant'}))) {
    if (key in op) all[key] ??= undefined;
  }
}

function completeJump(changes: Changes, all: Changes): void {
  for (const [key, others] of JUMP_EXCLUDES) {
    if (changes[key] === undefined) continue;
    for (const other of others) all[other] ??= undefined;
  }
  if ('law' in changes && changes.law !== 'thesis') all.lowest ??= undefined;
  if (changes.lowest !== undefined) all.law ??= 'thesis';
}

/** Returns the operation with these changes, and no others. */
export function changedOp(op: OpKeys, changes: Changes): OpKeys {
  return withChanges(op, changes, [...schemaOf(op).fields, ...COMMON]);
}

/** True for a field that has no meaning with the other keys; it is not shown. */
export function isIdleField(op: OpKeys, key: string): boolean {
  switch (schemaOf(op).name) {
    case 'filter':
      if (key === 'order') return op.method === 'butterworth';
      return (key === 'cutoff' || key === 'cutoff_hz') && op.method !== 'butterworth';
    case 'jump': return key === 'lowest' && op.law !== 'thesis' && !('lowest' in op);
    case 'constrain':
      if (key === 'objects') return op.detect !== 'touches';
      if (key === 'blend_s') return op.constraint === undefined && !('blend_s' in op);
      return (key === 'from' || key === 'to') && op.constraint === undefined &&
        op.detect === undefined && instantOf(op, key) === null;
    default: return false;
  }
}

function checkSpan(keys: Keys, from: string, to: string, problems: Problems, prefix = ''): void {
  if (isLater(instantOf(keys, from), instantOf(keys, to))) {
    problems.set(prefix + to, 'Before the start');
  }
}

function checkAscending(value: OpValue | undefined, key: string, problems: Problems): void {
  const rows = tablesOf(value);
  rows.forEach((row, i) => {
    if (i > 0 && isLater(instantOf(rows[i - 1], 'at'), instantOf(row, 'at'), true)) {
      problems.set(`${key}.${i}.at`, 'Not after the one before');
    }
    if (i > 0 && key === 'knots' && Number(row.time_s) <= Number(rows[i - 1].time_s)) {
      problems.set(`${key}.${i}.time_s`, 'Not after the one before');
    }
  });
}

function checkObjects(op: OpKeys, problems: Problems): void {
  const names = new Set<OpValue>();
  tablesOf(op.objects).forEach((object, i) => {
    if (names.has(object.name)) problems.set(`objects.${i}.name`, 'Another box has this name');
    names.add(object.name);
    checkBox(object, `objects.${i}.`, problems);
  });
  if (op.detect === 'touches' && names.size === 0) problems.set('objects', 'Add a box');
}

function checkBox(keys: Keys, prefix: string, problems: Problems): void {
  const {min_m, max_m} = keys;
  if (!Array.isArray(min_m) || !Array.isArray(max_m)) return;
  if (min_m.some((v, axis) => v > max_m[axis])) {
    problems.set(`${prefix}max_m`, 'Below the lower corner');
  }
}

function checkPoints(value: OpValue | undefined, problems: Problems): void {
  const points = (Array.isArray(value) ? value : []) as number[][];
  if (points.length === 1) problems.set('points_xz_m', 'Two or more points are needed');
  points.forEach(([x, z], i) => {
    if (i === 0 || Math.hypot(x - points[i - 1][0], z - points[i - 1][1]) >= 0.01) return;
    problems.set(`points_xz_m.${i}`, 'Less than 10 mm from the point before');
  });
}

function labelOf(name: string, key: string): string {
  return schemaOf({do: name}).fields.find((field) => field.key === key)?.label ?? key;
}

const CHECKS: Record<string, (op: OpKeys, problems: Problems) => void> = {
  keep: (op, problems) => tablesOf(op.spans).forEach((span, i) =>
    checkSpan(span, 'from', 'to', problems, `spans.${i}.`)),
  split: (op, problems) => checkAscending(op.instants, 'instants', problems),
  retime: (op, problems) => checkAscending(op.knots, 'knots', problems),
  curve: (op, problems) => checkAscending(op.keys, 'keys', problems),
  filter: (op, problems) => {
    if (op.cutoff === 'given' && !('cutoff_hz' in op)) problems.set('cutoff_hz', 'Required');
  },
  path: (op, problems) => checkPoints(op.points_xz_m, problems),
  cyclify: (op, problems) => {
    if (Number(op.min_period_s) > Number(op.max_period_s)) {
      problems.set('max_period_s', 'Less than the shortest cycle');
    }
    checkSpan(op, 'cycle_from', 'cycle_to', problems);
    const has = (key: string): boolean => [key, `${key}_s`, `${key}_frame`].some((one) => one in op);
    for (const [key, other] of [['cycle_from', 'cycle_to'], ['cycle_to', 'cycle_from']]) {
      if (has(other) && !has(key)) problems.set(key, 'Both ends are needed, or none');
    }
  },
  contacts: (op, problems) => tablesOf(op.edits).forEach((edit, i) => {
    if ((edit.do === 'set' || edit.do === 'clear') && edit.from_s > edit.to_s) {
      problems.set(`edits.${i}.to_s`, 'Before the start');
    }
  }),
  constrain: (op, problems) => {
    checkObjects(op, problems);
    if (typeof op.constraint !== 'object' || Array.isArray(op.constraint)) return;
    checkSpan(op.constraint, 'start', 'stop', problems, 'constraint.');
    checkBox(op.constraint, 'constraint.', problems);
  },
  jump: (op, problems) => {
    for (const [key, others] of JUMP_EXCLUDES) {
      const other = others.find((one) => one in op);
      if (key in op && other && !problems.has(other)) problems.set(key, `Excludes “${labelOf('jump', other)}”`);
    }
    if ('lowest' in op && op.law !== 'thesis') problems.set('lowest', 'Needs the law “thesis”');
  },
  exaggerate: (op, problems) => {
    if (Number(op.high_hz ?? 0) !== 0 && Number(op.high_hz) <= Number(op.low_hz ?? 0)) {
      problems.set('high_hz', 'Not above the lowest frequency');
    }
  },
};

/** Returns what is wrong with an operation, by the path of the key. The path "" is the whole
 *  operation. */
export function checkOp(op: OpKeys): Problems {
  const problems: Problems = new Map();
  const schema = schemaOf(op);
  checkKeys([...schema.fields, ...COMMON], op, problems);
  checkSpan(op, 'from', 'to', problems);
  CHECKS[schema.name]?.(op, problems);
  const choices = NEED_ONE[schema.name] ?? [];
  const has = (key: string): boolean => [key, ...recipeKeys({key, kind: 'rotation'})].some(
    (one) => one in op);
  if (choices.length > 0 && !choices.some(has)) {
    const labels = choices.map((key) => schema.fields.find((one) => one.key === key)?.label);
    problems.set('', `One of these is needed: ${labels.join(', ').toLowerCase()}`);
  }
  if (new TextEncoder().encode(JSON.stringify(op)).length > MAX_OP_BYTES) {
    problems.set('', 'Too long for a message to marey: change it in the recipe’s file');
  }
  return problems;
}
