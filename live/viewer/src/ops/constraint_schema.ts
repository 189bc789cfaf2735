// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Keys of [op.constraint] of constrain@1, as in docs/formats/edit_recipe.md.

import type {OpValue} from '../protocol/edit_protocol';
import {choice, LIMITS, number, plain, recipeKeys, text, vector} from './op_fields';
import type {Field} from './op_fields';

const need = {required: true};

export const CONSTRAINT_TYPES: readonly string[] = ['Distance', 'BodyDistance',
  'ConstraintDistance', 'AllowedSpace', 'ForbiddenSpace', 'Orientation', 'Support'];

const BEFORE: readonly Field[] = [
  choice('type', 'Type', CONSTRAINT_TYPES, need),
  text('name', 'Name', need),
  text('segment', 'Segment', {...need, suggest: 'segments'}),
  vector('offset_m', 'Offset on the segment', 'xyz', {absent: 'the joint'}),
];

const AFTER: readonly Field[] = [
  plain('instant', 'start', 'Start', {absent: 'no beginning'}),
  plain('instant', 'stop', 'Stop', {absent: 'no end'}),
  number('start_duration_s', 'Fade-in', LIMITS.time, {default: 0}),
  number('stop_duration_s', 'Fade-out', LIMITS.time, {default: 0}),
  number('priority', 'Priority', LIMITS.importance, {default: 1}),
  number('accuracy_m', 'Accuracy', LIMITS.length, {default: 0.001}),
  number('range', 'Segments that may turn', LIMITS.range, {absent: 'all'}),
];

const distance = number('distance_m', 'Distance', LIMITS.length,
  {default: 0, absent: 'contact', help: '0: contact'});
const box: Field[] = [vector('min_m', 'Lower corner', 'xyz', need),
  vector('max_m', 'Upper corner', 'xyz', need)];

const GOALS: Record<string, readonly Field[]> = {
  Distance: [distance, vector('position_m', 'Position', 'xyz', need)],
  BodyDistance: [distance, text('other_segment', 'Other segment', {...need, suggest: 'segments'}),
    vector('other_offset_m', 'Offset on it', 'xyz', {absent: 'the joint'})],
  ConstraintDistance: [distance, text('other_constraint', 'Other constraint', need)],
  AllowedSpace: box,
  ForbiddenSpace: box,
  Orientation: [plain('rotation', 'orientation', 'Orientation',
    {...need, help: 'In the world, against the T-pose'})],
  Support: [vector('position_m', 'Position', 'xyz', {absent: 'as in the motion'}),
    plain('rotation', 'orientation', 'Orientation', {absent: 'as in the motion'}),
    plain('boolean', 'turns', 'Turns on one point', {default: false})],
};

/** Returns the keys of a constraint of this type. */
export function constraintFields(type: unknown): Field[] {
  return [...BEFORE, ...(GOALS[String(type)] ?? []), ...AFTER];
}

const NEW_VALUES: Record<string, OpValue> = {position_m: [0, 1, 0.3], other_segment: 'leftHand',
  min_m: [-0.5, 0, -0.5], max_m: [0.5, 1, 0.5], orientation_deg: [0, 0, 0]};

/** Returns the constraint with another type: keys that the type has not are removed, and
 *  required ones are added. */
export function constraintOfType(table: Record<string, OpValue>, type: string):
  Record<string, OpValue> {
  const made: Record<string, OpValue> = {};
  for (const field of constraintFields(type)) {
    const keys = recipeKeys(field);
    for (const key of keys) if (key in table) made[key] = table[key];
    const isMissing = field.required && !keys.some((key) => key in made);
    const fresh = keys.find((key) => key in NEW_VALUES);
    if (isMissing && fresh) made[fresh] = NEW_VALUES[fresh];
  }
  return {...made, type};
}
