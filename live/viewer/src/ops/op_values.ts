// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Values of keys: reading, changing and checking them.

import type {OpValue} from '../protocol/edit_protocol';
import {constraintFields} from './constraint_schema';
import {MAX_FRAME, MAX_TEXT_BYTES, recipeKeys, ROTATION_DEG} from './op_fields';
import type {Field, NumberField} from './op_fields';

export type Keys = Record<string, OpValue>;
/** New values of keys; undefined removes one. */
export type Changes = Record<string, OpValue | undefined>;
/** Mistakes by the path of a key: "knots.0.time_s". */
export type Problems = Map<string, string>;

export type InstantKind = 's' | 'frame' | 'note';
export interface Instant {kind: InstantKind; value: number | string}

/** Returns the instant KEY of the keys; null: absent. */
export function instantOf(keys: Keys, key: string): Instant | null {
  const [s, frame, note] = recipeKeys({key, kind: 'instant'});
  if (typeof keys[s] === 'number') return {kind: 's', value: keys[s]};
  if (typeof keys[frame] === 'number') return {kind: 'frame', value: keys[frame]};
  if (typeof keys[note] === 'string') return {kind: 'note', value: keys[note]};
  return null;
}

/** Returns the changes that set an instant, or remove it. */
export function instantChanges(key: string, instant: Instant | null): Changes {
  const kinds: InstantKind[] = ['s', 'frame', 'note'];
  return Object.fromEntries(recipeKeys({key, kind: 'instant'}).map((name, i) =>
    [name, instant?.kind === kinds[i] ? instant.value : undefined]));
}

/** True if `a` is known to be after `b`, or at the same time if `orSame`. */
export function isLater(a: Instant | null, b: Instant | null, orSame = false): boolean {
  if (!a || !b || a.kind !== b.kind) return false;
  if (a.kind === 'note') return orSame && a.value === b.value;
  return a.value > b.value || (orSame && a.value === b.value);
}

export function same(a: OpValue | undefined, b: OpValue | undefined): boolean {
  if (a === b) return true;
  if (typeof a !== 'object' || typeof b !== 'object') return false;
  if (Array.isArray(a) !== Array.isArray(b)) return false;
  const names = Object.keys(a);
  return names.length === Object.keys(b).length && names.every((name) =>
    name in b && same((a as Keys)[name], (b as Keys)[name]));
}

/** Returns the keys with these changes. Values that the absence of a key means are removed. */
export function withChanges<K extends Keys>(keys: K, changes: Changes,
  fields: readonly Field[]): K {
  const made: Keys = {...keys};
  for (const [key, value] of Object.entries(changes)) {
    const field = fields.find((one) => recipeKeys(one).includes(key));
    const isIdle = value === undefined || (field && !field.required &&
      (same(value, field.default) || (Array.isArray(value) && value.length === 0) ||
       (value === '' && field.kind !== 'instant')));
    if (isIdle) delete made[key];
    else made[key] = value;
  }
  return made as K;
}

/** Returns the tables of a list; an empty list if it is absent. */
export function tablesOf(value: OpValue | undefined): Keys[] {
  return Array.isArray(value) ? value.filter((one): one is Keys =>
    typeof one === 'object' && !Array.isArray(one)) : [];
}

/** Returns a table; null: absent, or of another type. */
export function tableOf(value: OpValue | undefined): Keys | null {
  return typeof value === 'object' && !Array.isArray(value) ? value : null;
}

/** Returns what is wrong with a number; empty: nothing. */
export function numberProblem(value: OpValue | undefined,
  {min, max, isWhole}: Pick<NumberField, 'min' | 'max' | 'isWhole'>): string {
  if (typeof value !== 'number' || !Number.isFinite(value)) return 'Not a number';
  if (isWhole && !Number.isInteger(value)) return 'Not a whole number';
  if (value >= min && value <= max) return '';
  return value < min && max >= 1e6 ? `Less than ${min}` : `Not between ${min} and ${max}`;
}

/** Returns what is wrong with a line of text; empty: nothing. */
export function textProblem(value: OpValue | undefined): string {
  if (typeof value !== 'string') return 'Not a text';
  if ([...value].some((c) => c < ' ' || c === '\x7f')) return 'Not a single line';
  return new TextEncoder().encode(value).length > MAX_TEXT_BYTES
    ? `Longer than ${MAX_TEXT_BYTES} bytes` : '';
}

