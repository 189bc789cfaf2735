// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The panel for loops: finds pairs of frames that repeat each other, and makes a loop of one.

import {insertIndex} from '../edit/edit_view';
import type {EditView} from '../edit/edit_view';
import {LoopMap} from './loop_map';
import {
  cellOfCycle, cycleOfCell, distanceAt, loopChange, loopsUntil, motionKey,
  nearestMinimum,
} from './loop_search';
import type {Cell, Cycle} from './loop_search';
import type {LoopCandidateWords, LoopsWords} from '../protocol/edit_protocol';
import {button, el, keepRows, setText} from '../base/elements';
import type {Theme} from '../base/theme';
import {fixed, plural} from '../base/words';
import {Section} from '../panels/panels';

const EDGES: Record<LoopCandidateWords['edge'], string> = {left_strike: 'left strike',
  right_strike: 'right strike', none: '–'};

/** `until`: the motion that the frames belong to, as in EditView. It is another one than the
 *  shown one if this was made a loop already. */
export interface LoopActions {
  /** Stops playing and shows this frame. */
  seek(frame: number, until: number | null): void;
  /** Plays these frames again and again. */
  playCycle(first: number, last: number, until: number | null): void;
}

export class LoopsPanel {
  readonly section = new Section('loops', 'Loops', false);
  private readonly map: LoopMap;
  private readonly finding = button({class: 'primary', onclick: () => void this.find()},
    'Find loops');
  private readonly min = periodField('Shortest period in seconds');
  private readonly max = periodField('Longest period in seconds');
  private readonly note = el('p', {class: 'note', role: 'status'});
  private readonly list = el('ol', {class: 'loops', 'aria-label': 'Loops, best first'});
  private readonly words = el('p', {class: 'note pair'});
  private readonly from = frameField('First frame of the cycle', () => this.typed());
  private readonly to = frameField('Frame that repeats the first', () => this.typed());
  private readonly making = button({class: 'primary', title: 'Makes a loop of these frames',
    onclick: () => this.make()}, 'Loop here');
  private readonly playing = button({onclick: () => this.play()}, 'Play the cycle');
  private readonly results: HTMLElement;
  private found: LoopsWords | null = null;
  /** Text of the searched motion; see motionKey(). */
  private key = '';
  private rate_hz = 30;
  private chosen: Cycle | null = null;
  private isSearching = false;
  /** The shown instant is one of the searched motion. */
  private isMarked = false;

  constructor(private readonly view: EditView, theme: Theme,
    private readonly actions: LoopActions) {
    this.map = new LoopMap(theme, {
      hovered: (cell) => this.tellPair(cell),
      chosen: (cell, exact) => this.chooseCell(cell, exact)});
    this.results = el('div', {class: 'loop-results', hidden: true}, this.list, this.map.element,
      this.words, el('div', {class: 'row'}, 'Frames ', this.from, ' to ', this.to),
      el('div', {class: 'row'}, this.making, this.playing));
    this.section.body.append(el('div', {class: 'row'}, this.finding,
      el('span', {class: 'row'}, 'Period ', this.min, ' to ', this.max, ' s')), this.note,
    this.results);
    this.update();
  }

  /** Called when the shown motion or the recipe has changed. */
  update(): void {
    const {found, view} = this;
    const stale = this.isStale;
    this.isMarked = found !== null && !stale && this.isShown;
    this.results.classList.toggle('stale', stale);
    this.finding.disabled = this.isSearching || view.output === null;
    this.making.disabled = stale || !this.chosen;
    this.playing.disabled = stale || !this.chosen;
    if (this.isSearching) setText(this.note, 'Searching …');
    else if (stale) setText(this.note, 'The motion has changed: find again.');
    else setText(this.note, found ? this.summary(found) : '');
    this.setTime(view.time);
  }

  /** Called when the shown instant has changed. [frames] */
  setTime(time: number): void {
    if (!this.section.open || !this.found) return;
    this.map.setTime(this.isMarked ? time : null);
  }

  private get isStale(): boolean {
    const {document: {ops}} = this.view;
    return this.found !== null && (this.found.output !== this.view.outputIndex ||
      motionKey(ops, this.end) !== this.key);
  }

  /** Number of operations before the loop. */
  private get end(): number {
    return loopsUntil(this.view.document.ops, this.view.until);
  }

  /** True if loops are searched in the shown motion, not in that before it was made a loop. */
  private get isShown(): boolean {
    const {document: {ops}, until} = this.view;
    return this.end === insertIndex(ops, until);
  }

  /** The searched motion, as EditView.until. */
  private get until(): number | null {
    return this.isShown ? this.view.until : this.end;
  }

  private summary(found: LoopsWords): string {
    const where = this.isShown ? '' : ' Times are those of the motion before operation ' +
      `${this.end + 1}, which makes the loop.`;
    if (found.candidates.length > 0) {
      return `${plural(found.candidates.length, 'loop')} found.${where}`;
    }
    return 'No loop was found. Give limits of the period, or choose a pair in the map.';
  }

