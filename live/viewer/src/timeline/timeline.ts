// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The timeline: shows the position in the recording and changes it.

import {el, setText} from '../base/elements';
import type {Theme} from '../base/theme';
import {clockWords, TimeWindow} from './time_window';
import {Graph, RIGHT_PX} from './graph';
import type {Grip, TimelineExtension, TimelineLayout, TimelinePlace}
  from './timeline_extension';
import type {Band, TimelineData} from './timeline_paint';
import {AXIS_PX, heightOf, layOut, TimelinePainter} from './timeline_paint';

const WIDE_PX = 640;
const GRAPH_PX = 58;
const MOUSE_REACH_PX = 8;
const TOUCH_REACH_PX = 28;
/** A pointer that moves less than this was only pressed. */
const PRESS_PX = 3;

export interface TimelineOptions {
  /** Shared by timelines that show the same frames. */
  window?: TimeWindow;
  /** Part of a page that scrolls: the wheel zooms only after a click on the timeline. */
  scrolled?: boolean;
  graph_px?: number;
  /** Width of the names; without it, it depends on the width of the timeline. */
  gutter_px?: number;
  /** Handles that are dragged, and a picture on top. */
  tools?: TimelineExtension;
}

/** A drag of an extension's handle. After cancel() there is no grip until the pointer is
 *  released. */
interface Hold {pointer: number; grip: Grip | null; start_px: number; moved: boolean}

export class Timeline {
  readonly window: TimeWindow;
  private readonly canvas = el('canvas', {class: 'strips', tabindex: 0, role: 'slider',
    'aria-label': 'Frame'});
  private readonly plots = el('div', {class: 'graphs'});
  private readonly head = el('div', {class: 'playhead'});
  private readonly tip = el('output', {class: 'tip', hidden: true});
  /** The extension's picture: repainted more often than the rows. */
  private readonly over = el('canvas', {class: 'over'});
  readonly element = el('div', {class: 'timeline'}, this.canvas, this.plots, this.head, this.tip);
  private data: TimelineData | null = null;
  private bands: Band[] = [];
  private graphs: Graph[] = [];
  private folded = false;
  private frame = 0;
  private readonly pointers = new Map<number, number>();
  private waiting = false;
  private overWaiting = false;
  private hold: Hold | null = null;

  constructor(private readonly theme: Theme, private readonly seek: (frame: number) => void,
    private readonly options: TimelineOptions = {}) {
    this.window = options.window ?? new TimeWindow();
    this.window.watch(() => this.repaint());
    new ResizeObserver(() => this.repaint()).observe(this.element);
    theme.onChange(() => this.repaint());
    this.listen();
    if (!options.tools) return;
    this.plots.after(this.over);
    options.tools.attach?.({element: this.element, repaint: () => this.repaintOver(), seek,
      clientX: (frame) => this.element.getBoundingClientRect().left + this.layout.x(frame)});
  }

  load(data: TimelineData): void {
    this.data = data;
    this.graphs = data.graphs.map((graph, i) => {
      const old = this.graphs[i];
      if (!old?.fits(graph)) return new Graph(graph, this.theme, this.options.graph_px ?? GRAPH_PX);
      old.data = graph;
      return old;
    });
    this.plots.replaceChildren(...this.graphs.map(({element}) => element));
    this.fold(this.folded);
  }

  /** True if there are bands besides the summary. */
  get foldable(): boolean {
    const {data} = this;
    return data !== null &&
      (data.graphs.length > 0 || data.strips.some(({rows}) => rows.names.length > 0));
  }

  fold(folded: boolean): void {
    this.folded = folded;
    if (!this.data) return;
    this.bands = layOut(this.data, folded);
    this.canvas.style.height = `${heightOf(this.bands)}px`;
    this.plots.hidden = folded;
    this.element.classList.toggle('folded', folded);
    this.repaint();
  }

  /** Sets the shown data and the position. */
  place(first: number, last: number, time: number, shownFrame: number): void {
    const {window: seen, canvas, data} = this;
    seen.setRange(first, last);
    if (time !== this.frame && this.pointers.size === 0) seen.reveal(time);
    this.frame = time;
    this.placeHead();
    if (!data) return;
    canvas.setAttribute('aria-valuemin', String(first));
    canvas.setAttribute('aria-valuemax', String(last));
    canvas.setAttribute('aria-valuenow', String(shownFrame));
    canvas.setAttribute('aria-valuetext', this.clock(shownFrame));
  }

