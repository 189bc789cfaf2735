// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Frames of form fields, and inputs for numbers and text that separate typing from a finished
// value.

import {el, setText} from '../base/elements';
import type {Field} from './op_fields';
import {numberProblem, textProblem} from './op_values';
import type {Changes, Keys, Problems} from './op_values';
import type {Shown} from './new_op';

/** Receives the changes of the fields of one table of keys. */
export interface FieldHost {
  /** New values of keys. `isDone`: false while the user types. */
  set(changes: Changes, isDone: boolean): void;
  shown(): Shown;
  /** Id of the list of names of annotations. */
  readonly namesId: string;
}

export interface FieldView {
  readonly element: HTMLElement;
  /** Writes the value of the keys. An input that the user changes is only rewritten if
   *  `isForced`. The paths of the keys in `problems` begin with `prefix`. */
  show(keys: Keys, problems: Problems, prefix: string, isForced: boolean): void;
}

let ids = 0;
export function newId(): string {
  ids += 1;
  return `op-field-${ids}`;
}

/** Name, content and error of a field. */
export class FieldFrame {
  readonly element: HTMLElement;
  /** For aria-describedby of the inputs. */
  readonly errorId = newId();
  private readonly error = el('p', {class: 'field-error', id: this.errorId});

  /** `inputId`: the input that the label belongs to; null: several, the frame is a group. */
  constructor(field: Field, inputId: string | null, ...content: (Node | string)[]) {
    const {label, help} = field;
    const isWide = ['vector', 'rotation', 'points', 'rows', 'groups', 'constraint']
      .includes(field.kind);
    const name = inputId === null ? el('span', {class: 'field-name', title: help}, label)
      : el('label', {class: 'field-name', title: help, for: inputId}, label);
    this.element = el('div', {class: `field field-${isWide ? 'wide' : field.kind}`,
      'data-key': field.key, role: inputId === null ? 'group' : null,
      'aria-label': inputId === null ? label : null},
    name, el('div', {class: 'field-content'}, ...content), this.error);
    this.tell('');
  }

  /** Shows a mistake; empty: none. */
  tell(problem: string): void {
    setText(this.error, problem);
    this.error.hidden = problem === '';
    this.element.classList.toggle('wrong', problem !== '');
    for (const input of this.element.querySelectorAll('input, select')) {
      if (input.closest('.field') !== this.element) continue;
      if (problem) input.setAttribute('aria-invalid', 'true');
      else input.removeAttribute('aria-invalid');
    }
  }
}

/** Input of a value. Subclasses say how a text is read. */
export abstract class Entry<T extends number | string> {
  readonly input: HTMLInputElement;
  /** The mistake in the typed text; empty: none. */
  problem = '';
  /** The user has changed the text, and the value has not been taken. */
  private isTyped = false;
  /** An arrow key is down: its repeats are one change, which ends when it is released. */
  private isStepping = false;

  /** `changed` receives valid values; undefined: the input is empty. */
  constructor(attributes: Record<string, string | number | null>,
    private readonly changed: (value: T | undefined, isDone: boolean) => void,
    private readonly told: () => void) {
    this.input = el('input', {...attributes, autocomplete: 'off', spellcheck: 'false',
      oninput: () => this.read(false),
      onchange: () => { if (!this.isStepping) this.read(true); },
      onkeydown: (event: KeyboardEvent) => {
        const isStep = event.key === 'ArrowUp' || event.key === 'ArrowDown';
        if (isStep && attributes.type === 'number') this.isStepping = true;
        // A change event follows only if the text differs from the one at the last focus.
        if (event.key === 'Enter' && this.isTyped) this.read(true);
      }, onkeyup: () => this.endSteps(), onblur: () => this.endSteps()});
  }

  private endSteps(): void {
    if (!this.isStepping) return;
    this.isStepping = false;
    this.read(true);
  }

