// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The timeline: shows the position in the recording and changes it.

import {el, setText} from './elements';
import type {Theme} from './theme';
import {clockWords, TimeWindow} from './time_window';
import type {Band, TimelineData} from './timeline_paint';
import {AXIS_PX, boneWords, heightOf, layOut, short, TimelinePainter} from './timeline_paint';
import {BEARS, sourceWords} from './timeline_rows';

const WIDE_PX = 640;

export class Timeline {
  readonly window = new TimeWindow();
  private readonly canvas = el('canvas', {class: 'strips', tabindex: 0, role: 'slider',
    'aria-label': 'Frame'});
  private readonly head = el('div', {class: 'playhead'});
  private readonly tip = el('output', {class: 'tip', hidden: true});
  readonly element = el('div', {class: 'timeline'}, this.canvas, this.head, this.tip);
  private data: TimelineData | null = null;
  private bands: Band[] = [];
  private folded = false;
  private frame = 0;
  private readonly pointers = new Map<number, number>();
  private waiting = false;

  constructor(private readonly theme: Theme, private readonly seek: (frame: number) => void) {
    new ResizeObserver(() => this.repaint()).observe(this.element);
    theme.onChange(() => this.repaint());
    this.listen();
  }

  load(data: TimelineData): void {
    this.data = data;
    this.fold(this.folded);
  }

  /** True if there are bands besides the summary. */
  get foldable(): boolean {
    const {data} = this;
    return data !== null &&
      data.rows.names.length + (data.contacts?.names.length ?? 0) + data.graphs.length > 0;
  }

  fold(folded: boolean): void {
    this.folded = folded;
    if (!this.data) return;
    this.bands = layOut(this.data, folded);
    this.canvas.style.height = `${heightOf(this.bands)}px`;
    this.element.classList.toggle('folded', folded);
    this.repaint();
  }

  /** Sets the shown data and the position. */
  place(first: number, last: number, time: number, shownFrame: number): void {
    const {window: seen, canvas, data} = this;
    const {from, to} = seen;
    seen.setRange(first, last);
    if (time !== this.frame && this.pointers.size === 0) seen.reveal(time);
    this.frame = time;
    if (seen.from !== from || seen.to !== to) this.repaint();
    const x = this.gutter + seen.x(time, this.plot);
    const visible = x >= this.gutter - 1 && x <= this.gutter + this.plot + 1;
    this.head.style.transform = `translateX(${x.toFixed(1)}px)`;
    if (this.head.hidden === visible) this.head.hidden = !visible;
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

  showAll(): void {
    this.window.showAll();
    this.repaint();
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
    return this.element.clientWidth < WIDE_PX ? 74 : 118;
  }

  private get plot(): number {
    return Math.max(1, this.element.clientWidth - this.gutter - 10);
  }

  private paint(): void {
    if (!this.data || this.element.clientWidth === 0) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const {canvas} = this;
    const width = Math.round(this.element.clientWidth * ratio);
    const height = Math.round(heightOf(this.bands) * ratio);
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const context = canvas.getContext('2d')!;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    new TimelinePainter(context, this.theme.colours, this.window, this.gutter, this.plot)
      .paint(this.data, this.bands);
  }

  private frameAt(x_px: number): number {
    return this.window.frame(x_px - this.gutter, this.plot);
  }

  private listen(): void {
    const {canvas, pointers} = this;
    const at = (event: PointerEvent | WheelEvent): number =>
      event.clientX - this.element.getBoundingClientRect().left;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, at(event));
      if (pointers.size === 1) this.seek(Math.round(this.frameAt(at(event))));
    });
    canvas.addEventListener('pointermove', (event) => {
      const before = pointers.get(event.pointerId);
      if (before === undefined) {
        this.tell(event, at(event));
        return;
      }
      pointers.set(event.pointerId, at(event));
      if (pointers.size === 1) this.seek(Math.round(this.frameAt(at(event))));
      else this.pinch(event.pointerId, before, at(event));
    });
    for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(kind, (event) => pointers.delete(event.pointerId));
    }
    canvas.addEventListener('pointerleave', () => { this.tip.hidden = true; });
    canvas.addEventListener('wheel', (event) => {
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        const share = (event.deltaX || event.deltaY) / this.plot;
        this.window.pan(share * (this.window.to - this.window.from));
      } else {
        this.window.zoom(Math.exp(0.0015 * event.deltaY), this.frameAt(at(event)));
      }
      event.preventDefault();
      this.repaint();
    }, {passive: false});
    canvas.addEventListener('dblclick', () => this.showAll());
  }

  private pinch(id: number, before: number, now: number): void {
    for (const [other, x] of this.pointers) {
      if (other === id) continue;
      this.window.zoom(Math.max(Math.abs(before - x), 1) / Math.max(Math.abs(now - x), 1),
        this.frameAt((now + x) / 2));
    }
    this.repaint();
  }

  /** Returns the text for the place under the pointer. */
  private tell(event: PointerEvent, x: number): void {
    const {data, tip} = this;
    const frame = Math.round(this.frameAt(x));
    const y = event.clientY - this.canvas.getBoundingClientRect().top;
    const band = this.bands.find(({top, height}) => y >= top && y < top + height);
    const note = y < AXIS_PX && data?.notes.find((n) => Math.abs(this.gutter +
      this.window.x(n.frame, this.plot) - x) < 6);
    tip.hidden = !data || x < this.gutter || frame < this.window.from - 1 ||
      frame > this.window.to + 1;
    if (!data || tip.hidden) return;
    setText(tip, `${this.clock(frame)}${note ? `: ${note.text}` : ''}${this.words(band, frame)}`);
    const left = Math.min(Math.max(x, tip.offsetWidth / 2),
      this.element.clientWidth - tip.offsetWidth / 2);
    tip.style.transform = `translate(${left.toFixed(0)}px, 0) translate(-50%, -105%)`;
  }

  private words(band: Band | undefined, frame: number): string {
    const {data} = this;
    if (!band || !data) return '';
    if (band.kind === 'row') {
      return ` · ${boneWords(data.rows.names[band.index])}: ` +
        sourceWords(data.rows.source(band.index, frame));
    }
    if (band.kind === 'contact' && data.contacts) {
      const bears = data.contacts.source(band.index, frame) === BEARS;
      return ` · ${data.contacts.names[band.index]}${bears ? ': bears' : ''}`;
    }
    if (band.kind === 'graph') {
      const {name, unit} = data.graphs[band.index];
      const value = data.graphs[band.index].at(frame);
      return value === null ? ` · ${name}: not known` : ` · ${name}: ${short(value)} ${unit}`;
    }
    return '';
  }
}
