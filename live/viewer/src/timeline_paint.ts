// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The timeline's picture: an axis, one strip per segment, contacts, graphs.

import type {SceneWords} from './protocol';
import type {Reel} from './reel';
import type {Colours} from './theme';
import type {TimeWindow} from './time_window';
import {clockWords, tickStep_s} from './time_window';
import type {Curve, Rows} from './timeline_rows';

export const AXIS_PX = 20;
const SUMMARY_PX = 18;
export const ROW_PX = 14;
const GRAPH_PX = 58;
const GAP_PX = 6;

export interface TimelineData {
  rows: Rows;
  contacts: Rows | null;
  graphs: readonly Curve[];
  notes: readonly {frame: number; text: string}[];
  rate_hz: number;
  first_frame: number;
  live: boolean;
}

/** Timeline data of a scene; frames are counted from 0, as in the playback. */
export function timelineOf(scene: SceneWords, reel: Reel): TimelineData {
  const {file} = scene;
  const first_frame = file?.first_frame ?? 0;
  return {rows: reel.rows, contacts: reel.contacts, graphs: reel.curves,
    rate_hz: reel.playback.rate_hz, first_frame, live: file === null,
    notes: (file?.notes ?? []).map(({frame, text}) => ({frame: frame - first_frame, text}))};
}

export interface Band {
  kind: 'summary' | 'row' | 'contact' | 'graph';
  index: number;
  top: number;
  height: number;
}

/** Returns the bands from top to bottom. Folded: only the summary. */
export function layOut(data: TimelineData, folded: boolean): Band[] {
  const bands: Band[] = [];
  let top = AXIS_PX;
  const add = (kind: Band['kind'], index: number, height: number): void => {
    bands.push({kind, index, top, height});
    top += height;
  };
  if (data.rows.names.length > 0 || folded) add('summary', 0, SUMMARY_PX);
  if (folded) return bands;
  if (data.rows.names.length > 0) top += GAP_PX;
  data.rows.names.forEach((_, i) => add('row', i, ROW_PX));
  const contacts = data.contacts?.names ?? [];
  if (contacts.length > 0) top += GAP_PX;
  contacts.forEach((_, i) => add('contact', i, ROW_PX));
  data.graphs.forEach((_, i) => {
    top += GAP_PX;
    add('graph', i, GRAPH_PX);
  });
  return bands;
}

export function heightOf(bands: readonly Band[]): number {
  const last = bands[bands.length - 1];
  return (last ? last.top + last.height : AXIS_PX) + GAP_PX;
}

/** Returns the lowest and highest known value; null if there is none. */
export function rangeOf(values: Iterable<number | null>): [number, number] | null {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value === null || !Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return null;
  // The axis starts at zero if this does not flatten the curve.
  return [low >= 0 && low < 0.6 * high ? 0 : low, high > low ? high : low + 1];
}

export class TimelinePainter {
  constructor(private readonly context: CanvasRenderingContext2D,
    private readonly colours: Colours, private readonly window: TimeWindow,
    private readonly gutter: number, private readonly width: number) {}

  paint(data: TimelineData, bands: readonly Band[]): void {
    const {context, gutter, width} = this;
    context.clearRect(0, 0, gutter + width, heightOf(bands) + 100);
    context.font = '11px system-ui, sans-serif';
    context.textBaseline = 'middle';
    this.axis(data);
    for (const band of bands) {
      if (band.kind === 'summary') this.summary(data, band);
      if (band.kind === 'row') this.row(data, band);
      if (band.kind === 'contact') this.contact(data, band);
      if (band.kind === 'graph') this.graph(data.graphs[band.index], band);
    }
    for (const {frame} of data.notes) this.note(frame);
  }

  private x(frame: number): number {
    return this.gutter + this.window.x(frame, this.width);
  }

  private name(text: string, band: Band): void {
    const {context, gutter, colours} = this;
    context.save();
    context.beginPath();
    context.rect(0, band.top, gutter - 6, band.height);
    context.clip();
    context.fillStyle = colours.quiet;
    context.textAlign = 'left';
    // With little room the side is abbreviated to one letter.
    const words = gutter < 100 ? text.replace(/^left /, 'L ').replace(/^right /, 'R ') : text;
    context.fillText(words, 0, band.top + band.height / 2);
    context.restore();
  }

