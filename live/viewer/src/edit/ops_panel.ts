// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The list of operations of the recipe, with their figures and forms.

import {button, el, setText} from '../base/elements';
import {plural} from '../base/words';
import {Section} from '../panels/panels';
import type {OpReportWords, OpStep, OpWords, ProgressWords, RenderedParts, RevisionWords} from
  '../protocol/edit_protocol';
import {AddMenu} from '../ops/add_menu';
import {insertIndex} from './edit_view';
import type {EditView} from './edit_view';
import {newOp, shownOf, whyNot} from '../ops/new_op';
import type {Shown} from '../ops/new_op';
import {OpDetail} from './op_detail';
import {OpDrag} from '../ops/op_drag';
import {OpRow} from '../ops/op_row';
import {schemaOf} from '../ops/op_schema';
import {moveTarget, originsOf, originsOfPatch} from '../ops/op_origins';
import type {Origins} from '../ops/op_origins';

type Steps = (ops: readonly OpWords[]) => OpStep[] | null;

export class OpsPanel {
  readonly section = new Section('ops', 'Operations', true);
  private readonly list = el('ol', {class: 'ops', 'aria-label': 'Operations',
    onclick: (event: MouseEvent) => this.click(event),
    onchange: (event: Event) => this.change(event),
    onkeydown: (event: KeyboardEvent) => this.key(event),
    onfocusin: (event: FocusEvent) => this.setTabStop(this.rowAt(event.target))});
  private readonly empty = el('p', {class: 'hint'},
    'The recipe has no operations: the result is the source.');
  private readonly error = el('p', {class: 'op-error', role: 'alert', hidden: true});
  private readonly look = el('p', {class: 'op-look', role: 'status', hidden: true});
  private readonly lookWords = el('span');
  private readonly menu: AddMenu;
  private readonly detail: OpDetail;
  private revision: RevisionWords | null = null;
  private rows: OpRow[] = [];
  private readonly rowOf = new Map<Element, OpRow>();
  private open: OpRow | null = null;
  private tabStop: OpRow | null = null;
  private failed: OpRow | null = null;
  private until: number | null = null;
  /** The last patch of this panel, and the revision that it was made on. */
  private sent: {parent: number; count: number; steps: readonly OpStep[]} | null = null;

  constructor(private readonly view: EditView,
    private readonly looks: {lookAt(until: number | null): void; selected(): void}) {
    this.menu = new AddMenu((name) => void this.add(name),
      (name) => whyNot(name, this.shown(), this.ops), () => this.insertWords());
    this.detail = new OpDetail({view, index: () => this.selected, shown: () => this.shown()}, {
      move: (by) => this.open && this.move(this.open, by),
      remove: () => this.open && void this.remove(this.open),
      look: (until) => this.looks.lookAt(until === this.ops.length ? null : until)});
    this.look.append(this.lookWords, button({onclick: () => this.looks.lookAt(null)},
      'Show the result'));
    this.section.body.append(this.look, this.error, el('div', {class: 'ops-place'}, this.list),
      this.empty, this.menu.element);
    new OpDrag(this.list, () => this.rows.map((row) => row.element), '.op-grip', {
      hover: (element, before) => this.hover(this.rowOf.get(element), before),
      drop: (element, before) => this.drop(this.rowOf.get(element), before),
      cancel: () => this.view.cancel()});
  }

  /** Index of the operation whose form is open. It follows the operation. */
  get selected(): number | null {
    const index = this.open ? this.rows.indexOf(this.open) : -1;
    return index < 0 ? null : index;
  }

  setRevision(revision: RevisionWords): void {
    const before = this.ops;
    const origins = this.originsOfSent(revision) ?? originsOf(before, revision.ops);
    this.revision = revision;
    const old = this.rows;
    this.rows = origins.map((origin) => old[origin] ?? new OpRow());
    const kept = new Set(this.rows);
    for (const row of old) if (!kept.has(row)) this.dropRow(row);
    this.arrange();
    revision.ops.forEach((op, i) => this.rows[i].setOp(i, op));
    this.empty.hidden = this.rows.length > 0;
    this.setTabStop(this.tabStop);
    this.list.classList.add('behind');
    this.writeLook();
    if (this.open?.op) this.detail.update(this.open.op);
    this.tell();
  }

