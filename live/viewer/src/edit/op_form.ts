// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The form of one operation. Typing previews, a finished value is committed, Escape restores.

import {el, setText} from '../base/elements';
import type {OpKeys, OpWords} from '../protocol/edit_protocol';
import type {Change} from './edit_document';
import type {EditView} from './edit_view';
import {newId} from '../ops/field_parts';
import type {FieldHost} from '../ops/field_parts';
import {FieldSet} from '../ops/list_views';
import {changedOp, checkOp, completed, isIdleField} from '../ops/op_rules';
import {commonFields, COMMON, schemaOf} from '../ops/op_schema';
import {recipeKeys} from '../ops/op_fields';
import {same} from '../ops/op_values';
import type {Changes} from '../ops/op_values';
import type {Shown} from '../ops/new_op';

export interface FormHost {
  readonly view: EditView;
  /** Index of the edited operation; null: it no longer exists. */
  index(): number | null;
  shown(): Shown;
}

export class OpForm {
  readonly element = el('div', {class: 'op-form', onkeydown: (event: KeyboardEvent) => {
    if (event.key !== 'Escape' || !this.isChanged) return;
    event.stopPropagation();
    this.restore();
  }});
  private readonly help = el('p', {class: 'hint'});
  private readonly problem = el('p', {class: 'field-error', role: 'alert'});
  private readonly names = el('datalist', {id: newId()});
  private readonly fields: FieldHost;
  private main: FieldSet | null = null;
  private more: FieldSet | null = null;
  private op: OpWords | null = null;
  /** Values that are not in the recipe yet. */
  private pending: Changes = {};
  private isPreviewing = false;
  /** Increases with each opened operation. */
  private opened = 0;

  constructor(private readonly host: FormHost) {
    this.fields = {namesId: this.names.id, shown: () => host.shown(),
      set: (changes, isDone) => this.set(changes, isDone)};
  }

  /** Builds the form of another operation. */
  open(op: OpWords): void {
    this.op = op;
    this.pending = {};
    this.endPreview();
    this.opened += 1;
    const schema = schemaOf(op);
    const common = commonFields(schema);
    // A key that the operation cannot use is shown if it is there, so that it can be removed.
    common.push(...COMMON.filter((field) => !common.includes(field) &&
      recipeKeys(field).some((key) => key in op.keys)));
    const spans = schema.isOfSpan ? common.filter(({key}) => key === 'from' || key === 'to') : [];
    const rest = common.filter((field) => !spans.includes(field));
    const isHidden = (keys: Changes, key: string): boolean => isIdleField(keys as OpKeys, key);
    this.main = new FieldSet([...spans, ...schema.fields], this.fields, isHidden);
    this.more = new FieldSet(rest, this.fields, isHidden);
    const isUsed = rest.some((field) => recipeKeys(field).some((key) => key in op.keys));
    setText(this.help, `${schema.help}.`);
    this.element.replaceChildren(this.help, this.main.element, el('details',
      {class: 'op-more', open: isUsed}, el('summary', {}, 'More'), this.more.element),
    this.problem, this.names);
    this.show(true);
  }

  /** Ends a preview. */
  close(): void {
    this.pending = {};
    this.opened += 1;
    this.endPreview();
  }

  /** Shows new values of the same operation. Values that the user is typing stay. */
  update(op: OpWords): void {
    if (this.op && this.op.do === op.do) {
      this.op = op;
      this.show(false);
    } else this.open(op);
  }

  /** Names of annotations of the shown motion. */
  setNames(names: readonly string[]): void {
    const shown = [...this.names.children].map((one) => (one as HTMLOptionElement).value);
    if (shown.length === names.length && shown.every((name, i) => name === names[i])) return;
    this.names.replaceChildren(...names.map((value) => el('option', {value})));
  }

  private get isChanged(): boolean {
    return Object.keys(this.pending).length > 0 || this.isPreviewing ||
      this.element.querySelector('.wrong') !== null;
  }

  private restore(): void {
    this.pending = {};
    this.endPreview();
    this.show(true);
  }

  private show(isForced: boolean): void {
    if (!this.op) return;
    const keys = changedOp(this.op.keys, this.pending);
    const problems = checkOp(keys);
    this.main?.show(keys, problems, '', isForced);
    this.more?.show(keys, problems, '', isForced);
    const whole = problems.get('') ?? '';
    setText(this.problem, whole);
    this.problem.hidden = whole === '';
  }

  private set(changes: Changes, isDone: boolean): void {
    if (!this.op) return;
    const draft = changedOp(this.op.keys, this.pending);
    Object.assign(this.pending, completed(draft, changes));
    const keys = changedOp(this.op.keys, this.pending);
    const isValid = checkOp(keys).size === 0;
    const isNew = !same(keys, this.op.keys);
    if (!isNew && isDone) this.pending = {};
    this.show(false);
    if (!isNew) this.endPreview();
    else if (isValid && isDone) void this.commit();
    else if (isValid) {
      this.isPreviewing = true;
      this.host.view.preview(this.change());
    }
  }

  private endPreview(): void {
    if (this.isPreviewing) this.host.view.cancel();
    this.isPreviewing = false;
  }

  /** Applies the values to the operation as it is when the change is sent, so that values of
   *  other pages stay. */
  private change(): Change {
    const pending = {...this.pending};
    const name = this.op?.do;
    return (ops) => {
      const index = this.host.index();
      const op = index === null ? undefined : ops[index];
      if (index === null || !op || op.do !== name) return null;
      const made = changedOp(op.keys, pending);
      return same(made, op.keys) ? null : [{replace: index, op: made}];
    };
  }

  private async commit(): Promise<void> {
    const sent = {...this.pending};
    const {opened} = this;
    this.isPreviewing = false;
    await this.host.view.commit(this.change());
    if (this.opened !== opened) return;
    // The recipe has them now, or they were refused.
    for (const [key, value] of Object.entries(sent)) {
      if (same(this.pending[key], value)) delete this.pending[key];
    }
    this.show(false);
  }
}
