// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The list of clips: only visible rows are elements.

import {el, setText} from '../base/elements';
import type {Theme} from '../base/theme';
import {duration, plural} from '../base/words';
import type {ClipRow} from '../protocol/library_protocol';
import type {ClipStore} from './clip_store';
import {draw} from './drawings';
import type {Drawings} from './drawings';
import {scrolledTo, visibleRows} from './visible_rows';

export const ROW_PX = 72;
const SPARE_ROWS = 4;
const MAX_CHIPS = 4;

export interface ListListener {
  /** A row was chosen; `isPressed`: with the mouse. */
  chosen(row: ClipRow, isPressed: boolean): void;
  /** Enter was pressed on the chosen row. */
  entered(): void;
}

/** The elements of a row. */
class RowView {
  readonly canvas = el('canvas', {class: 'clip-poses', 'aria-hidden': 'true'});
  private readonly name = el('span', {class: 'clip-name'});
  private readonly chips = el('span', {class: 'clip-labels'});
  private readonly facts = el('span', {class: 'clip-facts'});
  private readonly verdict = el('span', {class: 'clip-verdict'});
  readonly element = el('div', {class: 'clip-row', role: 'option'}, this.canvas,
    el('div', {class: 'clip-words'}, this.name, this.chips, this.facts, this.verdict));
  index = -1;
  clip = -1;
  /** The drawing on the canvas; undefined: none. */
  drawn: unknown = undefined;

  write(index: number, row: ClipRow | null): void {
    this.index = index;
    this.element.style.transform = `translateY(${index * ROW_PX}px)`;
    this.element.id = `clip-row-${index}`;
    this.element.setAttribute('aria-posinset', String(index + 1));
    this.element.classList.toggle('is-waiting', !row);
    if (!row) {
      this.clip = -1;
      setText(this.name, '…');
      for (const part of [this.facts, this.verdict]) setText(part, '');
      this.chips.replaceChildren();
      return;
    }
    if (this.clip === row.clip && this.name.textContent === row.name) return;
    this.clip = row.clip;
    setText(this.name, row.name);
    this.name.title = row.name;
    this.writeLabels(row);
    setText(this.facts, [duration(row.seconds), row.licence, row.split,
      `${Math.round(100 * row.rate_hz) / 100} Hz`].filter((word) => word).join(' · '));
    this.facts.title = this.facts.textContent ?? '';
    setText(this.verdict, row.quality);
    this.verdict.className = `clip-verdict verdict-${row.quality}`;
  }

  private writeLabels({labels, found_labels}: ClipRow): void {
    const shown = labels.length > 0 ? labels : found_labels;
    const rest = shown.length - MAX_CHIPS;
    this.chips.replaceChildren(...shown.slice(0, MAX_CHIPS).map((text) =>
      el('span', {class: labels.length > 0 ? 'chip' : 'chip found'}, text)),
    ...(rest > 0 ? [el('span', {class: 'chip more'}, `+${rest}`)] : []));
    this.chips.title = shown.join(', ');
  }
}

export class ClipList {
  private readonly space = el('div', {class: 'clip-space'});
  private readonly empty = el('p', {class: 'clip-empty', hidden: true});
  readonly element = el('div', {class: 'clip-list', tabindex: 0, role: 'listbox',
    'aria-label': 'Clips'}, this.space, this.empty);
  /** Index of the chosen row; -1: none. */
  index = -1;
  private chosenId = '';
  private readonly views: RowView[] = [];
  private waiting = false;

  constructor(private readonly store: ClipStore, private readonly drawings: Drawings,
    private readonly theme: Theme, private readonly listener: ListListener) {
    this.element.addEventListener('scroll', () => this.renew(), {passive: true});
    new ResizeObserver(() => this.renew()).observe(this.element);
    this.space.addEventListener('click', (event) => {
      const row = (event.target as HTMLElement).closest('.clip-row');
      const view = this.views.find(({element}) => element === row);
      if (view) this.choose(view.index, true);
    });
    this.element.addEventListener('keydown', (event) => this.press(event));
    theme.onChange(() => {
      for (const view of this.views) view.drawn = undefined;
      this.renew();
    });
  }

