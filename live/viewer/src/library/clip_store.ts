// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Rows of the list of clips, fetched in pages when they become visible.

import type {ClipRow, ClipsWords, ListOrder, Verdict} from '../protocol/library_protocol';
import type {Reply} from './questions';

export const PAGE_ROWS = 100;

export interface StoreListener {
  /** Rows have arrived; `isNew`: of another order. */
  rowsChanged(isNew: boolean): void;
  /** The order cannot be used; the list stays. */
  orderRefused(text: string): void;
  outdated(): void;
}

export type AskPage = (order: ListOrder, offset: number, count: number) => Promise<Reply>;

export class ClipStore {
  order: ListOrder;
  /** Number of rows; 0 before the first answer. */
  found = 0;
  counts: Record<Verdict, number> = {pass: 0, warn: 0, fail: 0};
  remarks: readonly string[] = [];
  isLoaded = false;
  private pages = new Map<number, readonly ClipRow[]>();
  private readonly asked = new Set<number>();
  private generation = 0;

  constructor(order: ListOrder, private readonly askPage: AskPage,
    private readonly listener: StoreListener) {
    this.order = order;
  }

  /** Loads the first rows of another order, or the same again. The rows of the old one stay
   *  until they arrive. Returns whether the order is shown now. */
  async setOrder(order: ListOrder): Promise<boolean> {
    const generation = ++this.generation;
    const reply = await this.askPage(order, 0, PAGE_ROWS);
    // A newer order was set meanwhile.
    if (generation !== this.generation) return false;
    if (reply.kind === 'outdated') this.listener.outdated();
    if (reply.kind === 'refused') this.listener.orderRefused(reply.text);
    if (reply.kind !== 'answer' || reply.words.type !== 'clips') return false;
    this.order = order;
    this.pages = new Map();
    this.asked.clear();
    this.take(reply.words);
    this.listener.rowsChanged(true);
    return true;
  }

  /** Returns a row; null: it is not here yet. */
  row(index: number): ClipRow | null {
    const page = this.pages.get(Math.floor(index / PAGE_ROWS));
    return page?.[index % PAGE_ROWS] ?? null;
  }

  /** Fetches these rows, both included. */
  want(first: number, last: number): void {
    const end = Math.min(last, this.found - 1);
    for (let page = Math.floor(Math.max(first, 0) / PAGE_ROWS); page * PAGE_ROWS <= end; ++page) {
      if (!this.pages.has(page) && !this.asked.has(page)) void this.load(page);
    }
  }

  /** Returns the index of a clip among the rows that are here; -1: none. */
  indexOf(clip_id: string): number {
    for (const [page, rows] of this.pages) {
      const at = rows.findIndex((row) => row.clip_id === clip_id);
      if (at >= 0) return page * PAGE_ROWS + at;
    }
    return -1;
  }

  private async load(page: number): Promise<void> {
    const {generation} = this;
    this.asked.add(page);
    const reply = await this.askPage(this.order, page * PAGE_ROWS, PAGE_ROWS);
    if (generation !== this.generation) return;
    this.asked.delete(page);
    if (reply.kind === 'outdated') this.listener.outdated();
    if (reply.kind !== 'answer' || reply.words.type !== 'clips') return;
    this.take(reply.words);
    this.listener.rowsChanged(false);
  }

  private take({offset, found, counts, remarks, rows}: ClipsWords): void {
    this.isLoaded = true;
    this.found = found;
    this.counts = counts;
    this.remarks = remarks;
    this.pages.set(Math.floor(offset / PAGE_ROWS), rows);
  }
}