  /** Fills frames `first` to `last`, both included, within the plot. */
  private bar(first: number, last: number, top: number, height: number): void {
    const left = Math.max(this.x(first - 0.5), this.gutter);
    const right = Math.min(this.x(last + 0.5), this.gutter + this.width);
    if (right <= left) return;
    this.context.fillRect(left, top, Math.max(right - left, 1), height);
  }

  private axis(data: TimelineData): void {
    const {context, colours, window, width} = this;
    const second_px = width / (window.to - window.from) * data.rate_hz;
    const step_s = tickStep_s(62 / second_px);
    const decimals = step_s >= 1 ? 0 : step_s >= 0.1 ? 1 : step_s >= 0.01 ? 2 : 3;
    const origin = data.live ? window.to : 0;
    context.textAlign = 'center';
    const first = Math.ceil((window.from - origin) / data.rate_hz / step_s);
    const last = Math.floor((window.to - origin) / data.rate_hz / step_s);
    for (let i = first; i <= last; ++i) {
      const x = this.x(origin + i * step_s * data.rate_hz);
      context.fillStyle = colours.rule;
      context.fillRect(Math.round(x), AXIS_PX - 5, 1, 5);
      const text = data.live && i === 0 ? 'now' : clockWords(i * step_s, decimals);
      const half = context.measureText(text).width / 2;
      // Labels of the first and the last tick move inwards; others that do not fit are omitted.
      const end = x - this.gutter < 1 || this.gutter + width - x < 1;
      const at = Math.min(Math.max(x, this.gutter + half), this.gutter + width - half);
      if (at !== x && !end) continue;
      context.fillStyle = colours.quiet;
      context.fillText(text, at, AXIS_PX / 2 - 2);
    }
  }

  private colourOf(source: number): string {
    return this.colours.sources[source] ?? this.colours.none;
  }

  private strip(top: number, height: number): void {
    this.context.fillStyle = this.colours.sources[0];
    this.bar(this.window.from, this.window.to, top, height);
  }

  private get stride(): number {
    return (this.window.to - this.window.from) / Math.max(this.width, 1);
  }

  /** Paints the numbers of measured, repaired and inferred segments, one column per pixel. */
  private summary(data: TimelineData, band: Band): void {
    const {rows} = data;
    const {from, to} = this.window;
    const all = rows.names.length;
    const height = band.height - 2;
    this.name(all > 0 ? 'all segments' : '', band);
    this.context.fillStyle = all > 0 ? this.colours.sources[0] : this.colours.none;
    this.bar(from, to, band.top, height);
    if (all === 0) return;
    const columns = Math.ceil(this.width);
    const counts = [1, 2, 3].map(() => new Uint16Array(columns));
    rows.names.forEach((_, row) => rows.spans(row, from, to, this.stride,
      (first, last, source) => {
        const left = Math.max(0, Math.floor(this.window.x(first - 0.5, this.width)));
        const right = Math.min(columns, Math.ceil(this.window.x(last + 0.5, this.width)));
        const count = counts[source - 1];
        for (let x = left; count && x < right; ++x) ++count[x];
      }));
    this.columns(counts, all, band.top, height);
  }

  /** Paints worse sources higher up. */
  private columns(counts: readonly Uint16Array[], all: number, top: number,
    height: number): void {
    const {context} = this;
    const above = new Uint16Array(this.width + 1);
    for (const source of [3, 2, 1]) {
      const count = counts[source - 1];
      context.fillStyle = this.colourOf(source);
      // Equal neighbouring columns become one rectangle.
      for (let x = 0, start = 0; x < count.length; x = start) {
        while (start < count.length && count[start] === count[x] && above[start] === above[x]) {
          ++start;
        }
        const [y, tall] = [above[x] / all * height, count[x] / all * height];
        if (tall > 0) context.fillRect(this.gutter + x, top + y, start - x, tall);
      }
      count.forEach((of, x) => { above[x] += of; });
    }
  }

