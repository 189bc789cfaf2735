// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Gestures on the timeline of the edit page: handles are dragged, spans are brushed.

import {button} from '../base/elements';
import {fixed} from '../base/words';
import type {
  Grip, TimelineExtension, TimelineHost, TimelineLayout, TimelinePlace,
} from '../timeline/timeline_extension';
import {AXIS_PX} from '../timeline/timeline_paint';
import type {EditView} from '../edit/edit_view';
import {SpanMenu} from './span_menu';
import type {Handle, HandlePlace} from './timeline_handles';
import {axisHandles, handlesIn, handleWords} from './timeline_handles';
import {SPAN_PX, ToolsPainter} from './timeline_tools_paint';

const KINDS: readonly string[] = ['contacts', 'constraints', 'annotations'];
/** A finger covers rows above and below. */
const TOUCH_ROWS_PX = 12;

/** A brushed span. `row`: the row of contacts that it is in, or null. */
export interface Brush {from: number; to: number; row: number | null}

export class TimelineTools implements TimelineExtension {
  /** The next drag brushes a span; for fingers, which have no shift key. */
  readonly brushButton = button({title: 'Brush a span: drag on the timeline (shift drag, or B at ' +
    'its start and its end)', 'aria-pressed': 'false', onclick: () => this.setBrushing(
    !this.isBrushing)}, 'Brush');
  /** Keys of the page that do what can be dragged. */
  readonly keys: Record<string, () => void> = {
    i: () => this.trimHere('start'), o: () => this.trimHere('end'), b: () => this.brushHere(),
    Escape: () => this.forgetBrush()};
  private host: TimelineHost | null = null;
  private near: Handle | null = null;
  private dragged: {handle: Handle; now: number} | null = null;
  private brush: Brush | null = null;
  /** Start of a span whose end is the shown instant. */
  private begun: number | null = null;
  private isBrushing = false;
  private readonly menu: SpanMenu;

  constructor(private readonly view: EditView,
    private readonly selection: {readonly selected: number | null},
    private readonly tell: (text: string) => void) {
    this.menu = new SpanMenu(view, tell, () => {
      this.brush = null;
      this.host?.repaint();
    });
  }

  // --- Of the timeline ---

  attach(host: TimelineHost): void {
    this.host = host;
  }

  grab(place: TimelinePlace): Grip | null {
    this.menu.close();
    if (!this.view.output) return null;
    if (place.event.shiftKey || this.isBrushing) return this.brushGrip(place);
    const handle = this.nearest(place);
    return handle && this.dragGrip(handle, place);
  }

  hover(place: TimelinePlace | null): {cursor: string; words: string | null} | null {
    const isBrush = place !== null && (place.event.shiftKey || this.isBrushing);
    const near = place && !isBrush ? this.nearest(place) : null;
    if (!isSame(near, this.near)) this.host?.repaint();
    this.near = near;
    if (isBrush) return {cursor: 'text', words: null};
    return near && {cursor: near.side === 'span' ? 'grab' : 'ew-resize',
      words: near.side === 'span' ? near.name : handleWords(near, near.frame, this.rate_hz)};
  }

  paint(context: CanvasRenderingContext2D, layout: TimelineLayout): void {
    const {view, selection: {selected}, dragged, near} = this;
    const begun = this.begun === null ? null : spanOf(this.begun, view.time);
    new ToolsPainter(context, layout, view).paint({selected, dragged, near,
      brush: this.brush ?? (begun && {...begun, row: null})});
  }

  // --- Dragging of handles ---

  private get rate_hz(): number {
    return this.view.output?.rate_hz ?? 1;
  }

  /** The handle that is nearest to the pointer, within its reach. */
  private nearest(place: TimelinePlace): Handle | null {
    const {layout, x_px, reach_px} = place;
    let best: Handle | null = null;
    let least = reach_px;
    const reach = reach_px / Math.max(layout.x(1) - layout.x(0), 1e-6) + 1;
    const frames = [place.frame - reach, place.frame + reach] as const;
    for (const {where, row, away_px} of rowsAt(place)) {
      const {selected} = this.selection;
      for (const handle of handlesIn(this.view, selected, where, row, frames)) {
        const x = layout.x(handle.frame + handle.shift);
        if (handle.side === 'span' || x < layout.left_px - 1 ||
          x > layout.left_px + layout.width_px + 1) continue;
        const away = Math.hypot(x - x_px, away_px);
        if (away < least) [best, least] = [handle, away];
      }
    }
    return best ?? this.spanAt(place);
  }

  /** The selected operation's span, whose bar is in the upper part of the axis. */
  private spanAt({area, y_px, frame}: TimelinePlace): Handle | null {
    if (area !== 'axis' || y_px > SPAN_PX) return null;
    return axisHandles(this.view, this.selection.selected).find((handle) =>
      handle.side === 'span' && handle.low < handle.high && frame >= handle.frame &&
      frame <= handle.frame + (handle.frames ?? 0)) ?? null;
  }

