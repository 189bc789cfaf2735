// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Operations and their figures in short words.

import {boneWords, fixed} from '../base/words';
import type {FindingWords, OpKeys, OpReportWords, OpValue} from '../protocol/edit_protocol';
import {recipeKeys} from './op_fields';
import type {Field} from './op_fields';
import {BONES, schemaOf} from './op_schema';
import {instantOf, rotationOf} from './op_values';
import type {Instant, Keys} from './op_values';

const MAX_WORDS = 90;

/** Formats a number with at most three decimals. */
export function plainNumber(value: number): string {
  return String(Math.round(value * 1000) / 1000 + 0).replace('-', '−');
}

export function instantWords({kind, value}: Instant): string {
  if (kind === 'note') return String(value);
  return kind === 's' ? `${fixed(Number(value), 2)}\u00a0s` : `frame ${plainNumber(Number(value))}`;
}

function spanWords(keys: Keys, from: string, to: string): string {
  const [start, end] = [instantOf(keys, from), instantOf(keys, to)];
  if (start && end) return `${instantWords(start)} to ${instantWords(end)}`;
  if (start) return `from ${instantWords(start)}`;
  return end ? `to ${instantWords(end)}` : '';
}

/** Formats a number with its unit: 90°, 0.5×, 1.2 s. */
export function withUnit(value: number, unit: string): string {
  if (unit === 'degrees') return `${plainNumber(value)}°`;
  if (unit === 'factor') return `${plainNumber(value)}×`;
  return unit ? `${plainNumber(value)}\u00a0${unit}` : plainNumber(value);
}

function numbers(value: OpValue | undefined): string {
  return (Array.isArray(value) ? value : []).map((one) => plainNumber(Number(one))).join(', ');
}

function choiceWords(field: Field, value: OpValue): string {
  const words = String(value);
  // The cut-off itself follows.
  if (field.key === 'cutoff' && words === 'given') return '';
  if (BONES.includes(words)) return boneWords(words);
  if (typeof value === 'number' || field.key === 'drift') {
    return `${field.label.toLowerCase()} ${words}`;
  }
  return words.replaceAll('_', ' ');
}

function constraintWords(value: OpValue | undefined): string {
  if (typeof value !== 'object' || Array.isArray(value)) return '';
  const {type, name, segment} = value;
  const span = spanWords(value, 'start', 'stop');
  return `${String(type)} “${String(name)}” of ${boneWords(String(segment))}` +
    (span && `, ${span}`);
}

function count(value: OpValue | undefined, one: string): string {
  const length = Array.isArray(value) ? value.length : 0;
  return `${length} ${length === 1 ? one : one.endsWith('x') ? `${one}es` : `${one}s`}`;
}

function tableWords(fields: readonly Field[], table: Keys): string {
  return fields.filter(({key}) => key in table).map((field) => fieldWords(field, table))
    .join(', ');
}

function fieldWords(field: Field, keys: Keys): string {
  const value = keys[field.key];
  const label = field.label.toLowerCase();
  switch (field.kind) {
    case 'number': return `${label} ${withUnit(Number(value), field.unit)}`;
    case 'choice': return choiceWords(field, value);
    case 'boolean': return value === true ? label : `not: ${label}`;
    case 'text': return `“${String(value)}”`;
    case 'instant': return `${label} ${instantWords(instantOf(keys, field.key)!)}`;
    case 'vector': return `${label} ${numbers(value)}\u00a0${field.unit}`;
    case 'rotation': {
      const [deg, wxyz] = recipeKeys(field);
      const shown = keys[deg] ?? rotationOf((keys[wxyz] as number[]) ?? [1, 0, 0, 0]);
      return `${label} ${numbers(shown)}°`;
    }
    case 'groups': return (value as string[]).map((one) => one.replace('_', ' ')).join(', ');
    case 'points': return count(value, 'point');
    case 'rows': return count(value, field.row);
    case 'table': return `${label} ${tableWords(field.fields, value as Keys)}`;
    case 'constraint': return constraintWords(value);
  }
}

/** Returns the keys of an operation in a line: "0.40 s to left.strike[2]". Empty: it has only
 *  default values. */
export function summaryOf(op: OpKeys): string {
  const schema = schemaOf(op);
  const parts = [spanWords(op, 'from', 'to')];
  for (const field of schema.fields) {
    if (recipeKeys(field).some((key) => key in op)) parts.push(fieldWords(field, op));
  }
  if (Array.isArray(op.groups)) {
    parts.push(op.groups.map((group) => String(group).replace('_', ' ')).join(', '));
  }
  if (typeof op.blend_s === 'number') parts.push(`fade ${withUnit(op.blend_s, 's')}`);
  const words = parts.filter(Boolean).join('; ');
  return words.length > MAX_WORDS ? `${words.slice(0, MAX_WORDS - 1)}…` : words;
}

const UNITS: readonly (readonly [string, string])[] = [
  ['_kg_m2_per_s', 'kg m²/s'], ['_cm_per_s', 'cm/s'], ['_deg_per_s', '°/s'], ['_m_per_s2', 'm/s²'], ['_m_per_s', 'm/s'],
  ['_mm', 'mm'], ['_ms', 'ms'], ['_deg', '°'], ['_hz', 'Hz'], ['_frames', 'frames'], ['_m', 'm'],
  ['_g', 'g'], ['_s', 's'],
];

/** Returns the words, the value and the unit of a figure by its name: displaced_mm. */
export function figureWords(name: string, value: number): [string, string] {
  const [ending, unit] = UNITS.find(([one]) => name.endsWith(one)) ?? ['', ''];
  const words = name.slice(0, name.length - ending.length).replaceAll('_', ' ');
  const digits = Math.abs(value) >= 100 || Number.isInteger(value) ? 0
    : Math.abs(value) >= 10 ? 1 : 2;
  const space = unit === '' || unit === '°' || unit === '°/s' ? '' : '\u00a0';
  return [words, `${fixed(value, digits)}${space}${unit}`];
}

/** Figures that a reader wants first. */
const FIRST = ['displaced_mm', 'slide_mm', 'slide_after_mm', 'tilt_deg', 'turn_deg',
  'worst_constraint_mm', 'unmet', 'max_shift_mm', 'gap_mm', 'seam', 'duration_s', 'moved_m',
  'feet_moved_mm', 'lowered_mm', 'found', 'frames'];

function rank(name: string): number {
  const place = FIRST.indexOf(name);
  return place < 0 ? FIRST.length : place;
}

/** Returns the figures of the reports of one operation, important ones first. Several
 *  motions have the figure of the largest magnitude. */
export function figuresOf(reports: readonly OpReportWords[]): [string, number][] {
  const largest = new Map<string, number>();
  for (const {figures} of reports) {
    for (const [name, value] of Object.entries(figures)) {
      const known = largest.get(name);
      if (known === undefined || Math.abs(value) > Math.abs(known)) largest.set(name, value);
    }
  }
  return [...largest].sort(([a], [b]) => rank(a) - rank(b));
}

const SEVERITIES: readonly FindingWords['severity'][] = ['poor', 'fair', 'note'];

/** Returns the findings of the reports of one operation, severe ones first. */
export function findingsOf(reports: readonly OpReportWords[]): FindingWords[] {
  return reports.flatMap(({findings}) => findings).sort((a, b) =>
    SEVERITIES.indexOf(a.severity) - SEVERITIES.indexOf(b.severity));
}