  private row(data: TimelineData, band: Band): void {
    this.name(boneWords(data.rows.names[band.index]), band);
    this.strip(band.top, band.height - 2);
    data.rows.spans(band.index, this.window.from, this.window.to, this.stride,
      (first, last, source) => {
        this.context.fillStyle = this.colourOf(source);
        this.bar(first, last, band.top, band.height - 2);
      });
  }

  private contact({contacts, live}: TimelineData, band: Band): void {
    if (!contacts) return;
    this.name(contacts.names[band.index], band);
    this.context.fillStyle = this.colours.none;
    this.bar(this.window.from, this.window.to, band.top, band.height - 2);
    this.context.fillStyle = this.colours.ink;
    const {from, to} = this.window;
    contacts.spans(band.index, from, to, live ? this.stride : 1, (first, last) =>
      this.bar(first, last, band.top + 2, band.height - 6));
  }

  private graph(graph: Curve, band: Band): void {
    const {context, colours, window, gutter, width} = this;
    const range = rangeOf(valuesOf(graph));
    this.name(graph.unit ? `${graph.name} [${graph.unit}]` : graph.name,
      {...band, height: 14});
    context.fillStyle = colours.none;
    context.fillRect(gutter, band.top + band.height - 1, width, 1);
    if (!range) return;
    const [low, high] = range;
    context.fillStyle = colours.quiet;
    context.textAlign = 'right';
    context.fillText(short(high), gutter - 6, band.top + (band.height > 30 ? 22 : 6));
    context.fillText(short(low), gutter - 6, band.top + band.height - 6);
    const y = (value: number): number =>
      band.top + 3 + (1 - (value - low) / (high - low)) * (band.height - 6);
    context.save();
    context.beginPath();
    context.rect(gutter, band.top, width, band.height);
    context.clip();
    context.beginPath();
    let drawing = false;
    const step = Math.max(1, Math.floor(this.stride / 2));
    const to = Math.min(graph.end - 1, Math.ceil(window.to));
    // Steps are counted from the beginning, so that a live curve keeps its samples.
    const from = Math.floor(Math.max(graph.first, window.from) / step) * step;
    for (let i = from; i <= to; i += step) {
      const value = highest(graph, i, step);
      if (value === null) {
        drawing = false;
        continue;
      }
      if (drawing) context.lineTo(this.x(i), y(value));
      else context.moveTo(this.x(i), y(value));
      drawing = true;
    }
    context.strokeStyle = colours.accent;
    context.lineWidth = 1.5;
    context.lineJoin = 'round';
    context.stroke();
    context.restore();
  }

  private note(frame: number): void {
    const x = this.x(frame);
    if (x < this.gutter || x > this.gutter + this.width) return;
    const {context} = this;
    context.fillStyle = this.colours.accent;
    context.beginPath();
    context.moveTo(x - 4, AXIS_PX - 8);
    context.lineTo(x + 4, AXIS_PX - 8);
    context.lineTo(x, AXIS_PX - 1);
    context.fill();
  }
}

function* valuesOf(curve: Curve): Iterable<number | null> {
  for (let i = curve.first; i < curve.end; ++i) yield curve.at(i);
}

/** Returns the worst source of the frames that share a pixel. */
function highest(curve: Curve, from: number, count: number): number | null {
  let best: number | null = null;
  for (let i = from; i < Math.min(from + count, curve.end); ++i) {
    const value = curve.at(i);
    if (value !== null && Number.isFinite(value) && (best === null || value > best)) best = value;
  }
  return best;
}

export function short(value: number): string {
  const size = Math.abs(value);
  return size >= 100 ? value.toFixed(0) : size >= 10 ? value.toFixed(1) : value.toFixed(2);
}

/** Converts "leftLowerArm" to "left lower arm". */
export function boneWords(bone: string): string {
  return bone.replace(/[a-z][A-Z]/g, (pair) => `${pair[0]} ${pair[1].toLowerCase()}`);
}