function vectorProblem(value: OpValue | undefined, size: number,
  limits: Pick<NumberField, 'min' | 'max'>): string {
  if (!Array.isArray(value) || value.length !== size) return `Not ${size} numbers`;
  return value.map((one) => numberProblem(one, limits)).find(Boolean) ?? '';
}

function instantProblem(instant: Instant): string {
  const {kind, value} = instant;
  if (kind === 'note') return value === '' ? 'Name an annotation' : textProblem(value);
  return numberProblem(value, {min: 0, max: kind === 's' ? 1e6 : MAX_FRAME});
}

function rotationProblem(keys: Keys, [deg, wxyz]: string[]): string {
  if (deg in keys) return vectorProblem(keys[deg], 3, ROTATION_DEG);
  const q = keys[wxyz];
  const problem = vectorProblem(q, 4, {min: -1.001, max: 1.001});
  if (problem) return problem;
  return Math.abs(Math.hypot(...(q as number[])) - 1) > 1e-3 ? 'Its length is not 1' : '';
}

/** Returns what is wrong with a value that is there; empty: nothing. Lists and tables have
 *  problems of their own. */
function valueProblem(field: Field, keys: Keys): string {
  const value = keys[field.key];
  switch (field.kind) {
    case 'number': return numberProblem(value, field);
    case 'text': return textProblem(value);
    case 'boolean': return typeof value === 'boolean' ? '' : 'Not true or false';
    case 'choice': return field.supply || field.choices.includes(value as string | number)
      ? '' : `Not one of ${field.choices.join(', ')}`;
    case 'groups': return Array.isArray(value) && value.length > 0 ? '' : 'Choose a part';
    case 'instant': return instantProblem(instantOf(keys, field.key) ?? {kind: 's', value: ''});
    case 'rotation': return rotationProblem(keys, recipeKeys(field));
    case 'vector': return vectorProblem(value, field.axes.length, field);
    default: return '';
  }
}

/** Adds what is wrong with the keys. */
export function checkKeys(fields: readonly Field[], keys: Keys, problems: Problems,
  prefix = ''): void {
  for (const field of fields) {
    const path = prefix + field.key;
    const isThere = recipeKeys(field).some((key) => key in keys);
    const value = keys[field.key];
    if (!isThere || value === '' || (Array.isArray(value) && value.length === 0)) {
      if (field.required) problems.set(path, 'Required');
      else if (isThere && field.kind === 'instant') problems.set(path, 'Name an annotation');
      continue;
    }
    const problem = valueProblem(field, keys);
    if (problem) problems.set(path, problem);
    if (field.kind === 'rows') {
      tablesOf(value).forEach((row, i) =>
        checkKeys(field.fields, row, problems, `${path}.${i}.`));
    } else if (field.kind === 'points') {
      (Array.isArray(value) ? value : []).forEach((point, i) => {
        const wrong = vectorProblem(point, field.axes.length, field);
        if (wrong) problems.set(`${path}.${i}`, wrong);
      });
    } else if (field.kind === 'table') {
      const table = tableOf(value);
      if (table) checkKeys(field.fields, table, problems, `${path}.`);
      else problems.set(path, 'Not a table');
    } else if (field.kind === 'constraint') {
      const table = value as Keys;
      checkKeys(constraintFields(table.type), table, problems, `${path}.`);
    }
  }
}

export function rounded(value: number, decimals: number): number {
  const scale = 10 ** decimals;
  return Math.round(value * scale) / scale + 0;
}

/** Converts axis times angle in degrees to a quaternion w x y z, rounded to six decimals. */
export function quaternionOf(rotation_deg: readonly number[]): number[] {
  const angle = Math.hypot(...rotation_deg);
  if (angle === 0) return [1, 0, 0, 0];
  const half = angle * Math.PI / 360;
  return [Math.cos(half), ...rotation_deg.map((v) => v / angle * Math.sin(half))]
    .map((v) => rounded(v, 6));
}

/** Converts a unit quaternion w x y z to axis times angle in degrees, rounded to 0.001. */
export function rotationOf([w, ...v]: readonly number[]): number[] {
  const sine = Math.hypot(...v);
  if (sine === 0) return [0, 0, 0];
  const sign = w < 0 ? -1 : 1;
  const angle = 2 * Math.atan2(sine, sign * w) * 180 / Math.PI;
  return v.map((one) => rounded(sign * one / sine * angle, 3));
}
