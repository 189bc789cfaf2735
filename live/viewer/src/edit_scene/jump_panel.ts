// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The panel for jumps: lists the jumps of the motion, draws the curves of one, and changes the
// lowest point of its push.

import {insertIndex} from '../edit/edit_view';
import type {EditView} from '../edit/edit_view';
import type {Change} from '../edit/edit_document';
import {JumpCurves} from './jump_curves';
import {
  fallsUnusually, insertedJump, jumpWords, keysChange, lowestChange, lowestWords, planWords,
  showsTimesAfter, shownJump,
} from './jump_search';
import {JumpSpace, RULE_COLOURS} from './jump_space';
import {motionKey} from './loop_search';
import {newOp, shownOf} from '../ops/new_op';
import type {JumpOptions, JumpWords, LowestWords, OpWords} from '../protocol/edit_protocol';
import {button, el, keepRows, setText} from '../base/elements';
import type {Theme} from '../base/theme';
import {plural} from '../base/words';
import {Section} from '../panels/panels';

export interface JumpActions {
  /** Stops playing and shows this frame of the shown motion. */
  seek(frame: number): void;
  /** Opens the form of an operation. */
  select(index: number): void;
}

/** A question to marey. `key` differs if the answer may. */
interface Question {key: string; make(ops: readonly OpWords[]): JumpOptions | null}

const DRAG_KEY = 'drag';
const MULTIPLYING = ['keep@1', 'split@1'];

export class JumpPanel {
  readonly section = new Section('jump', 'Jump', false, () => this.update());
  private readonly finding = button({class: 'primary', onclick: () => this.find(1)},
    'Find jumps');
  private readonly note = el('p', {class: 'note', role: 'status'});
  private readonly heads = el('div', {class: 'jump-heads', 'aria-hidden': 'true'},
    ...['', 'take-off', 'in the air', 'rise', 'falls at'].map((words) => el('span', {}, words)));
  private readonly list = el('ol', {class: 'loops jumps', 'aria-label': 'Jumps, in order'});
  private readonly findings = el('ul', {class: 'jump-findings'});
  private readonly refusal = el('p', {class: 'note error', role: 'alert', hidden: true});
  private readonly curves: JumpCurves;
  private readonly legend = el('ul', {class: 'legend jump-legend'},
    el('li', {title: 'The captured motion, at the new times'}, el('span', {class: 'dashes'}),
      ' captured'), el('li', {title: 'After the operation'}, el('span', {class: 'line'}), ' new'),
    el('li', {title: 'P1 start of the push, P2 lowest point, P3 take-off, P4 touch-down, P5 ' +
      'end of the landing'}, 'P1 to P5: phases'));
  private readonly facts = el('p', {class: 'note'});
  private readonly space: JumpSpace;
  private readonly rules = el('ul', {class: 'legend'},
    ...([['force', 'the push would be negative'], ['fall', 'it would rise before P2'],
      ['rise', 'it would sink after P2']] as const).map(([rule, words]) =>
      el('li', {}, el('span', {class: `swatch fill-${RULE_COLOURS[rule]}`}), ` ${words}`)));
  private readonly lowest = el('p', {class: 'note', role: 'status'});
  private readonly making = button({class: 'primary', onclick: () => void this.make()},
    'Change this jump');
  private readonly byHand = button({title: 'Uses the law “thesis”, whose lowest point can be ' +
    'dragged', onclick: () => this.useThesis()}, 'Set the lowest point by hand');
  private readonly back = button({title: 'The lowest point nearest to the captured one',
    onclick: () => this.commit({lowest: undefined})}, 'As captured');
  private readonly results: HTMLElement;
  private words: JumpWords | null = null;
  private selected: number | null = null;
  /** Index of the shown operation; null: jumps of the shown motion without one. */
  private index: number | null = null;
  /** Number of the jump that was chosen without an operation; null: not searched. */
  private number: number | null = null;
  private key = '';
  private failed = '';
  private wanted: Question | null = null;
  private isAsking = false;
  private dragged: LowestWords | null = null;

  constructor(private readonly view: EditView, theme: Theme,
    private readonly actions: JumpActions) {
    this.curves = new JumpCurves(theme, (time_s) => this.seek(time_s));
    this.space = new JumpSpace(theme, {moved: (point) => this.drag(point),
      ended: () => void this.drop(), cancelled: () => this.giveUp()});
    this.results = el('div', {class: 'loop-results', hidden: true}, el('div', {}, this.heads, this.list),
      this.findings,
      this.refusal, this.curves.element, this.legend, this.facts, this.space.element, this.rules,
      this.lowest, el('div', {class: 'row'}, this.making, this.byHand, this.back));
    this.section.body.append(el('div', {class: 'row'}, this.finding), this.note, this.results);
    this.update();
  }

