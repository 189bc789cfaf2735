// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The table of operations has the keys, types, defaults and choices of the documentation.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import test from 'node:test';
import {CONSTRAINT_TYPES, constraintFields} from '../src/ops/constraint_schema';
import type {Field} from '../src/ops/op_fields';
import {COMMON, GROUPS, OP_MENU, OPS} from '../src/ops/op_schema';

const page = readFileSync(new URL('../../../docs/formats/edit_recipe.md', import.meta.url), 'utf8');

/** Returns the rows of the first table after a line that begins with `heading`. */
function tableAfter(heading: string): string[][] {
  const lines = page.split('\n');
  const start = lines.findIndex((line) => line.startsWith(heading));
  assert.ok(start >= 0, heading);
  const first = lines.findIndex((line, i) => i > start && line.startsWith('|'));
  const rows: string[][] = [];
  for (let i = first + 2; lines[i].startsWith('|'); ++i) {
    rows.push(lines[i].slice(1, -1).split('|').map((cell) => cell.trim()));
  }
  return rows;
}

const quoted = (cell: string): string[] => [...cell.matchAll(/`([^`]+)`/g)].map(([, one]) => one);

interface Documented {key: string; type: string; fallback: string}

/** Returns a row of a table for each of its keys. */
function keysOf(cells: [string, string, string]): Documented[] {
  const [keys, type, fallback] = cells;
  const names = quoted(keys);
  // "0, no limit": one default for each key.
  const parts = fallback.split(', ');
  return names.map((key, i) => ({key, type,
    fallback: parts.length === names.length ? parts[i] : fallback}));
}

/** Returns the key in the documentation of each field: a rotation has two. */
function documentedKeys(field: Field): string[] {
  return field.kind === 'rotation' ? [`${field.key}_deg`, `${field.key}_wxyz`] : [field.key];
}

const plain = (text: string): string => text.replaceAll('`', '').replaceAll('"', '');

function checkDefault(field: Field, fallback: string, place: string): void {
  const words = plain(fallback);
  assert.equal(field.required, words === 'required', place);
  if (field.required) return;
  const isValue = /^(-?[0-9.]+|true|false)$/.test(words) || fallback.includes('"');
  if (isValue) assert.equal(String(field.default), words, place);
  else if (field.default === undefined) assert.ok(words === '' || field.absent === words, place);
  else assert.equal(field.absent, words, place);
}

function checkType(field: Field, type: string, place: string): void {
  if (field.kind === 'choice') {
    const words = quoted(type).map(plain);
    const numbers = type.match(/^([0-9]+, )*[0-9]+$/) ? type.split(', ') : [];
    const choices = [...words, ...numbers];
    if (choices.length > 0) assert.deepEqual(field.choices.map(String), choices, place);
  } else if (field.kind === 'boolean') {
    assert.equal(type, 'true or false', place);
  } else if (field.kind === 'instant') {
    assert.match(type, /^instants?$/, place);
  } else if (field.kind === 'rotation') {
    assert.equal(type, 'rotation', place);
  } else if (field.kind === 'number' && /^-?[0-9]/.test(type)) {
    const range = `${field.min} to ${field.max}`;
    assert.ok(type === range || type === `${range} ${field.unit}`, place);
  } else if (field.kind === 'number') {
    assert.equal(type, field.unit, place);
  } else if (field.kind === 'vector') {
    assert.equal(type, `\`[${field.axes.join(', ')}]\`, m`, place);
  } else if (field.kind === 'points') {
    assert.equal(type, `\`[[${field.axes.join(', ')}], ...]\`, m`, place);
  } else if (field.kind === 'table') {
    const keys = [...plain(type).matchAll(/(\w+) = /g)].map(([, key]) => key);
    assert.deepEqual(field.fields.map(({key}) => key), keys, place);
    assert.deepEqual(Object.keys(field.fresh), keys, place);
  } else if (field.kind === 'rows' && type.startsWith('`')) {
    const keys = [...plain(type).matchAll(/(\w+) = /g)].map(([, key]) => key.replace(/_s$/, ''));
    assert.deepEqual(field.fields.map(({key}) => key.replace(/_s$/, '')), keys, place);
  }
}

