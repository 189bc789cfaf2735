// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Kinds of keys that operations have, and short constructors for tables of them.

/** Names of choices that only the recipe knows. */
export type Supply = 'sources' | 'avatars';

interface Common {
  /** Key in the recipe. An instant KEY is KEY_s, KEY_frame or KEY; a rotation KEY is KEY_deg or
   *  KEY_wxyz. */
  key: string;
  label: string;
  help: string;
  required: boolean;
  /** Value that the absence of the key means. */
  default?: number | string | boolean;
  /** Meaning of the absence of the key if it is not a value: "best frame". */
  absent: string;
}

export interface NumberField extends Common {
  kind: 'number'; unit: string; min: number; max: number; step: number; isWhole?: boolean;
}
export interface ChoiceField extends Common {
  kind: 'choice'; choices: readonly (string | number)[]; supply?: Supply;
}
export interface TextField extends Common {kind: 'text'; suggest?: 'segments'}
export interface PlainField extends Common {kind: 'boolean' | 'instant' | 'rotation' | 'groups'}
export interface VectorField extends Common {
  kind: 'vector'; unit: string; axes: readonly string[]; min: number; max: number;
}
/** A list of vectors. */
export interface PointsField extends Common {
  kind: 'points'; unit: string; axes: readonly string[]; min: number; max: number;
}
/** A list of tables. */
export interface RowsField extends Common {kind: 'rows'; row: string; fields: readonly Field[]}
/** A table of keys. `fresh`: its values when it is added. */
export interface TableField extends Common {
  kind: 'table'; fields: readonly Field[]; fresh: Readonly<Record<string, number>>;
}
/** The table of a constraint; its keys depend on its type. */
export interface ConstraintField extends Common {kind: 'constraint'}

export type Field = NumberField | ChoiceField | TextField | PlainField | VectorField |
  PointsField | RowsField | TableField | ConstraintField;

export type Rest = Partial<Pick<Common, 'help' | 'required' | 'absent' | 'default'>>;

function common(key: string, label: string, rest: Rest): Common {
  return {key, label, help: '', required: false, absent: 'none', ...rest};
}

/** Range, unit and step of a kind of number: ranges that recipes and operations accept. */
export interface Limits {
  unit: string; min: number; max: number; step: number; isWhole?: boolean;
}

export const LIMITS = {
  time: {unit: 's', min: 0, max: 1e6, step: 0.01},
  fade: {unit: 's', min: 0, max: 1e3, step: 0.05},
  duration: {unit: 's', min: 1e-3, max: 1e6, step: 0.05},
  frequency: {unit: 'Hz', min: 0.01, max: 1000, step: 0.5},
  band: {unit: 'Hz', min: 0, max: 1000, step: 0.1},
  rate: {unit: 'Hz', min: 1, max: 2000, step: 1},
  speed: {unit: 'factor', min: 0.05, max: 20, step: 0.05},
  factor: {unit: 'factor', min: 0.01, max: 100, step: 0.05},
  gain: {unit: 'factor', min: -10, max: 10, step: 0.1},
  place: {unit: 'm', min: -1e4, max: 1e4, step: 0.01},
  length: {unit: 'm', min: 0, max: 1e4, step: 0.001},
  turn: {unit: 'degrees', min: -36000, max: 36000, step: 1},
  cycles: {unit: '', min: 1, max: 10000, step: 1, isWhole: true},
  value: {unit: '', min: -1e9, max: 1e9, step: 0.1},
  importance: {unit: '', min: 1e-6, max: 1e6, step: 1},
  range: {unit: '', min: 1, max: 1e6, step: 1, isWhole: true},
  jump: {unit: '', min: 1, max: 10000, step: 1, isWhole: true},
  apex: {unit: 'm', min: 0.01, max: 100, step: 0.01},
  rise: {unit: 'm', min: -100, max: 100, step: 0.01},
  distance: {unit: 'm', min: 0, max: 100, step: 0.01},
  box: {unit: 'm', min: -20, max: 20, step: 0.01},
  flight: {unit: 's', min: 0.02, max: 20, step: 0.01},
  push: {unit: 's', min: 0.05, max: 10, step: 0.01},
  share: {unit: '', min: 0.001, max: 0.999, step: 0.01},
  strength: {unit: 'g', min: 0.5, max: 100, step: 0.1},
  gravity: {unit: 'm/s²', min: 0.5, max: 30, step: 0.01},
} satisfies Record<string, Limits>;

/** Angles of `rotation_deg`, and frames of instants. */
export const ROTATION_DEG = {min: -360, max: 360};
export const MAX_FRAME = 1e9;
export const MAX_TEXT_BYTES = 1000;

export function number(key: string, label: string, limits: Limits, rest: Rest = {}): NumberField {
  return {...common(key, label, rest), kind: 'number', ...limits};
}

export function choice(key: string, label: string, choices: readonly (string | number)[],
  rest: Rest & {supply?: Supply} = {}): ChoiceField {
  return {...common(key, label, rest), kind: 'choice', choices};
}

export function text(key: string, label: string, rest: Rest & {suggest?: 'segments'} = {}):
  TextField {
  return {...common(key, label, rest), kind: 'text'};
}

export function plain(kind: PlainField['kind'], key: string, label: string, rest: Rest = {}):
  PlainField {
  return {...common(key, label, rest), kind};
}

export function vector(key: string, label: string, axes: string, rest: Rest = {}): VectorField {
  const {unit, min, max} = LIMITS.place;
  return {...common(key, label, rest), kind: 'vector', unit, axes: [...axes], min, max};
}

export function points(key: string, label: string, axes: string, rest: Rest = {}): PointsField {
  const {unit, min, max} = LIMITS.place;
  return {...common(key, label, rest), kind: 'points', unit, axes: [...axes], min, max};
}

export function rows(key: string, label: string, row: string, fields: readonly Field[],
  rest: Rest = {}): RowsField {
  return {...common(key, label, rest), kind: 'rows', row, fields};
}

export function table(key: string, label: string, fields: readonly Field[],
  fresh: Readonly<Record<string, number>>, rest: Rest = {}): TableField {
  return {...common(key, label, rest), kind: 'table', fields, fresh};
}

/** Returns the keys of the recipe that belong to a field. */
export function recipeKeys(field: Pick<Field, 'key' | 'kind'>): string[] {
  const {key, kind} = field;
  if (kind === 'instant') return [`${key}_s`, `${key}_frame`, key];
  if (kind === 'rotation') return [`${key}_deg`, `${key}_wxyz`];
  return [key];
}
