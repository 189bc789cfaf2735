// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The timeline's picture: an axis, and strips of rows.

import type {Theme} from '../base/theme';
import {boneWords} from '../base/words';
import {SOURCES} from '../protocol/protocol';
import type {SceneWords} from '../protocol/protocol';
import type {GraphData} from './graph';
import type {Reel} from './reel';
import type {TimeWindow} from './time_window';
import {clockWords, tickStep_s} from './time_window';
import {BEARS, sourceWords} from './timeline_rows';
import type {Rows} from './timeline_rows';

export const AXIS_PX = 20;
const SUMMARY_PX = 18;
export const ROW_PX = 14;
const GAP_PX = 6;

/** The style of runs of one source: a colour, and the part of the row that they fill. */
export interface Look {
  colour: string; top?: number; height?: number;
  /** Width that a short run has at least. */
  least?: number;
}

/** Rows that are drawn alike. */
export interface Strip {
  /** Kind of the rows, for an extension of the timeline. */
  kind?: string;
  rows: Rows;
  /** Colour of frames that are in no run. */
  base: string;
  /** Indexed by source. */
  looks: readonly Look[];
  /** Text on a place, after the time. */
  words(row: number, frame: number): string;
  /** Texts next to the names. */
  marks?: readonly string[];
}

export interface TimelineData {
  strips: readonly Strip[];
  /** Rows of sources whose numbers are summed up in a first band. */
  summary: Rows | null;
  graphs: readonly GraphData[]; notes: readonly {frame: number; text: string}[]; rate_hz: number;
  first_frame: number; live: boolean;
}

const SOURCE_COLOURS = [...SOURCES, 'seen-none'];

/** Rows of segments: measured, repaired, inferred, absent. */
export function sourceStrip(rows: Rows): Strip {
  return {rows, base: 'measured', looks: SOURCE_COLOURS.map((colour) => ({colour})),
    words: (row, frame) => `${boneWords(rows.names[row])}: ${sourceWords(rows.source(row, frame))}`};
}

function contactStrip(rows: Rows): Strip {
  const bearing = {colour: 'ink', top: 2, height: ROW_PX - 6};
  return {rows, base: 'seen-none', looks: [bearing, bearing], words: (row, frame) =>
    `${rows.names[row]}${rows.source(row, frame) === BEARS ? ': bears' : ''}`};
}

/** Timeline data of a scene; frames are counted from 0, as in the playback. */
export function timelineOf(scene: SceneWords, reel: Reel): TimelineData {
  const {file} = scene;
  const first_frame = file?.first_frame ?? 0;
  return {strips: [sourceStrip(reel.rows), ...(reel.contacts ? [contactStrip(reel.contacts)] : [])],
    summary: reel.rows, graphs: reel.graphs, rate_hz: reel.playback.rate_hz, first_frame,
    live: file === null,
    notes: (file?.notes ?? []).map(({frame, text}) => ({frame: frame - first_frame, text}))};
}

export interface Band {
  /** null: the summary. */
  strip: Strip | null;
  row: number; top: number; height: number;
}

/** Returns the bands from top to bottom. Folded: only the summary. */
export function layOut(data: Pick<TimelineData, 'strips' | 'summary'>, folded: boolean): Band[] {
  const bands: Band[] = [];
  let top = AXIS_PX;
  const add = (strip: Strip | null, row: number, height: number): void => {
    bands.push({strip, row, top, height});
    top += height;
  };
  if (folded || (data.summary && data.summary.names.length > 0)) add(null, 0, SUMMARY_PX);
  for (const strip of folded ? [] : data.strips) {
    if (strip.rows.names.length > 0 && bands.length > 0) top += GAP_PX;
    strip.rows.names.forEach((_, i) => add(strip, i, ROW_PX));
  }
  return bands;
}

export function heightOf(bands: readonly Band[]): number {
  const last = bands[bands.length - 1];
  return (last ? last.top + last.height : AXIS_PX) + GAP_PX;
}

export class TimelinePainter {
  constructor(private readonly context: CanvasRenderingContext2D,
    private readonly theme: Theme, private readonly window: TimeWindow,
    private readonly gutter: number, private readonly width: number) {}

  paint(data: TimelineData, bands: readonly Band[]): void {
    const {context, gutter, width} = this;
    context.clearRect(0, 0, gutter + width, heightOf(bands) + 100);
    context.font = '11px system-ui, sans-serif';
    context.textBaseline = 'middle';
    this.axis(data);
    for (const band of bands) {
      if (band.strip) this.row(band.strip, band);
      else this.summary(data.summary, band);
    }
    for (const {frame} of data.notes) this.note(frame);
  }