function compare(fields: readonly Field[], documented: readonly Documented[], place: string):
  void {
  assert.deepEqual(fields.flatMap(documentedKeys), documented.map(({key}) => key), place);
  for (const field of fields) {
    const {type, fallback} = documented.find(({key}) => key === documentedKeys(field)[0])!;
    checkDefault(field, fallback, `${place}: ${field.key}`);
    checkType(field, type, `${place}: ${field.key}`);
  }
}

test('every operation and key of the documentation is in the table, and no other', () => {
  const documented = new Map<string, Documented[]>();
  let name = '';
  for (const [op, keys, type, fallback] of tableAfter('## Operations')) {
    if (op) name = quoted(op)[0];
    const list = documented.get(name) ?? [];
    documented.set(name, [...list, ...keysOf([keys, type, fallback])]);
  }
  assert.equal(documented.size, 24);
  assert.deepEqual(OPS.map((op) => op.name).sort(), [...documented.keys()].sort());
  for (const op of OPS) {
    // The order of keys is the page's own.
    const keys = documented.get(op.name)!;
    const order = (key: string): number => op.fields.flatMap(documentedKeys).indexOf(key);
    compare(op.fields, [...keys].sort((a, b) => order(a.key) - order(b.key)), op.name);
  }
});

test('the menu offers each operation once', () => {
  const offered = OP_MENU.flatMap(([, ops]) => ops.map((op) => op.name));
  assert.equal(offered.length, 24);
  assert.equal(new Set(offered).size, 24);
});

test('the common keys are those of the documentation', () => {
  const rows = tableAfter('## Keys of all operations');
  const documented = new Map(rows.flatMap(([keys, type, fallback]) =>
    quoted(keys).map((key) => [key, {key, type, fallback}])));
  for (const key of ['do', 'off']) assert.ok(documented.delete(key));
  assert.deepEqual(COMMON.map((field) => field.key).sort(), [...documented.keys()].sort());
  for (const field of COMMON) checkDefault(field, documented.get(field.key)!.fallback, field.key);
  assert.deepEqual(GROUPS, quoted(documented.get('groups')!.type).map(plain));
});

test('the keys of each type of constraint are those of the documentation', () => {
  const rows = tableAfter('**[op.constraint]**');
  assert.equal(CONSTRAINT_TYPES.length, 7);
  for (const type of CONSTRAINT_TYPES) {
    const documented: Documented[] = [];
    for (const [cell, kind, fallback] of rows) {
      const [keys, types] = cell.includes('(') ? cell.split('(') : [cell, ''];
      if (types && !quoted(types).includes(type)) continue;
      const isOptional = types.includes(`optional for \`${type}\``);
      const defaults = fallback.split('; ');
      const kinds = kind.split('; ');
      quoted(keys).forEach((key, i) => documented.push({key, type: kinds[i] ?? kind,
        fallback: isOptional ? 'as in the motion' : defaults[i] ?? defaults[0]}));
    }
    const fields = constraintFields(type);
    assert.deepEqual(fields.flatMap(documentedKeys).sort(),
      documented.map(({key}) => key).sort(), type);
    for (const field of fields) {
      const {fallback} = documented.find(({key}) => key === documentedKeys(field)[0])!;
      // Two keys in a row have one default each, separated by a comma; or "false: …".
      const words = fallback.split(': ');
      const two = fallback.split(', ');
      if (field.key === 'start' || field.key === 'stop') {
        assert.equal(field.absent, two[field.key === 'start' ? 0 : 1], type);
      } else if (/^(0|false)$/.test(words[0])) {
        assert.equal(String(field.default), words[0], `${type}: ${field.key}`);
      } else {
        checkDefault(field, fallback, `${type}: ${field.key}`);
      }
    }
  }
});