  /** Shows the rows of the store. `isNew`: of another order; the chosen clip stays chosen if
   *  it is among the first rows. */
  show(isNew: boolean): void {
    const {store} = this;
    if (isNew) {
      this.element.scrollTop = 0;
      this.index = store.indexOf(this.chosenId);
      for (const view of this.views) view.clip = -1;
    }
    this.space.style.height = `${store.found * ROW_PX}px`;
    this.element.setAttribute('aria-setsize', String(store.found));
    this.renew();
  }

  /** Text instead of rows; empty: none. */
  tellEmpty(text: string): void {
    setText(this.empty, text);
    this.empty.hidden = text === '';
  }

  /** Draws at the screen's next refresh. */
  renew(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.paint();
    });
  }

  /** Chooses the row at a distance from the chosen one. */
  move(by: number): void {
    const last = this.store.found - 1;
    if (last < 0) return;
    const from = this.index < 0 ? (by > 0 ? -1 : 0) : this.index;
    this.choose(Math.min(Math.max(from + by, 0), last), false);
  }

  choose(index: number, isPressed: boolean): void {
    const row = this.store.row(index);
    this.index = index;
    this.reveal(index);
    this.renew();
    if (!row) return; // Its page arrives; the user moves on or waits.
    this.chosenId = row.clip_id;
    this.listener.chosen(row, isPressed);
  }

  private reveal(index: number): void {
    const {element} = this;
    element.scrollTop = scrolledTo(index, element.scrollTop, element.clientHeight, ROW_PX);
  }

  private press(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const screen = Math.max(1, Math.floor(this.element.clientHeight / ROW_PX) - 1);
    const {found} = this.store;
    const actions: Record<string, () => void> = {
      ArrowDown: () => this.move(1), ArrowUp: () => this.move(-1),
      PageDown: () => this.move(screen), PageUp: () => this.move(-screen),
      Home: () => this.move(-found), End: () => this.move(found),
      Enter: () => this.listener.entered(),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    event.stopPropagation();
    action();
  }

  private paint(): void {
    const {store, element} = this;
    const {scrollTop, clientHeight} = element;
    const {first, last} = visibleRows(scrollTop, clientHeight, ROW_PX, store.found, SPARE_ROWS);
    store.want(first, last);
    this.fit(last - first + 1);
    const clips: number[] = [];
    // A row keeps its element while it is visible.
    for (let index = first; index <= last; ++index) {
      const view = this.views[index % this.views.length];
      const row = store.row(index);
      view.write(index, row);
      const isChosen = index === this.index;
      view.element.setAttribute('aria-selected', String(isChosen));
      if (row) clips.push(row.clip);
      this.drawIn(view, row);
    }
    this.element.setAttribute('aria-activedescendant',
      this.index >= first && this.index <= last ? `clip-row-${this.index}` : '');
    if (this.index >= 0) this.catchUp();
    this.drawings.want(clips);
  }

  /** The chosen row was not here when it was chosen. */
  private catchUp(): void {
    const row = this.store.row(this.index);
    if (!row || row.clip_id === this.chosenId) return;
    this.chosenId = row.clip_id;
    this.listener.chosen(row, false);
  }

  private drawIn(view: RowView, row: ClipRow | null): void {
    const drawing = row ? this.drawings.of(row.clip) : undefined;
    const key = row && drawing !== undefined ? drawing ?? 'missing' : undefined;
    if (key !== undefined && key === view.drawn) return;
    if (key === undefined && view.drawn === 'empty') return;
    view.drawn = key ?? 'empty';
    draw(view.canvas, drawing, this.theme);
  }

  private fit(count: number): void {
    while (this.views.length > count) this.views.pop()!.element.remove();
    while (this.views.length < count) {
      const view = new RowView();
      this.views.push(view);
      this.space.append(view.element);
    }
  }
}

export function foundWords(found: number, all: number): string {
  return found === all ? plural(all, 'clip') : `${found} of ${plural(all, 'clip')}`;
}