  /** Called when another operation is selected in the list. */
  select(selected: number | null): void {
    this.selected = selected;
    const {ops} = this.view.document;
    if (selected !== null && ops[selected]?.do.startsWith('jump@')) {
      this.section.element.open = true;
    }
    this.update();
  }

  /** Called when the shown motion or the recipe has changed. */
  update(): void {
    if (this.space.isHeld) return; // At the end of the drag.
    const {document: {ops, revision}, until, output} = this.view;
    this.index = shownJump(ops, this.selected, until);
    this.finding.hidden = this.index !== null;
    this.finding.disabled = output === null;
    if (!this.section.open || !output) return;
    if (this.index === null && this.number === null) {
      this.show(null);
      return;
    }
    const question = this.question();
    const attempt = `${question.key} ${revision?.revision}`;
    if (question.key !== this.key && attempt !== this.failed) {
      this.key = question.key;
      this.want(question);
    }
    this.showButtons();
    this.setTime(this.view.time);
  }

  /** Called when the shown instant has changed. [frames] */
  setTime(time: number): void {
    if (!this.section.open || !this.words) return;
    this.curves.setTime(this.hasShownTimes ? time / (this.view.output?.rate_hz ?? 1) : null);
  }

  // --- Questions ---

  private question(): Question {
    const {index, number} = this;
    const {document: {ops}, until, outputIndex} = this.view;
    if (index === null) {
      const keys = {do: 'jump@1', ...(number !== null && number > 1 ? {jump: number} : {})};
      const end = insertIndex(ops, until);
      return {key: `find ${number} ${outputIndex} ${motionKey(ops, end)}`, make: (now) => {
        const {index: op, steps} = insertedJump(now, this.view.until, keys);
        return {op, output: outputIndex, ops_patch: steps};
      }};
    }
    const output = this.outputBefore(index);
    return {key: `op ${index} ${output} ${motionKey(ops, index)} ${ops[index].text}`,
      make: () => ({op: index, output})};
  }

  /** Index of the motion that an operation receives: those after it may make several of it. */
  private outputBefore(index: number): number {
    const {document: {ops}, until, outputIndex} = this.view;
    const later = ops.slice(index + 1, until ?? ops.length);
    return later.some((op) => !op.off && MULTIPLYING.includes(op.do)) ? 0 : outputIndex;
  }

  private want(question: Question): void {
    this.wanted = question;
    this.tell();
    if (!this.isAsking) void this.sendWanted();
  }

  /** Sends the newest question when the one before it was answered. */
  private async sendWanted(): Promise<void> {
    this.isAsking = true;
    while (this.wanted) {
      const {wanted} = this;
      this.wanted = null;
      const {document} = this.view;
      const options = wanted.make(document.ops);
      const answer = options ? await document.jump(options) : 'The jump was removed.';
      if (wanted.key === this.key || (wanted.key === DRAG_KEY && this.dragged)) {
        this.take(wanted, answer);
      }
    }
    this.isAsking = false;
    this.tell();
  }

  private take({key}: Question, answer: JumpWords | string): void {
    if (typeof answer !== 'string') {
      this.failed = '';
      this.show(answer);
    } else if (key !== DRAG_KEY) {
      this.failed = `${key} ${this.view.document.revision?.revision}`;
      this.key = '';
      this.show(null);
      setText(this.note, answer);
    }
  }

  private find(number: number): void {
    this.number = number;
    this.failed = '';
    this.update();
  }

  // --- Showing ---

  private show(words: JumpWords | null): void {
    this.words = words;
    this.results.hidden = words === null;
    this.curves.load(words);
    this.space.load(words);
    this.legend.hidden = this.curves.element.hidden;
    this.rules.hidden = this.space.element.hidden;
    this.lowest.hidden = this.space.element.hidden;
    this.heads.hidden = (words?.jumps.length ?? 0) === 0;
    if (words) {
      this.showList(words);
      setText(this.refusal, words.refusal);
      this.refusal.hidden = words.refusal === '';
      setText(this.facts, planWords(words));
      const point = this.dragged ?? words.lowest;
      setText(this.lowest, point ? lowestWords(words.space, point) : '');
    }
    this.showButtons();
    this.tell();
    this.setTime(this.view.time);
  }

  private showButtons(): void {
    const keys = this.index === null ? null : this.view.document.ops[this.index]?.keys;
    const hasJumps = (this.words?.jumps.length ?? 0) > 0;
    this.making.hidden = keys !== null || !hasJumps;
    this.byHand.hidden = keys === null || keys?.law === 'thesis';
    this.back.hidden = keys === null || !keys || !('lowest' in keys);
  }