  private dragGrip(handle: Handle, place: TimelinePlace): Grip {
    const {view} = this;
    // The handle does not jump to the pointer.
    const off = handle.frame - place.frame;
    const state = {handle, now: handle.frame};
    this.dragged = state;
    const end = (): void => {
      this.dragged = null;
      this.near = null;
    };
    return {
      move: (frame, {altKey}) => {
        const wanted = altKey ? frame + off : Math.round(frame + off);
        const now = Math.min(Math.max(wanted, handle.low), handle.high);
        if (now === state.now) return;
        state.now = now;
        if (handle.side !== 'span') this.host?.seek(now);
        const change = handle.previews ? handle.change(now) : null;
        if (change) view.preview(change);
      },
      drop: () => {
        end();
        const change = state.now === handle.frame ? null : handle.change(state.now);
        if (change) void view.commit(change);
        else view.cancel();
      },
      cancel: () => {
        end();
        view.cancel();
      },
      words: () => handleWords(handle, state.now, this.rate_hz),
    };
  }

  /** Trims to the shown instant. */
  private trimHere(side: 'start' | 'end'): void {
    const handle = axisHandles(this.view, null).find((one) =>
      one.role === 'trim' && one.side === side);
    if (!handle) return;
    const now = Math.min(Math.max(Math.round(this.view.time), handle.low), handle.high);
    const change = now === handle.frame ? null : handle.change(now);
    if (change) void this.view.commit(change);
    this.tell(handleWords(handle, now, this.rate_hz));
  }

  // --- Brushing of spans ---

  private setBrushing(on: boolean): void {
    this.isBrushing = on;
    this.brushButton.setAttribute('aria-pressed', String(on));
  }

  private get lastFrame(): number {
    return (this.view.output?.frames ?? 1) - 1;
  }

  private inMotion(frame: number): number {
    return Math.min(Math.max(Math.round(frame), 0), this.lastFrame);
  }

  private brushGrip(place: TimelinePlace): Grip {
    const start = this.inMotion(place.frame);
    const {strip, row} = place;
    this.begun = null;
    return {
      move: (frame) => {
        this.brush = {...spanOf(start, this.inMotion(frame)),
          row: strip?.kind === 'contacts' ? row : null};
      },
      drop: () => {
        this.setBrushing(false);
        this.openMenu();
      },
      cancel: () => { this.brush = null; },
      words: () => this.brushWords(),
    };
  }

  private brushWords(): string {
    if (!this.brush) return 'Brush a span';
    const {from, to} = this.brush;
    const [from_s, to_s] = [from / this.rate_hz, to / this.rate_hz];
    return `${fixed(from_s, 3)} to ${fixed(to_s, 3)} s (${fixed(to_s - from_s, 3)} s)`;
  }

  /** Begins a span at the shown instant, or ends it there. */
  private brushHere(): void {
    if (!this.view.output) return;
    const here = this.inMotion(this.view.time);
    if (this.begun === null) {
      this.menu.close();
      this.begun = here;
      this.tell(`A span begins at ${fixed(here / this.rate_hz, 3)} s. Go to its end and press ` +
        'B again; Escape ends this.');
    } else {
      this.brush = {...spanOf(this.begun, here), row: null};
      this.begun = null;
      this.openMenu();
    }
    this.host?.repaint();
  }

  private openMenu(): void {
    const {brush, host, rate_hz} = this;
    if (!brush || !host || brush.from === brush.to) {
      this.brush = null;
      return;
    }
    const {top, bottom} = host.element.getBoundingClientRect();
    this.menu.open({from_s: brush.from / rate_hz, to_s: brush.to / rate_hz, contact: brush.row},
      host.clientX(brush.to), top, bottom);
  }

  private forgetBrush(): void {
    this.menu.close();
    this.begun = null;
    this.brush = null;
    this.setBrushing(false);
    this.host?.repaint();
  }
}

function spanOf(a: number, b: number): {from: number; to: number} {
  return {from: Math.min(a, b), to: Math.max(a, b)};
}

function isSame(a: Handle | null, b: Handle | null): boolean {
  return a?.where === b?.where && a?.row === b?.row && a?.name === b?.name && a?.frame === b?.frame;
}

/** The rows with handles at a pointer, and how far above or below it they are. */
function rowsAt({area, strip, row, y_px, reach_px, layout, event}: TimelinePlace):
  {where: HandlePlace; row: number; away_px: number}[] {
  // A finger on the axis scrubs next to a handle of the axis, not to an edge below it.
  if (area === 'axis') return [{where: 'axis', row: 0, away_px: 0}];
  if (event.pointerType === 'mouse') {
    return strip?.kind && KINDS.includes(strip.kind)
      ? [{where: strip.kind as HandlePlace, row, away_px: 0}] : [];
  }
  const tall = [{where: 'axis' as HandlePlace, row: 0, top: 0, height: AXIS_PX},
    ...layout.bands.flatMap(({strip: of, row: at, top, height}) => (KINDS.includes(of?.kind ?? '')
      ? [{where: of!.kind as HandlePlace, row: at, top, height}] : []))];
  const most_px = Math.min(TOUCH_ROWS_PX, reach_px);
  return tall.map(({where, row: at, top, height}) => ({where, row: at,
    away_px: Math.max(top - y_px, y_px - top - height, 0)}))
    .filter(({away_px}) => away_px <= most_px);
}