  /** Shows the figures of a result or a preview of the newest revision. */
  setRendered(parts: RenderedParts): void {
    if (parts.revision !== this.revision?.revision) return;
    const reports = new Map<number, OpReportWords[]>();
    for (const report of parts.reports) {
      const list = reports.get(report.op);
      if (list) list.push(report);
      else reports.set(report.op, [report]);
    }
    this.rows.slice(0, parts.until ?? this.rows.length).forEach((row, i) => {
      // In a preview, an inserted operation shifts the others.
      const own = (reports.get(i) ?? []).filter((report) => report.do === row.op?.do);
      row.setReports(own);
    });
    this.list.classList.remove('behind');
    this.detail.setReports(this.open?.reports ?? []);
  }

  setProgress(progress: ProgressWords): void {
    if (progress.revision !== this.revision?.revision) return;
    const {op, state, error} = progress;
    const failed = state === 'failed' && op !== null ? this.rows[op] ?? null : null;
    if (this.failed !== failed) this.failed?.setError('');
    this.failed = failed;
    failed?.setError(error);
    const rest = state === 'failed' && !failed ? error : '';
    setText(this.error, rest);
    this.error.hidden = rest === '';
    this.tell(progress);
  }

  /** `until`: number of operations that the shown motion has; null: all. */
  setLook(until: number | null): void {
    this.until = until;
    this.writeLook();
  }

  /** Opens the form of an operation; null: closes it. */
  select(index: number | null): void {
    const row = index === null ? null : this.rows[index] ?? null;
    if (row === this.open) return;
    this.open?.setDetail(null);
    this.open = row;
    this.detail.close();
    this.looks.selected();
    if (!row?.op) return;
    row.setDetail(this.detail.element);
    this.setTabStop(row);
    this.detail.open(row.op, row.reports);
    this.writeLook();
    if (this.section.open) row.element.scrollIntoView({block: 'nearest'});
  }

  private get ops(): readonly OpWords[] {
    return this.revision?.ops ?? [];
  }

  private shown(): Shown {
    return shownOf(this.view.output, this.view.time, this.revision);
  }

  // --- Changes ---

  private async commit(steps: Steps): Promise<boolean> {
    return this.view.commit((ops) => {
      const made = steps(ops);
      this.sent = made && {parent: this.view.document.revision?.revision ?? 0,
        count: ops.length, steps: made};
      return made;
    });
  }

  private insertWords(): string {
    const at = insertIndex(this.ops, this.view.until);
    const op = this.ops[at - 1];
    return op ? `It is inserted after ${at} ${schemaOf(op).title}.` : 'It becomes the first one.';
  }

  private async add(name: string): Promise<void> {
    const op = newOp(name, this.shown());
    let at = 0;
    const isDone = await this.commit((ops) => {
      at = name === 'retarget' ? ops.length : insertIndex(ops, this.view.until);
      return [{insert: at, op}];
    });
    if (isDone) {
      this.select(at);
      this.rows[at]?.focus();
    } else this.menu.button.focus();
  }

  private async remove(row: OpRow): Promise<void> {
    const index = this.rows.indexOf(row);
    const isDone = await this.commit(() => this.stepFor(row, (i) => [{remove: i}]));
    if (isDone) (this.rows[Math.min(index, this.rows.length - 1)] ?? this.menu.button).focus();
  }

  private move(row: OpRow, by: -1 | 1): void {
    void this.commit((ops) => this.stepFor(row, (i) =>
      i + by < 0 || i + by >= ops.length ? null : [{move: i, to: i + by}]));
  }

  private drop(row: OpRow | undefined, before: number): void {
    const to = row ? moveTarget(this.rows.indexOf(row), before) : null;
    if (row && to !== null) void this.commit(() => this.stepFor(row, (i) => [{move: i, to}]));
    else this.view.cancel();
  }

  private hover(row: OpRow | undefined, before: number): void {
    const to = row ? moveTarget(this.rows.indexOf(row), before) : null;
    if (!row || to === null) this.view.cancel();
    else this.view.preview(() => this.stepFor(row, (i) => [{move: i, to}]));
  }

