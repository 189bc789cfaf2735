// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Form fields of lists and tables, and the set of fields of a table.

import {button, el} from '../base/elements';
import type {OpValue} from '../protocol/edit_protocol';
import {constraintFields, constraintOfType} from './constraint_schema';
import {FieldFrame, VectorEntry} from './field_parts';
import type {FieldHost, FieldView} from './field_parts';
import {booleanField, choiceField, groupsField, instantField, numberField, rotationField,
  textField, vectorField} from './field_views';
import {newConstraint, newRow} from './new_op';
import type {Field, PointsField, RowsField, TableField} from './op_fields';
import {rounded, tableOf, tablesOf, withChanges} from './op_values';
import type {Keys, Problems} from './op_values';

function viewOf(field: Field, host: FieldHost): FieldView {
  switch (field.kind) {
    case 'number': return numberField(field, host);
    case 'choice': return choiceField(field, host);
    case 'text': return textField(field, host);
    case 'boolean': return booleanField(field, host);
    case 'instant': return instantField(field, host);
    case 'rotation': return rotationField(field, host);
    case 'groups': return groupsField(field, host);
    case 'vector': return vectorField(field, host);
    case 'points': return new PointsView(field, host);
    case 'rows': return new RowsView(field, host);
    case 'table': return new TableView(field, host);
    case 'constraint': return new ConstraintView(field, host);
  }
}

/** Fields of one table of keys. */
export class FieldSet implements FieldView {
  readonly element = el('div', {class: 'fields'});
  private readonly views: [Field, FieldView][];

  /** `isHidden`: fields without a meaning for the keys. */
  constructor(fields: readonly Field[], host: FieldHost,
    private readonly isHidden: (keys: Keys, key: string) => boolean = () => false) {
    this.views = fields.map((field) => [field, viewOf(field, host)]);
    this.element.append(...this.views.map(([, view]) => view.element));
  }

  show(keys: Keys, problems: Problems, prefix: string, isForced: boolean): void {
    for (const [field, view] of this.views) {
      view.element.hidden = this.isHidden(keys, field.key);
      view.show(keys, problems, prefix, isForced);
    }
  }
}

/** A row of a list with a button that removes it. */
function listRow(content: HTMLElement, name: string, remove: () => void): HTMLElement {
  return el('li', {}, content,
    button({class: 'icon remove-row', title: `Remove this ${name}`, 'aria-label':
      `Remove this ${name}`, onclick: remove}, '×'));
}

/** A list of tables, with buttons that add and remove one. */
class RowsView implements FieldView {
  readonly element: HTMLElement;
  private readonly frame: FieldFrame;
  private readonly list = el('ol', {class: 'op-rows'});
  private readonly add: HTMLButtonElement;
  private readonly sets: FieldSet[] = [];
  private rows: Keys[] = [];

  constructor(private readonly field: RowsField, private readonly host: FieldHost) {
    this.add = button({onclick: () => this.change([...this.rows,
      newRow(field, this.rows, host.shown())])}, `Add ${field.row}`);
    this.frame = new FieldFrame(field, null, this.list, this.add);
    this.element = this.frame.element;
  }

  show(keys: Keys, problems: Problems, prefix: string, isForced: boolean): void {
    const {key} = this.field;
    const isShorter = tablesOf(keys[key]).length < this.rows.length;
    this.rows = tablesOf(keys[key]);
    while (this.sets.length > this.rows.length) {
      this.sets.pop();
      this.list.lastElementChild!.remove();
    }
    while (this.sets.length < this.rows.length) this.append(this.sets.length);
    // After a removal, the inputs of a row belong to another one.
    this.rows.forEach((row, i) =>
      this.sets[i].show(row, problems, `${prefix}${key}.${i}.`, isForced || isShorter));
    this.frame.tell(problems.get(prefix + key) ?? '');
  }

  private append(i: number): void {
    const {field, host} = this;
    const set = new FieldSet(field.fields, {namesId: host.namesId, shown: () => host.shown(),
      set: (changes, isDone) => this.change(this.rows.map((row, k) =>
        k === i ? withChanges(row, changes, field.fields) : row), isDone)});
    this.sets.push(set);
    this.list.append(listRow(set.element, field.row, () => {
      this.change(this.rows.filter((_, k) => k !== i));
      this.add.focus();
    }));
  }

  private change(rows: Keys[], isDone = true): void {
    this.host.set({[this.field.key]: rows}, isDone);
  }
}

/** A list of points. */
class PointsView implements FieldView {
  readonly element: HTMLElement;
  private readonly frame: FieldFrame;
  private readonly list = el('ol', {class: 'op-rows op-points'});
  private readonly add: HTMLButtonElement;
  private readonly entries: VectorEntry[] = [];
  private points: number[][] = [];

  constructor(private readonly field: PointsField, private readonly host: FieldHost) {
    this.add = button({onclick: () => this.change([...this.points, ...this.next()])},
      'Add point');
    this.frame = new FieldFrame(field, null, this.list, this.add);
    this.element = this.frame.element;
  }

