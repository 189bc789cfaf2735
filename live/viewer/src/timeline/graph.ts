// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Curves over frames, drawn by uPlot.

import uPlot from 'uplot';
import {el} from '../base/elements';
import type {Theme} from '../base/theme';
import {short} from '../base/words';
import type {Curve} from './timeline_rows';

export const RIGHT_PX = 10; // Room at the right of every plot.
const FONT = '11px system-ui, sans-serif';
const TALL_PX = 100;

/** Curves with a common axis. */
export interface GraphData {
  name: string; unit: string; curves: readonly Curve[]; level?: {value: number; name: string};
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

/** Options that all graphs share: no legend, no cursor, x in plain numbers. */
export function plainPlot(height: number): Pick<uPlot.Options, 'width' | 'height' | 'legend' |
  'cursor'> {
  return {width: 100, height, legend: {show: false}, cursor: {show: false}};
}

/** Returns a point for every value without neighbours, which a line does not show. */
export function lonePoints(u: uPlot, series: number): number[] {
  const values = u.data[series] as (number | null)[];
  const known = (i: number): boolean => values[i] !== null && values[i] !== undefined;
  return values.flatMap((_, i) => (known(i) && !known(i - 1) && !known(i + 1) ? [i] : []));
}

export class Graph {
  readonly element = el('div', {class: 'graph'});
  private readonly plot: uPlot;
  private gutter = 0;
  private y: [number, number] = [0, 1];

  constructor(public data: GraphData, theme: Theme, height: number) {
    const tall = height > TALL_PX;
    this.element.append(el('span', {class: 'name'}, tall ? ''
      : data.unit ? `${data.name} [${data.unit}]` : data.name));
    const quiet = (): string => theme.colour('quiet');
    const rule = (): string => theme.colour('rule');
    this.plot = new uPlot({
      ...plainPlot(height), padding: [5, RIGHT_PX, 5, 0],
      scales: {x: {time: false}, y: {range: () => this.y}},
      axes: [{show: false}, {size: () => this.gutter, gap: 6, font: FONT, stroke: quiet,
        grid: {stroke: rule, width: 1}, ticks: {show: false},
        splits: (_, __, min, max, step) => this.marks(min, max, tall ? step : max - min),
        values: (_, marks) => marks.map((mark) => (mark === data.level?.value ? data.level.name
          : tall ? `${Number(mark.toPrecision(3))} ${data.unit}` : short(mark)))}],
      series: [{}, ...data.curves.map(({colour, dash, width}) => ({dash, width: width ?? 1.5,
        stroke: () => theme.colour(colour ?? 'accent'),
        points: {size: 3, filter: (u: uPlot, i: number) => (dash ? [] : lonePoints(u, i))}}))],
    }, [[]], this.element);
  }

  /** True if show() can draw these data, too, after they replaced `data`. */
  fits({name, unit, curves}: GraphData): boolean {
    return name === this.data.name && unit === this.data.unit &&
      curves.length === this.data.curves.length;
  }

  /** Draws frames `from` to `to`; `width` includes the gutter. */
  show(from: number, to: number, gutter: number, width: number): void {
    const {curves, level} = this.data;
    const first = Math.min(...curves.map((curve) => curve.first));
    const end = Math.max(...curves.map((curve) => curve.end));
    const frames = Array.from({length: Math.max(end - first, 0)}, (_, i) => first + i);
    const lines = curves.map((curve) => frames.map((frame) => curve.at(frame)));
    const [low, high] = rangeOf([...lines.flat(), level?.value ?? null]) ?? [0, 1];
    this.y = this.plot.height > TALL_PX ? [Math.min(low, 0), 1.08 * high] : [low, high];
    this.gutter = gutter;
    if (this.plot.width !== width) this.plot.setSize({width, height: this.plot.height});
    this.plot.setData([frames, ...lines], false);
    this.plot.setScale('x', {min: from, max: to});
  }

  words(frame: number): string {
    const {name, unit, curves: [curve]} = this.data;
    const value = curve.at(frame);
    return `${name}: ${value === null ? 'not known' : `${short(value)} ${unit}`}`;
  }

  private marks(min: number, max: number, step: number): number[] {
    const {level} = this.data;
    const marks = Array.from({length: Math.floor((max - min) / step + 1e-6) + 1},
      (_, i) => min + i * step);
    if (!level) return marks;
    return [...marks.filter((mark) => Math.abs(mark - level.value) > 0.07 * (max - min)),
      level.value];
  }
}