  /** Calls `make` with the index of the row's operation; null if it no longer exists. */
  private stepFor(row: OpRow, make: (index: number) => OpStep[] | null): OpStep[] | null {
    const index = this.rows.indexOf(row);
    return index < 0 ? null : make(index);
  }

  // --- Events of the list ---

  private rowAt(target: EventTarget | null): OpRow | null {
    const element = (target as HTMLElement | null)?.closest('li.op');
    return element ? this.rowOf.get(element) ?? null : null;
  }

  private click(event: MouseEvent): void {
    const row = this.rowAt(event.target);
    if (!row || !(event.target as HTMLElement).closest('.op-open')) return;
    this.select(row === this.open ? null : this.rows.indexOf(row));
  }

  private change(event: Event): void {
    const box = event.target as HTMLInputElement;
    const row = this.rowAt(box);
    if (!row || !box.classList.contains('op-on')) return;
    const off = !box.checked;
    void this.commit(() => this.stepFor(row, (i) => [{toggle: i, off}])).then((isDone) => {
      const index = this.rows.indexOf(row);
      if (!isDone && index >= 0) row.setOp(index, this.ops[index]);
    });
  }

  private key(event: KeyboardEvent): void {
    const row = this.rowAt(event.target);
    if (!row || !(event.target as HTMLElement).matches('.op-open, .op-on')) return;
    const by = event.key === 'ArrowUp' ? -1 : event.key === 'ArrowDown' ? 1 : null;
    if (by !== null && event.altKey) this.move(row, by);
    else if (by !== null) this.rows[this.rows.indexOf(row) + by]?.focus();
    else if (event.key === 'Delete') void this.remove(row);
    else if (event.key === 'Escape' && row === this.open) this.select(null);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  // --- Rows ---

  /** Returns the origins of a revision that the last patch of this panel has made. */
  private originsOfSent({parent, cause, ops}: RevisionWords): Origins | null {
    const {sent} = this;
    if (!sent || sent.parent !== parent || cause !== 'edit') return null;
    this.sent = null;
    const origins = originsOfPatch(sent.count, sent.steps);
    const fits = origins.length === ops.length && sent.count === this.ops.length &&
      origins.every((origin, i) => origin < 0 || this.ops[origin].do === ops[i].do);
    return fits ? origins : null;
  }

  private dropRow(row: OpRow): void {
    if (row === this.open) this.select(null);
    if (row === this.failed) this.failed = null;
    if (row === this.tabStop) this.tabStop = null;
    this.rowOf.delete(row.element);
    row.element.remove();
  }

  /** Puts the rows into their order. The open row is not inserted again, so that its form
   *  keeps the focus and unfinished values. */
  private arrange(): void {
    const active = document.activeElement as HTMLElement | null;
    const pinned = this.open?.element.contains(active) ? this.open : this.rowAt(active);
    let next = this.list.firstElementChild;
    for (const row of this.rows) {
      const {element} = row;
      this.rowOf.set(element, row);
      if (element === next || (row === pinned && element.isConnected)) {
        next = element.nextElementSibling;
      } else this.list.insertBefore(element, next);
    }
    if (active?.isConnected && document.activeElement !== active) active.focus();
  }

  private setTabStop(row: OpRow | null): void {
    const stop = row ?? this.rows[0] ?? null;
    if (this.tabStop !== stop) this.tabStop?.setTabStop(false);
    this.tabStop = stop;
    stop?.setTabStop(true);
  }

  private writeLook(): void {
    const {until} = this;
    this.rows.forEach((row, i) => row.setBeyond(until !== null && i >= until));
    this.look.hidden = until === null;
    const op = until ? this.ops[until - 1] : undefined;
    setText(this.lookWords, op ? `Shown: the motion after ${until} ${schemaOf(op).title}.`
      : 'Shown: the motion before all operations.');
    this.detail.setLook(this.selected, until, this.ops);
  }

  private tell(progress: ProgressWords | null = null): void {
    const count = plural(this.rows.length, 'operation');
    this.section.tell(progress?.state === 'rendering' && progress.total > 0
      ? `rendering ${progress.done} of ${progress.total}`
      : progress?.state === 'failed' ? `${count}, failed` : count);
  }
}