  // --- Search ---

  private async find(): Promise<void> {
    const {document, outputIndex, output} = this.view;
    const {end} = this;
    const until = end === document.ops.length ? null : end;
    const key = motionKey(document.ops, end);
    const limit = (field: HTMLInputElement): number | undefined =>
      (Number(field.value) > 0 ? Number(field.value) : undefined);
    const [min_period_s, max_period_s] = [limit(this.min), limit(this.max)];
    this.isSearching = true;
    this.update();
    const found = await document.loops({until, output: outputIndex, map: true,
      ...(min_period_s ? {min_period_s} : {}), ...(max_period_s ? {max_period_s} : {})});
    this.isSearching = false;
    if (found) {
      this.key = key;
      this.rate_hz = output?.rate_hz ?? 30;
      this.found = found;
      this.chosen = null;
      this.results.hidden = false;
      this.map.load(found.map, found.candidates, this.rate_hz);
      this.showList();
      this.tellPair(null);
      this.from.value = '';
      this.to.value = '';
    }
    this.update();
  }

  private showList(): void {
    const candidates = this.found?.candidates ?? [];
    keepRows(this.list, candidates, () => this.row(), (row, loop) => {
      const [span, period, distance, edge] = row.querySelectorAll('span');
      setText(span, `${fixed(loop.first_s, 2)} – ${fixed(loop.last_s, 2)} s`);
      setText(period, `${fixed(loop.period_s, 2)} s`);
      setText(distance, `${fixed(loop.distance_mm, 0)} mm`);
      setText(edge, EDGES[loop.edge]);
      const isChosen = loop.first === this.chosen?.first && loop.last === this.chosen.last;
      row.querySelector('button')!.setAttribute('aria-pressed', String(isChosen));
    });
  }

  private row(): HTMLElement {
    const made: HTMLElement = el('li', {}, button({title: 'Start and end, period, distance, ' +
      'contact at both ends', onclick: () => {
      const loop = this.found?.candidates[[...this.list.children].indexOf(made)];
      if (loop) this.choose(loop);
    }}, el('span'), el('span'), el('span'), el('span')));
    return made;
  }

  // --- The chosen pair ---

  private chooseCell(cell: Cell, exact: boolean): void {
    const {found} = this;
    if (!found?.map || this.isStale) return;
    const taken = exact ? cell : nearestMinimum(found.map, cell) ?? cell;
    this.choose(cycleOfCell(found.map, taken, found.candidates));
  }

  private choose({first, last}: Cycle): void {
    const {found} = this;
    if (!found || this.isStale) return;
    this.chosen = {first, last};
    this.map.select(found.map ? cellOfCycle(found.map, this.chosen) : null);
    this.from.value = String(first);
    this.to.value = String(last);
    this.showList();
    this.tellPair(null);
    this.actions.seek(first, this.until);
    this.update();
  }

  private typed(): void {
    const [first, last] = [Math.round(Number(this.from.value)), Math.round(Number(this.to.value))];
    if (this.from.value !== '' && this.to.value !== '' && first >= 0 && last > first) {
      this.choose({first, last});
    }
  }

  /** Describes the cell under the pointer; without one, the chosen pair. */
  private tellPair(cell: Cell | null): void {
    const {found, chosen} = this;
    if (cell) setText(this.words, `Under the pointer: ${this.map.words(cell)}`);
    else if (!chosen || !found) {
      setText(this.words, found?.map ? 'Click on the map to choose a pair. Shift and click ' +
        'takes exactly that cell.' : '');
    } else {
      const known = found.candidates.find(({first, last}) =>
        first === chosen.first && last === chosen.last);
      const at = found.map && cellOfCycle(found.map, chosen);
      const distance_mm = known?.distance_mm ??
        (at && found.map ? distanceAt(found.map, at.row, at.column) : null);
      const seconds = (frames: number): string => fixed(frames / this.rate_hz, 2);
      setText(this.words, `Chosen: start ${seconds(chosen.first)} s, end ` +
        `${seconds(chosen.last)} s, period ${seconds(chosen.last - chosen.first)} s, ` +
        `${fixed(distance_mm, 0)} mm`);
    }
  }

  private make(): void {
    if (!this.found || !this.chosen || this.isStale) return;
    void this.view.commit(loopChange(this.chosen, this.view.until));
  }

  private play(): void {
    if (!this.found || !this.chosen || this.isStale) return;
    this.actions.playCycle(this.chosen.first, this.chosen.last, this.until);
  }
}

function periodField(label: string): HTMLInputElement {
  return el('input', {type: 'number', min: 0, step: 0.05, placeholder: 'any', title: label,
    'aria-label': label});
}

function frameField(label: string, changed: () => void): HTMLInputElement {
  return el('input', {type: 'number', min: 0, step: 1, title: label, 'aria-label': label,
    onchange: changed});
}
