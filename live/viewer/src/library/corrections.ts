// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Forms for corrections of a library: a verdict, a label.

import {button, checkbox, chooser, el, remember, remembered, setText} from '../base/elements';
import type {ClipSpan, LabelForm, Verdict, VerdictForm} from '../protocol/library_protocol';
import {VERDICTS} from '../protocol/library_protocol';
import {figureName} from './figure_words';

/** Result of storing: the file, or the reason why not. */
export type Stored = {file: string} | {problem: string};

const BY = 'by';

function textInput(label: string, value: string, max: number): HTMLInputElement {
  return el('input', {type: 'text', value, maxlength: max, 'aria-label': label,
    placeholder: label});
}

/** The person's name is remembered in this browser. */
function nameInput(): HTMLInputElement {
  return textInput('Your name', remembered(BY) ?? '', 60);
}

function takeName(input: HTMLInputElement): string {
  const name = input.value.trim();
  if (name) remember(BY, name);
  return name;
}

function storedWords(stored: Stored): string {
  return 'file' in stored
    ? `Stored in ${stored.file}. The next “marey library build” applies it.` : stored.problem;
}

/** Returns a form that closes with Escape and shows the result of its request. */
function form(kind: string, title: string, parts: HTMLElement[], closed: () => void,
  store: () => Promise<Stored> | string): HTMLFormElement {
  const note = el('p', {class: 'correction-note', role: 'status'});
  const save = el('button', {class: 'primary'}, 'Save');
  const made = el('form', {class: `correction correction-${kind}`, onsubmit: (event: Event) => {
    event.preventDefault();
    void submit();
  }, onkeydown: (event: KeyboardEvent) => {
    if (event.key !== 'Escape') return;
    event.stopPropagation();
    closed();
  }}, el('strong', {}, title), ...parts, el('div', {class: 'row'}, save,
    button({onclick: closed}, 'Close')), note);
  async function submit(): Promise<void> {
    const pending = store();
    if (typeof pending === 'string') {
      setText(note, pending);
      return;
    }
    save.disabled = true;
    const stored = await pending;
    save.disabled = false;
    setText(note, storedWords(stored));
    note.classList.toggle('is-problem', 'problem' in stored);
    made.classList.toggle('is-stored', 'file' in stored);
  }
  return made;
}

/** A form for another verdict on a figure, or on the whole clip. */
export function verdictForm(clip_id: string, figure: string, frames: ClipSpan | null,
  now: Verdict | null, store: (words: VerdictForm) => Promise<Stored>,
  closed: () => void): HTMLFormElement {
  let verdict: Verdict = now === 'pass' ? 'fail' : 'pass';
  const choice = chooser(VERDICTS.map((word) => [word, word]), verdict,
    (word) => { verdict = word as Verdict; }, {'aria-label': 'Right verdict'});
  const note = textInput('Why (optional)', '', 300);
  const by = nameInput();
  const title = figure === 'quality' ? 'The whole clip should be'
    : `${figureName(figure)} should be`;
  return form('verdict', title, [choice, note, by], closed, () => {
    const name = takeName(by);
    if (!name) return 'Write your name.';
    return store({clip_id, figure, frames, verdict, by: name, note: note.value.trim()});
  });
}

/** Times of a label, and the instant that is shown. [s] */
export interface LabelTimes {start_s: number; end_s: number; now_s(): number}

/** A form for a label of a part of the clip. */
export function labelForm(clip_id: string, times: LabelTimes,
  store: (words: LabelForm) => Promise<Stored>, closed: () => void): HTMLFormElement {
  const time = (label: string, value: number): HTMLInputElement => el('input', {type: 'number',
    min: 0, max: times.end_s.toFixed(3), step: 0.001, value: value.toFixed(3),
    'aria-label': label});
  const start = time('Start [s]', times.start_s);
  const end = time('End [s]', times.end_s);
  const here = (input: HTMLInputElement, which: string): HTMLButtonElement => button({
    class: 'now', title: `Set the ${which} to the shown instant`,
    onclick: () => { input.value = times.now_s().toFixed(3); }}, 'now');
  const text = textInput('Label', '', 100);
  const by = nameInput();
  let sure = true;
  return form('label', 'New label', [text,
    el('div', {class: 'row'}, 'from', start, here(start, 'start')),
    el('div', {class: 'row'}, 'to', end, here(end, 'end'), 's'),
    checkbox('certain', true, (on) => { sure = on; }), by], closed, () => {
    const name = takeName(by);
    const label = text.value.trim();
    const [start_s, end_s] = [Number(start.value), Number(end.value)];
    if (!label) return 'Write a label.';
    if (!name) return 'Write your name.';
    if (!(start_s >= 0) || !(end_s >= start_s)) return 'The label ends before it starts.';
    return store({clip_id, start_s, end_s, label, by: name, sure});
  });
}
