// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The filter of the list: expression, verdicts, order.

import {button, chooser, el, setText} from '../base/elements';
import type {ListOrder, SortKey, Verdict} from '../protocol/library_protocol';
import {VERDICTS} from '../protocol/library_protocol';
import {foundWords} from './clip_list';
import type {ClipStore} from './clip_store';

/** An expression is evaluated this long after the last key. */
const PAUSE_MS = 80;
/** An incomplete expression is wrong for a moment, so that its error is shown later. */
const ERROR_AFTER_MS = 700;

const SORTS: readonly [SortKey, string][] = [['number', 'source'], ['name', 'name'],
  ['seconds', 'length'], ['quality', 'verdict'], ['rate_hz', 'rate'], ['licence', 'licence']];

const EXAMPLES: readonly [string, string][] = [
  ['content=walk and quality=pass', 'a label of a table, and the verdict'],
  ['seconds>3 and licence=CC0-1.0', 'columns of the list'],
  ['slide_cm_s>6', 'a figure of the quality gate'],
  ['has(hand_right above head for 0.3 s)', 'something that marey found'],
];

export class FilterBar {
  private readonly input = el('input', {type: 'search', class: 'clip-query', spellcheck: false,
    autocomplete: 'off', placeholder: 'Filter: content=walk and quality=pass',
    'aria-label': 'Filter', 'aria-describedby': 'clip-query-error'});
  private readonly error = el('p', {class: 'clip-query-error', id: 'clip-query-error',
    role: 'alert', hidden: true});
  private readonly remarks = el('p', {class: 'clip-remarks', hidden: true});
  private readonly chips: Record<Verdict, HTMLButtonElement>;
  private readonly direction: HTMLButtonElement;
  private readonly count = el('output', {class: 'clip-count'});
  private readonly examples = el('dl', {class: 'clip-examples', hidden: true});
  readonly element: HTMLElement;
  private order: ListOrder;
  private timer = 0;
  private errorTimer = 0;

  /** `changed` is called with each new order. */
  constructor(order: ListOrder, private readonly changed: (order: ListOrder) => void) {
    this.order = order;
    this.input.value = order.query;
    const chip = (verdict: Verdict): HTMLButtonElement => button({
      class: `clip-chip verdict-${verdict}`, 'aria-pressed': 'false',
      onclick: () => this.change({quality: this.order.quality === verdict ? null : verdict})});
    this.chips = {pass: chip('pass'), warn: chip('warn'), fail: chip('fail')};
    const sort = chooser(SORTS, order.sort, (key) => this.change({sort: key as SortKey}),
      {'aria-label': 'Sort by', title: 'Sort by'});
    this.direction = button({class: 'icon', onclick: () =>
      this.change({descending: !this.order.descending})});
    const help = button({class: 'icon', title: 'Examples of filters', 'aria-label':
      'Examples of filters', 'aria-expanded': 'false', onclick: () => {
      this.examples.hidden = !this.examples.hidden;
      help.setAttribute('aria-expanded', String(!this.examples.hidden));
    }}, '?');
    this.fillExamples();
    this.element = el('div', {class: 'clip-filter'},
      el('div', {class: 'row'}, this.input, help), this.error, this.remarks, this.examples,
      el('div', {class: 'row clip-orders'}, ...VERDICTS.map((verdict) => this.chips[verdict])),
      el('div', {class: 'row clip-orders'}, this.count, el('span', {class: 'spring'}),
        el('span', {class: 'quiet', 'aria-hidden': 'true'}, 'by'), sort, this.direction));
    this.listen();
    this.tell();
  }

  /** Shows the expression of the command line. */
  setQuery(query: string): void {
    this.input.value = query;
    this.order = {...this.order, query};
  }

  focus(): void {
    this.input.focus();
    this.input.select();
  }

  /** Shows what was found. */
  show({order, counts, remarks, found}: ClipStore, all: number): void {
    this.hideError();
    for (const verdict of VERDICTS) setText(this.chips[verdict], `${verdict} ${counts[verdict]}`);
    setText(this.remarks, remarks.join('. '));
    this.remarks.hidden = remarks.length === 0;
    setText(this.count, foundWords(found, all));
    this.order = {...this.order, query: order.query};
    this.tell();
  }

  /** The expression was refused; the list has still the order `order`. */
  refuse(text: string, order: ListOrder): void {
    this.order = order;
    this.tell();
    window.clearTimeout(this.errorTimer);
    setText(this.error, text);
    this.errorTimer = window.setTimeout(() => {
      this.error.hidden = false;
      this.input.setAttribute('aria-invalid', 'true');
    }, this.error.hidden ? ERROR_AFTER_MS : 0);
  }

  private hideError(): void {
    window.clearTimeout(this.errorTimer);
    this.error.hidden = true;
    this.input.removeAttribute('aria-invalid');
  }

  private fillExamples(): void {
    this.examples.append(...EXAMPLES.flatMap(([query, meaning]) => [
      el('dt', {}, button({class: 'clip-example', onclick: () => {
        this.input.value = query;
        this.use();
      }}, query)), el('dd', {}, meaning)]));
  }

  private listen(): void {
    this.input.addEventListener('input', () => {
      window.clearTimeout(this.timer);
      this.timer = window.setTimeout(() => this.use(), PAUSE_MS);
    });
    this.input.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter') return;
      event.preventDefault();
      this.use();
    });
  }

  private use(): void {
    window.clearTimeout(this.timer);
    this.change({query: this.input.value.trim()});
  }

  private change(part: Partial<ListOrder>): void {
    this.order = {...this.order, ...part};
    this.tell();
    this.changed(this.order);
  }

  private tell(): void {
    const {quality, descending} = this.order;
    for (const verdict of VERDICTS) {
      this.chips[verdict].setAttribute('aria-pressed', String(quality === verdict));
    }
    setText(this.direction, descending ? '↓' : '↑');
    const words = descending ? 'Descending; press for ascending'
      : 'Ascending; press for descending';
    this.direction.title = words;
    this.direction.setAttribute('aria-label', words);
  }
}
