// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Shows an open operation below its row: actions, all figures, and its form.

import {button, el, keepRows, setText} from '../base/elements';
import {capitalized} from '../base/words';
import type {OpReportWords, OpWords} from '../protocol/edit_protocol';
import {OpForm} from './op_form';
import type {FormHost} from './op_form';
import {commonFields, schemaOf} from '../ops/op_schema';
import {figuresOf, figureWords} from '../ops/op_summary';
import {haveSameTimes} from '../ops/op_origins';

export interface DetailActions {
  move(by: -1 | 1): void;
  remove(): void;
  /** Shows the motion with this number of operations. */
  look(until: number): void;
}

/** True for an operation whose form has instants. */
function hasInstants(op: OpWords): boolean {
  const schema = schemaOf(op);
  return [...schema.fields, ...commonFields(schema)].some((field) => field.kind === 'instant' ||
    field.kind === 'constraint' || (field.kind === 'rows' && field.key !== 'objects'));
}

export class OpDetail {
  readonly element: HTMLElement;
  private readonly form: OpForm;
  private readonly up: HTMLButtonElement;
  private readonly down: HTMLButtonElement;
  private readonly before: HTMLButtonElement;
  private readonly after: HTMLButtonElement;
  private readonly figures = el('dl', {class: 'facts'});
  private readonly more = el('details', {class: 'op-more'}, el('summary', {}, 'Figures'),
    this.figures);
  private readonly times = el('p', {class: 'hint', hidden: true},
    'Instants are those of the motion before this operation. The shown motion has other times.');
  private isOpen = false;

  constructor(private readonly host: FormHost, actions: DetailActions) {
    const look = (by: 0 | 1): void => {
      const index = host.index();
      if (index !== null) actions.look(index + by);
    };
    this.form = new OpForm(host);
    this.up = button({class: 'icon', title: 'Move up (Alt+Up)', 'aria-label': 'Move up',
      onclick: () => actions.move(-1)}, '↑');
    this.down = button({class: 'icon', title: 'Move down (Alt+Down)', 'aria-label': 'Move down',
      onclick: () => actions.move(1)}, '↓');
    this.before = button({title: 'Show the motion before this operation',
      onclick: () => look(0)}, 'Before');
    this.after = button({title: 'Show the motion after this operation', onclick: () => look(1)},
      'After');
    this.element = el('div', {class: 'op-detail'},
      el('div', {class: 'op-actions', role: 'toolbar', 'aria-label': 'Operation'},
        this.before, this.after, el('span', {class: 'spring'}), this.up, this.down,
        button({class: 'remove', title: 'Remove this operation (Delete)',
          onclick: () => actions.remove()}, 'Remove')),
      this.times, this.form.element, this.more);
  }

  open(op: OpWords, reports: readonly OpReportWords[]): void {
    this.isOpen = true;
    this.form.open(op);
    this.setReports(reports);
  }

  update(op: OpWords): void {
    if (this.isOpen) this.form.update(op);
  }

  close(): void {
    if (!this.isOpen) return;
    this.isOpen = false;
    this.form.close();
    this.element.remove();
  }

  setReports(reports: readonly OpReportWords[]): void {
    if (!this.isOpen) return;
    this.form.setNames(this.host.shown().names);
    const figures = figuresOf(reports);
    this.more.hidden = figures.length === 0;
    keepRows(this.figures, figures, () => el('div', {}, el('dt'), el('dd')),
      (row, [name, value]) => {
        const [words, number] = figureWords(name, value);
        setText(row.children[0] as HTMLElement, capitalized(words));
        setText(row.children[1] as HTMLElement, number);
      });
  }

  /** `until`: number of operations of the shown motion; null: all. */
  setLook(index: number | null, until: number | null, ops: readonly OpWords[]): void {
    const count = ops.length;
    const shown = until ?? count;
    this.times.hidden = index === null || haveSameTimes(ops, index, shown) ||
      !hasInstants(ops[index]);
    this.before.setAttribute('aria-pressed', String(index !== null && shown === index));
    this.after.setAttribute('aria-pressed', String(index !== null && shown === index + 1));
    this.up.disabled = index === 0;
    this.down.disabled = index === count - 1;
  }
}