  /** Returns the value of a text that is not empty; a problem as an Error. */
  protected abstract parse(text: string): T | Error;

  protected isBad(): boolean {
    return false;
  }

  show(value: T | undefined, isForced: boolean): void {
    const isOwn = this.isTyped && (this.problem !== '' || document.activeElement === this.input);
    if (isOwn && !isForced) return;
    this.isTyped = false;
    this.problem = '';
    const text = value === undefined ? '' : String(value);
    if (this.input.value !== text || this.isBad()) this.input.value = text;
  }

  private read(isDone: boolean): void {
    // Enter has taken this value already.
    if (isDone && !this.isTyped) return;
    this.isTyped = true;
    const text = this.input.value.trim();
    const value = this.isBad() ? new Error('Not a number') :
      text === '' ? undefined : this.parse(text);
    this.problem = value instanceof Error ? value.message : '';
    if (value instanceof Error) {
      this.told();
      return;
    }
    if (isDone) this.isTyped = false;
    this.changed(value, isDone);
  }
}

export class NumberEntry extends Entry<number> {
  constructor(private readonly limits: {min: number; max: number; isWhole?: boolean},
    attributes: Record<string, string | number | null>,
    changed: (value: number | undefined, isDone: boolean) => void, told: () => void) {
    super({type: 'number', ...attributes}, changed, told);
  }

  protected parse(text: string): number | Error {
    const value = Number(text);
    const problem = numberProblem(value, this.limits);
    return problem ? new Error(problem) : value;
  }

  protected override isBad(): boolean {
    return this.input.validity.badInput;
  }
}

export class TextEntry extends Entry<string> {
  constructor(attributes: Record<string, string | number | null>,
    changed: (value: string | undefined, isDone: boolean) => void, told: () => void) {
    super({type: 'text', ...attributes}, changed, told);
  }

  protected parse(text: string): string | Error {
    const problem = textProblem(text);
    return problem ? new Error(problem) : text;
  }
}

/** Numbers of a vector. They are reported when all are there, or none. */
export class VectorEntry {
  readonly element = el('div', {class: 'numbers'});
  private readonly entries: NumberEntry[];
  private values: (number | undefined)[] = [];
  private isPartial = false;

  constructor(axes: readonly string[], unit: string, label: string, step: number,
    limits: {min: number; max: number},
    changed: (value: number[] | undefined, isDone: boolean) => void,
    private readonly told: () => void) {
    this.entries = axes.map((axis, i) => new NumberEntry(limits,
      {step, 'aria-label': `${label} ${axis}`},
      (value, isDone) => {
        this.values[i] = value;
        const given = axes.filter((_, k) => this.values[k] !== undefined).length;
        this.isPartial = isDone && given > 0 && given < axes.length;
        if (given === axes.length) changed(this.values.slice(0, given) as number[], isDone);
        else if (given === 0) changed(undefined, isDone);
        else this.told();
      }, this.told));
    axes.forEach((axis, i) => this.element.append(
      el('span', {class: 'axis', 'aria-hidden': 'true'}, axis), this.entries[i].input));
    if (unit) this.element.append(el('span', {class: 'unit'}, unit));
  }

  /** `id` belongs to the element that shows the mistake. */
  describe(id: string): void {
    for (const {input} of this.entries) input.setAttribute('aria-describedby', id);
  }

  get problem(): string {
    return this.entries.find(({problem}) => problem)?.problem ??
      (this.isPartial ? 'All numbers are needed' : '');
  }

  show(value: readonly number[] | undefined, isForced: boolean): void {
    // Numbers of an unfinished vector stay.
    const isOpen = value === undefined && this.values.some((one) => one !== undefined) &&
      this.values.filter((one) => one !== undefined).length < this.entries.length;
    if (isOpen && !isForced) return;
    this.isPartial = false;
    this.values = this.entries.map((_, i) => value?.[i]);
    this.entries.forEach((entry, i) => entry.show(value?.[i], isForced));
  }
}