  show(keys: Keys, problems: Problems, prefix: string, isForced: boolean): void {
    const path = prefix + this.field.key;
    const value = keys[this.field.key];
    const points = (Array.isArray(value) ? value : []) as number[][];
    const isShorter = points.length < this.points.length;
    this.points = points;
    while (this.entries.length > points.length) {
      this.entries.pop();
      this.list.lastElementChild!.remove();
    }
    while (this.entries.length < points.length) this.append(this.entries.length);
    points.forEach((point, i) => this.entries[i].show(point, isForced || isShorter));
    const wrong = points.findIndex((_, i) => problems.has(`${path}.${i}`));
    this.frame.tell(problems.get(path) ?? this.entries.find(({problem}) => problem)?.problem ??
      (wrong >= 0 ? `Point ${wrong + 1}: ${problems.get(`${path}.${wrong}`)}` : ''));
  }

  /** Continues the path. A new path has two points, because one is not enough. */
  private next(): number[][] {
    const [a, b] = this.points.slice(-2);
    if (!a) return [[0, 0], [0, 1]];
    if (!b) return [[a[0], rounded(a[1] + 1, 3)]];
    return [[rounded(2 * b[0] - a[0], 3), rounded(2 * b[1] - a[1], 3)]];
  }

  private append(i: number): void {
    const {field} = this;
    const entry = new VectorEntry(field.axes, field.unit, `Point ${i + 1}`, 0.01, field,
      (value, isDone) => {
        if (value) this.change(this.points.map((one, k) => k === i ? value : one), isDone);
      }, () => this.frame.tell(entry.problem));
    entry.describe(this.frame.errorId);
    this.entries.push(entry);
    this.list.append(listRow(entry.element, 'point', () => {
      const rest = this.points.filter((_, k) => k !== i);
      this.change(rest.length > 1 ? rest : []);
      this.add.focus();
    }));
  }

  private change(points: number[][], isDone = true): void {
    this.host.set({[this.field.key]: points}, isDone);
  }
}

/** A table of keys that can be absent. */
class TableView implements FieldView {
  readonly element: HTMLElement;
  private readonly frame: FieldFrame;
  private readonly add: HTMLButtonElement;
  private readonly remove: HTMLButtonElement;
  private readonly set: FieldSet;
  private table: Keys | null = null;

  constructor(private readonly field: TableField, host: FieldHost) {
    this.add = button({onclick: () => host.set({[field.key]: {...field.fresh}}, true)}, 'Set');
    this.remove = button({onclick: () => host.set({[field.key]: undefined}, true)},
      `Leave ${field.absent}`);
    this.set = new FieldSet(field.fields, {namesId: host.namesId, shown: () => host.shown(),
      set: (changes, isDone) => host.set(
        {[field.key]: withChanges(this.table ?? {}, changes, field.fields)}, isDone)});
    this.frame = new FieldFrame(field, null, this.set.element, this.add, this.remove);
    this.element = this.frame.element;
  }

  show(keys: Keys, problems: Problems, prefix: string, isForced: boolean): void {
    const {key} = this.field;
    this.table = tableOf(keys[key]);
    this.add.hidden = this.table !== null;
    this.remove.hidden = this.table === null;
    this.set.element.hidden = this.table === null;
    if (this.table) this.set.show(this.table, problems, `${prefix}${key}.`, isForced);
    this.frame.tell(problems.get(prefix + key) ?? '');
  }
}

/** The table of a constraint. */
class ConstraintView implements FieldView {
  readonly element: HTMLElement;
  private readonly frame: FieldFrame;
  private readonly place = el('div');
  private readonly add: HTMLButtonElement;
  private readonly remove: HTMLButtonElement;
  private set: FieldSet | null = null;
  private type: OpValue | undefined;
  private table: Keys | null = null;

  constructor(private readonly field: Field, private readonly host: FieldHost) {
    this.add = button({onclick: () => host.set({[field.key]: newConstraint()}, true)},
      'Add a constraint');
    this.remove = button({onclick: () => host.set({[field.key]: undefined}, true)},
      'Remove the constraint');
    this.frame = new FieldFrame(field, null, this.place, this.add, this.remove);
    this.element = this.frame.element;
  }

  show(keys: Keys, problems: Problems, prefix: string, isForced: boolean): void {
    this.table = tableOf(keys[this.field.key]);
    const {table} = this;
    this.add.hidden = table !== null;
    this.remove.hidden = table === null;
    if (!table) this.set = null;
    else if (!this.set || this.type !== table.type) this.set = this.build(table);
    // Elements that stay are not inserted again: they would lose the focus.
    if (!this.set) this.place.replaceChildren();
    else if (this.place.firstChild !== this.set.element) {
      this.place.replaceChildren(this.set.element);
    }
    if (table) this.set?.show(table, problems, `${prefix}${this.field.key}.`, isForced);
    this.frame.tell(problems.get(prefix + this.field.key) ?? '');
  }

  private build(table: Keys): FieldSet {
    const {host, field} = this;
    const fields = constraintFields(table.type);
    this.type = table.type;
    return new FieldSet(fields, {namesId: host.namesId, shown: () => host.shown(),
      set: (changes, isDone) => {
        const made = 'type' in changes ? constraintOfType(this.table ?? {}, String(changes.type))
          : withChanges(this.table ?? {}, changes, fields);
        host.set({[field.key]: made}, isDone);
      }});
  }
}
