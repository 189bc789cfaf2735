// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Changing the order of a list by dragging its rows.

import {el} from '../base/elements';

export interface DragHandlers {
  /** The row would be inserted before this index. */
  hover(row: HTMLElement, before: number): void;
  drop(row: HTMLElement, before: number): void;
  cancel(): void;
}

/** Distance from the edges of the visible part within which it scrolls, and its step. [px] */
const EDGE_PX = 36;
const STEP_PX = 8;

/** Returns the number of items whose middle is above `y`; `middle` ascends. */
export function rowsAbove(count: number, middle: (index: number) => number, y: number): number {
  let low = 0;
  let high = count;
  while (low < high) {
    const mid = (low + high) >> 1;
    if (middle(mid) < y) low = mid + 1;
    else high = mid;
  }
  return low;
}

function scrollerOf(element: HTMLElement): HTMLElement {
  let one: HTMLElement | null = element.parentElement;
  while (one && !/auto|scroll/.test(getComputedStyle(one).overflowY)) one = one.parentElement;
  return one ?? document.documentElement;
}

export class OpDrag {
  private readonly line = el('div', {class: 'op-drop', hidden: true});
  private row: HTMLElement | null = null;
  private before = -1;
  private y = 0;

  /** Starts at elements of `list` that match `grip`. */
  constructor(private readonly list: HTMLElement, private readonly rows: () => HTMLElement[],
    grip: string, private readonly handlers: DragHandlers) {
    list.addEventListener('pointerdown', (event) => {
      const target = event.target as HTMLElement;
      const row = target.closest<HTMLElement>('li.op');
      if (event.button !== 0 || !target.closest(grip) || !row) return;
      event.preventDefault();
      this.start(row, target, event);
    });
  }

  private start(row: HTMLElement, grip: HTMLElement, {pointerId, clientY}: PointerEvent): void {
    const ending = new AbortController();
    const {signal} = ending;
    const end = (isDropped: boolean): void => {
      ending.abort();
      if (grip.hasPointerCapture(pointerId)) grip.releasePointerCapture(pointerId);
      this.end(isDropped);
    };
    this.row = row;
    this.before = this.rows().indexOf(row);
    this.y = clientY;
    grip.setPointerCapture(pointerId);
    row.classList.add('dragged');
    grip.addEventListener('pointermove', (event) => {
      this.y = event.clientY;
      this.update();
    }, {signal});
    grip.addEventListener('pointerup', () => end(true), {signal});
    grip.addEventListener('pointercancel', () => end(false), {signal});
    window.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape') return;
      event.preventDefault();
      event.stopPropagation();
      end(false);
    }, {signal, capture: true});
    const scroller = scrollerOf(this.list);
    const tick = (): void => {
      if (this.row !== row) return;
      this.scroll(scroller);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  private scroll(scroller: HTMLElement): void {
    const {top, bottom} = scroller.getBoundingClientRect();
    const step = this.y < top + EDGE_PX ? -STEP_PX : this.y > bottom - EDGE_PX ? STEP_PX : 0;
    if (step === 0) return;
    scroller.scrollTop += step;
    this.update();
  }

  private update(): void {
    const {row} = this;
    if (!row) return;
    const rows = this.rows();
    const before = rowsAbove(rows.length, (i) => {
      const {top, height} = rows[i].getBoundingClientRect();
      return top + height / 2;
    }, this.y);
    const from = rows.indexOf(row);
    const stays = before === from || before === from + 1;
    this.line.hidden = stays;
    if (!stays) {
      const edge = before < rows.length ? rows[before].offsetTop
        : rows[rows.length - 1].offsetTop + rows[rows.length - 1].offsetHeight;
      this.line.style.top = `${edge - 1}px`;
      if (!this.line.isConnected) this.list.after(this.line);
    }
    if (before === this.before) return;
    this.before = before;
    this.handlers.hover(row, before);
  }

  private end(isDropped: boolean): void {
    const {row, before} = this;
    this.row = null;
    this.line.remove();
    row?.classList.remove('dragged');
    if (row && isDropped) this.handlers.drop(row, before);
    else this.handlers.cancel();
  }
}