  private x(frame: number): number {
    return this.gutter + this.window.x(frame, this.width);
  }

  private name(text: string, band: Band, mark = ''): void {
    const {context, gutter, theme} = this;
    const middle = band.top + band.height / 2;
    context.fillStyle = theme.colour('quiet');
    context.textAlign = 'right';
    context.fillText(mark, gutter - 6, middle);
    context.save();
    context.beginPath();
    context.rect(0, band.top, gutter - 10 - context.measureText(mark).width, band.height);
    context.clip();
    context.textAlign = 'left';
    // With little room the side is abbreviated to one letter.
    const words = gutter < 100 ? text.replace(/^left /, 'L ').replace(/^right /, 'R ') : text;
    context.fillText(words, 0, middle);
    context.restore();
  }

  /** Fills frames `first` to `last`, both included, within the plot. */
  private bar(first: number, last: number, top: number, height: number, least = 1): void {
    const left = Math.max(this.x(first - 0.5), this.gutter);
    const right = Math.min(this.x(last + 0.5), this.gutter + this.width);
    if (right <= left) return;
    this.context.fillRect(left, top, Math.max(right - left, least), height);
  }

  private axis(data: TimelineData): void {
    const {context, theme, window, width} = this;
    const second_px = width / (window.to - window.from) * data.rate_hz;
    const step_s = tickStep_s(62 / second_px);
    const decimals = step_s >= 1 ? 0 : step_s >= 0.1 ? 1 : step_s >= 0.01 ? 2 : 3;
    const origin = data.live ? window.to : 0;
    context.textAlign = 'center';
    const first = Math.ceil((window.from - origin) / data.rate_hz / step_s);
    const last = Math.floor((window.to - origin) / data.rate_hz / step_s);
    for (let i = first; i <= last; ++i) {
      const x = this.x(origin + i * step_s * data.rate_hz);
      context.fillStyle = theme.colour('rule');
      context.fillRect(Math.round(x), AXIS_PX - 5, 1, 5);
      const text = data.live && i === 0 ? 'now' : clockWords(i * step_s, decimals);
      const half = context.measureText(text).width / 2;
      // Labels of the first and the last tick move inwards; others that do not fit are omitted.
      const end = x - this.gutter < 1 || this.gutter + width - x < 1;
      const at = Math.min(Math.max(x, this.gutter + half), this.gutter + width - half);
      if (at !== x && !end) continue;
      context.fillStyle = theme.colour('quiet');
      context.fillText(text, at, AXIS_PX / 2 - 2);
    }
  }

  private get stride(): number {
    return (this.window.to - this.window.from) / Math.max(this.width, 1);
  }

  /** Paints the numbers of measured, repaired and inferred segments, one column per pixel. */
  private summary(rows: Rows | null, band: Band): void {
    const {from, to} = this.window;
    const all = rows?.names.length ?? 0;
    const height = band.height - 2;
    this.name(all > 0 ? 'all segments' : '', band);
    this.context.fillStyle = all > 0 ? this.theme.colour('measured') : this.theme.colour('seen-none');
    this.bar(from, to, band.top, height);
    if (!rows || all === 0) return;
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
      context.fillStyle = this.theme.colour(SOURCE_COLOURS[source]);
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

  private row({rows, base, looks, marks}: Strip, {row, top, height}: Band): void {
    const {context, theme, window: {from, to}} = this;
    this.name(boneWords(rows.names[row]), {strip: null, row, top, height}, marks?.[row]);
    context.fillStyle = theme.colour(base);
    this.bar(from, to, top, height - 2);
    rows.spans(row, from, to, this.stride, (first, last, source) => {
      const look = looks[source];
      context.fillStyle = theme.colour(look.colour);
      this.bar(first, last, top + (look.top ?? 0), look.height ?? height - 2, look.least);
    });
  }

  private note(frame: number): void {
    const x = this.x(frame);
    if (x < this.gutter || x > this.gutter + this.width) return;
    const {context} = this;
    context.fillStyle = this.theme.colour('accent');
    context.beginPath();
    context.moveTo(x - 4, AXIS_PX - 8);
    context.lineTo(x + 4, AXIS_PX - 8);
    context.lineTo(x, AXIS_PX - 1);
    context.fill();
  }
}