  private tell(): void {
    const {words, index} = this;
    const isBusy = this.isAsking || this.wanted !== null;
    if (words && words.jumps.length > 0) {
      const which = `jump ${words.number} of ${words.jumps.length}`;
      this.section.tell(which);
      setText(this.note, index === null ? `${plural(words.jumps.length, 'jump')} found.`
        : `Operation ${index + 1} changes ${which}.`);
    } else if (words) setText(this.note, 'No jump was found.');
    else if (isBusy) setText(this.note, 'Searching …');
    else if (this.failed === '') setText(this.note, '');
    if (!words) this.section.tell('');
  }

  private showList({jumps, number}: JumpWords): void {
    keepRows(this.list, jumps, () => this.row(), (row, jump, i) => {
      const parts = row.querySelectorAll('span');
      jumpWords(jump).forEach((words, k) => setText(parts[k + 1], words));
      setText(parts[0], `${i + 1}`);
      parts[4].classList.toggle('unusual', fallsUnusually(jump, this.gravity));
      row.querySelector('button')!.setAttribute('aria-pressed', String(i + 1 === number));
    });
    const found = jumps[number - 1];
    keepRows(this.findings, found?.findings ?? [], () => el('li', {class: 'op-finding'},
      el('span'), el('span', {class: 'next'})), (row, {severity, text, next}) => {
      row.className = `op-finding severity-${severity}`;
      setText(row.children[0] as HTMLElement, text);
      setText(row.children[1] as HTMLElement, next);
    });
  }

  private get gravity(): number {
    const keys = this.index === null ? null : this.view.document.ops[this.index]?.keys;
    return typeof keys?.gravity_m_s2 === 'number' ? keys.gravity_m_s2 : 9.81;
  }

  private row(): HTMLElement {
    const made: HTMLElement = el('li', {}, button({title: 'Take-off, time in the air, rise, ' +
      'vertical acceleration of the captured flight', onclick: () =>
      this.choose([...this.list.children].indexOf(made) + 1)},
    el('span'), el('span'), el('span'), el('span'), el('span')));
    return made;
  }

  // --- Time ---

  private get hasShownTimes(): boolean {
    const {document: {ops}, until} = this.view;
    return this.index === null || showsTimesAfter(ops, this.index, until);
  }

  private seek(time_s: number): void {
    if (this.hasShownTimes) this.actions.seek(time_s * (this.view.output?.rate_hz ?? 1));
  }

  // --- Changes ---

  private choose(number: number): void {
    const jump = this.words?.jumps[number - 1];
    if (!jump) return;
    if (this.index !== null) {
      this.commit({jump: number});
      return;
    }
    this.find(number);
    this.seek(jump.takeoff_s);
  }

  private commit(changes: Parameters<typeof keysChange>[1]): void {
    if (this.index !== null) void this.view.commit(keysChange(this.index, changes));
  }

  private useThesis(): void {
    this.commit({law: 'thesis'});
  }

  /** Inserts an operation for the chosen jump. */
  private async make(): Promise<void> {
    const {view} = this;
    const {jump: _jump, ...keys} = newOp('jump', shownOf(view.output, view.time,
      view.document.revision));
    const number = this.words?.number ?? 1;
    let at = 0;
    const isDone = await view.commit((ops) => {
      const {index, steps} = insertedJump(ops, view.until,
        {...keys, do: 'jump@1', ...(number > 1 ? {jump: number} : {})});
      at = index;
      return steps;
    });
    if (isDone) this.actions.select(at);
  }

  private get lowestOp(): Change | null {
    return this.index === null || !this.dragged ? null : lowestChange(this.index, this.dragged);
  }

  private drag(point: LowestWords): void {
    const {index, words, view} = this;
    this.dragged = point;
    if (words) setText(this.lowest, lowestWords(words.space, point));
    const change = this.lowestOp;
    if (index === null || !change) return;
    const isBefore = view.until !== null && view.until <= index;
    view.preview(change, isBefore ? index + 1 : undefined);
    const output = this.outputBefore(index);
    this.want({key: DRAG_KEY, make: (ops) => {
      const ops_patch = change(ops);
      return ops_patch && {op: index, output, ops_patch};
    }});
  }

  private async drop(): Promise<void> {
    const change = this.lowestOp;
    this.wanted = null;
    if (change) await this.view.commit(change);
    this.dragged = null;
    this.update();
  }

  private giveUp(): void {
    this.dragged = null;
    this.wanted = null;
    this.key = '';
    this.view.cancel();
    this.update();
  }
}