  /** Paints once, at the screen's next refresh. */
  repaint(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.paint();
    });
  }

  /** Returns "0:12.40 · frame 372", or the age when live. */
  clock(frame: number): string {
    const {data} = this;
    if (!data) return '';
    if (data.live) return `${clockWords((frame - this.lastFrame) / data.rate_hz, 1)} s`;
    return `${clockWords(frame / data.rate_hz)} · frame ${frame + data.first_frame}`;
  }

  private get lastFrame(): number {
    return Number(this.canvas.getAttribute('aria-valuemax') ?? 0);
  }

  private get gutter(): number {
    return this.options.gutter_px ?? (this.element.clientWidth < WIDE_PX ? 74 : 118);
  }

  private get plot(): number {
    return Math.max(1, this.element.clientWidth - this.gutter - RIGHT_PX);
  }

  private paint(): void {
    if (!this.data || this.element.clientWidth === 0) return;
    const context = this.contextOf(this.canvas, heightOf(this.bands));
    new TimelinePainter(context, this.theme, this.window, this.gutter, this.plot)
      .paint(this.data, this.bands);
    this.placeHead();
    if (!this.folded) {
      const {from, to} = this.window;
      for (const graph of this.graphs) graph.show(from, to, this.gutter, this.element.clientWidth);
    }
    this.paintOver();
  }

  /** Returns a context in CSS pixels; as wide as the timeline. */
  private contextOf(canvas: HTMLCanvasElement, height_px: number): CanvasRenderingContext2D {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.round(this.element.clientWidth * ratio);
    const height = Math.round(height_px * ratio);
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const context = canvas.getContext('2d')!;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    return context;
  }

  private repaintOver(): void {
    if (this.overWaiting || this.waiting) return;
    this.overWaiting = true;
    requestAnimationFrame(() => {
      this.overWaiting = false;
      this.paintOver();
    });
  }

  private paintOver(): void {
    const {options: {tools}, element: {clientWidth, clientHeight}} = this;
    if (!tools || !this.data || clientWidth === 0) return;
    const context = this.contextOf(this.over, clientHeight);
    context.clearRect(0, 0, clientWidth, clientHeight);
    tools.paint(context, this.layout);
  }

  private placeHead(): void {
    const {head, gutter, plot} = this;
    const x = gutter + this.window.x(this.frame, plot);
    const visible = x >= gutter - 1 && x <= gutter + plot + 1;
    head.style.transform = `translateX(${x.toFixed(1)}px)`;
    if (head.hidden === visible) head.hidden = !visible;
  }

  private frameAt(x_px: number): number {
    return this.window.frame(x_px - this.gutter, this.plot);
  }

  private get layout(): TimelineLayout {
    const {bands, gutter, plot, theme} = this;
    return {bands, left_px: gutter, width_px: plot, height_px: this.element.clientHeight,
      x: (frame) => gutter + this.window.x(frame, plot), colour: (name) => theme.colour(name)};
  }

  private listen(): void {
    const {element, canvas, pointers} = this;
    const at = (event: MouseEvent): number => event.clientX - element.getBoundingClientRect().left;
    element.addEventListener('pointerdown', (event) => {
      element.setPointerCapture(event.pointerId);
      canvas.focus({preventScroll: true});
      pointers.set(event.pointerId, at(event));
      if (pointers.size > 1) this.letGo(false); // A second finger turns a drag into a zoom.
      else if (!this.grab(event)) this.seek(Math.round(this.frameAt(at(event))));
    });
    element.addEventListener('pointermove', (event) => {
      const before = pointers.get(event.pointerId);
      if (this.hold?.pointer === event.pointerId) this.drag(event);
      this.tell(event, at(event));
      if (before === undefined) return;
      pointers.set(event.pointerId, at(event));
      if (pointers.size > 1) this.pinch(event.pointerId, before, at(event));
      else if (!this.hold) this.seek(Math.round(this.frameAt(at(event))));
    });
    for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      element.addEventListener(kind, (event) => {
        pointers.delete(event.pointerId);
        if (this.hold?.pointer !== event.pointerId) return;
        const isPress = kind === 'pointerup' && this.hold.grip && !this.hold.moved;
        this.letGo(kind === 'pointerup');
        this.hold = null;
        if (isPress) this.seek(Math.round(this.frameAt(at(event))));
      });
    }
    element.addEventListener('pointerleave', () => {
      this.tip.hidden = true;
      this.hover(null);
    });
    element.addEventListener('wheel', (event) => {
      if (this.options.scrolled && document.activeElement !== canvas && !event.ctrlKey) return;
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        const share = (event.deltaX || event.deltaY) / this.plot;
        this.window.pan(share * (this.window.to - this.window.from));
      } else {
        this.window.zoom(Math.exp(0.0015 * event.deltaY), this.frameAt(at(event)));
      }
      event.preventDefault();
    }, {passive: false});
    element.addEventListener('dblclick', () => this.window.showAll());
  }

  // --- Extension ---

  private grab(event: PointerEvent): boolean {
    const {tools} = this.options;
    this.hold = null;
    if (!tools || !this.data || event.button !== 0) return false;
    const place = this.placeAt(event);
    const grip = tools.grab(place);
    if (!grip) return false;
    this.hold = {pointer: event.pointerId, grip, start_px: place.x_px, moved: false};
    window.addEventListener('keydown', this.escape, true);
    this.repaintOver();
    return true;
  }

  private drag(event: PointerEvent): void {
    const {hold} = this;
    if (!hold?.grip) return;
    const {x_px, frame} = this.placeAt(event);
    if (!hold.moved && Math.abs(x_px - hold.start_px) < PRESS_PX) return;
    hold.moved = true;
    hold.grip.move(frame, event);
    this.repaintOver();
  }

  /** Ends a drag; `done`: where the pointer is, if it moved. */
  private letGo(done: boolean): void {
    const {hold} = this;
    const grip = hold?.grip;
    if (!hold || !grip) return;
    hold.grip = null;
    window.removeEventListener('keydown', this.escape, true);
    if (done && hold.moved) grip.drop();
    else grip.cancel();
    this.tip.hidden = true;
    this.repaintOver();
  }

  private readonly escape = (event: KeyboardEvent): void => {
    if (event.key !== 'Escape') return;
    event.stopPropagation();
    event.preventDefault();
    this.letGo(false);
  };

  /** Asks the extension about the place of a pointer. Returns its text. */
  private hover(event: PointerEvent | null): string | null {
    const {tools} = this.options;
    if (!tools || !this.data) return null;
    const over = tools.hover(event && this.placeAt(event));
    this.element.style.cursor = over?.cursor ?? '';
    this.canvas.style.cursor = over?.cursor ?? '';
    return over?.words ?? null;
  }

  private placeAt(event: PointerEvent): TimelinePlace {
    const {left, top} = this.element.getBoundingClientRect();
    const [x_px, y_px] = [event.clientX - left, event.clientY - top];
    const band = this.bandAt(y_px);
    const strip = band?.strip ?? null;
    const area = y_px < AXIS_PX ? 'axis' : strip ? 'row' : band ? 'summary'
      : y_px > heightOf(this.bands) ? 'graph' : 'none';
    return {frame: this.frameAt(x_px), strip, row: band?.row ?? 0, area, x_px, y_px, event,
      reach_px: event.pointerType === 'mouse' ? MOUSE_REACH_PX : TOUCH_REACH_PX,
      layout: this.layout};
  }

  private bandAt(y_px: number): Band | undefined {
    return this.bands.find((one) => y_px >= one.top && y_px < one.top + one.height);
  }

  private pinch(id: number, before: number, now: number): void {
    for (const [other, x] of this.pointers) {
      if (other === id) continue;
      this.window.zoom(Math.max(Math.abs(before - x), 1) / Math.max(Math.abs(now - x), 1),
        this.frameAt((now + x) / 2));
    }
  }

  /** Shows the text for the place under the pointer. */
  private tell(event: PointerEvent, x: number): void {
    const {data, tip} = this;
    const frame = Math.round(this.frameAt(x));
    const own = this.hold ? this.hold.grip?.words()
      : this.pointers.size === 0 ? this.hover(event) : null;
    tip.hidden = !data || (!own && (x < this.gutter || frame < this.window.from - 1 ||
      frame > this.window.to + 1));
    if (!data || tip.hidden) return;
    const [top, words] = this.wordsAt(event.clientY, x, frame);
    setText(tip, own ?? `${this.clock(frame)}${words}`);
    const left = Math.min(Math.max(x, tip.offsetWidth / 2),
      this.element.clientWidth - tip.offsetWidth / 2);
    // A place that scrolls would hide an extension's text above the axis.
    const below = own && top < tip.offsetHeight;
    tip.style.transform = `translate(${left.toFixed(0)}px, ${below ? AXIS_PX + 4 : top}px) ` +
      `translate(-50%, ${below ? 0 : -105}%)`;
  }

  /** Returns the upper edge and the text of the row at this place. */
  private wordsAt(clientY: number, x: number, frame: number): [number, string] {
    const {top} = this.element.getBoundingClientRect();
    const y = clientY - top;
    const band = this.bandAt(y);
    if (band?.strip) return [band.top, ` · ${band.strip.words(band.row, frame)}`];
    for (const graph of this.folded ? [] : this.graphs) {
      const box = graph.element.getBoundingClientRect();
      if (clientY >= box.top && clientY < box.bottom) {
        return [box.top - top, ` · ${graph.words(frame)}`];
      }
    }
    const note = y < AXIS_PX && this.data?.notes.find((n) =>
      Math.abs(this.gutter + this.window.x(n.frame, this.plot) - x) < 6);
    return [0, note ? `: ${note.text}` : ''];
  }
}
