// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// One operation in the list. Every setter compares first: a list of thousands is written often.

import {el, setText} from '../base/elements';
import {capitalized} from '../base/words';
import type {FindingWords, OpReportWords, OpWords} from '../protocol/edit_protocol';
import {schemaOf} from './op_schema';
import {figuresOf, figureWords, findingsOf, summaryOf} from './op_summary';

/** Figures that are shown without opening the operation. */
const SHOWN_FIGURES = 3;

const SEVERITY_WORDS: Record<FindingWords['severity'], string> =
  {poor: 'Poor', fair: 'Fair', note: 'Note'};

function findingRow({severity, text, next, value, limit, unit}: FindingWords): HTMLElement {
  const figures = value === null ? '' : figureText(value, limit, unit);
  return el('li', {class: `op-finding severity-${severity}`},
    el('b', {}, SEVERITY_WORDS[severity] ?? severity), ` ${capitalized(text)}`,
    figures && el('span', {class: 'limit'}, ` (${figures})`),
    next && el('span', {class: 'next'}, capitalized(next)));
}

function figureText(value: number, limit: number | null, unit: string): string {
  const words = (one: number): string =>
    `${Number(one.toPrecision(3))}${unit && `\u00a0${unit}`}`.replace('-', '−');
  return limit === null ? words(value) : `${words(value)}, limit ${words(limit)}`;
}

export class OpRow {
  readonly element: HTMLElement;
  op: OpWords | null = null;
  reports: readonly OpReportWords[] = [];
  private index = -1;
  private key = '';
  private reported = '';
  private readonly number = el('span', {class: 'op-number'});
  private readonly title = el('span', {class: 'op-title'});
  private readonly summary = el('span', {class: 'op-summary'});
  private readonly button: HTMLButtonElement;
  private readonly box = el('input', {type: 'checkbox', class: 'op-on', tabindex: -1});
  private readonly why = el('p', {class: 'op-why', hidden: true});
  private readonly figures = el('p', {class: 'op-figures', hidden: true});
  private readonly error = el('p', {class: 'op-error', hidden: true});
  private findings: HTMLElement | null = null;

  constructor() {
    this.button = el('button', {type: 'button', class: 'op-open', tabindex: -1,
      'aria-expanded': 'false'}, this.number, this.title, this.summary);
    this.element = el('li', {class: 'op'},
      el('span', {class: 'op-grip', 'aria-hidden': 'true',
        title: 'Drag to change the order, or press Alt+Up or Alt+Down'}, '⠿'),
      this.button, this.box, this.why, this.figures, this.error);
  }

  setOp(index: number, op: OpWords): void {
    if (index !== this.index) {
      this.index = index;
      setText(this.number, String(index + 1));
    }
    this.op = op;
    // A click has switched the box before marey has accepted it.
    this.box.checked = !op.off;
    const key = `${op.off}\n${op.text}`;
    if (key === this.key) return;
    this.key = key;
    const {title, help} = schemaOf(op);
    setText(this.title, title);
    setText(this.summary, summaryOf(op.keys));
    this.button.title = help;
    this.box.setAttribute('aria-label', `${title} is applied`);
    this.box.title = op.off ? 'Off: the operation is skipped' : 'On';
    this.element.classList.toggle('off', op.off);
    const why = typeof op.keys.why === 'string' ? op.keys.why : '';
    setText(this.why, why);
    this.why.hidden = why === '';
  }

  setReports(reports: readonly OpReportWords[]): void {
    this.reports = reports;
    const reported = JSON.stringify(reports);
    if (reported === this.reported) return;
    this.reported = reported;
    const words = figuresOf(reports).slice(0, SHOWN_FIGURES).map(([name, value]) =>
      figureWords(name, value).join(' ').replaceAll(' ', '\u00a0'));
    setText(this.figures, words.join(' · '));
    this.figures.hidden = words.length === 0;
    const findings = findingsOf(reports);
    this.findings?.remove();
    this.findings = findings.length === 0 ? null
      : el('ul', {class: 'op-findings'}, ...findings.map(findingRow));
    if (this.findings) this.error.before(this.findings);
  }

  setError(error: string): void {
    setText(this.error, error && capitalized(error));
    this.error.hidden = error === '';
    this.element.classList.toggle('failed', error !== '');
  }

  /** `isBeyond`: the shown motion is one before this operation. */
  setBeyond(isBeyond: boolean): void {
    this.element.classList.toggle('beyond', isBeyond);
  }

  /** Opens or closes the row; `detail` is moved into an open one. */
  setDetail(detail: HTMLElement | null): void {
    this.element.classList.toggle('selected', detail !== null);
    this.button.setAttribute('aria-expanded', String(detail !== null));
    if (detail) this.element.append(detail);
  }

  /** Only one row of the list is reached by the tabulator key. */
  setTabStop(isStop: boolean): void {
    this.button.tabIndex = isStop ? 0 : -1;
    this.box.tabIndex = isStop ? 0 : -1;
  }

  focus(): void {
    this.button.focus();
  }
}
