// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Curves of a jump: height of the centre of mass and push, captured and new, with the phases.

import {tickStep} from './loop_search';
import type {JumpWords} from '../protocol/edit_protocol';
import {el} from '../base/elements';
import type {Theme} from '../base/theme';
import {fixed} from '../base/words';

const LEFT_PX = 34;
const RIGHT_PX = 8;
const TOP_PX = 18;
const PLOT_PX = 104;
/** Between the plots: names of the phases, then the title of the second plot. */
const GAP_PX = 38;
const BOTTOM_PX = 18;
const HEIGHT_PX = TOP_PX + 2 * PLOT_PX + GAP_PX + BOTTOM_PX;

type Values = readonly (number | null)[];
interface Plot {
  title: string; top: number; captured: Values; made: Values; low: number; high: number;
  strength: number | null;
}

/** Returns the range of an axis: all values with a margin. */
export function rangeWithMargin(values: Iterable<number | null>, share = 0.08): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null || !Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  const margin = high > low ? share * (high - low) : 0.5;
  return [low - margin, high + margin];
}

export class JumpCurves {
  private readonly canvas = el('canvas', {role: 'img', 'aria-label':
    'Height of the centre of mass and push over time, captured and new'});
  private readonly now = el('div', {class: 'now', hidden: true});
  readonly element = el('div', {class: 'jump-curves'}, this.canvas, this.now);
  private words: JumpWords | null = null;
  private plots: Plot[] = [];
  private width = 0;
  private time_s: number | null = null;
  private isWaiting = false;

  /** `seek` receives a time of the new motion. [s] */
  constructor(private readonly theme: Theme, seek: (time_s: number) => void) {
    new ResizeObserver(() => this.repaint()).observe(this.element);
    theme.onChange(() => this.repaint());
    const {canvas} = this;
    const go = ({offsetX, pointerId}: PointerEvent): void => {
      const range = this.range();
      if (!range || !canvas.hasPointerCapture(pointerId)) return;
      const share = Math.min(Math.max((offsetX - LEFT_PX) / this.plotWidth, 0), 1);
      seek(range[0] + share * (range[1] - range[0]));
    };
    canvas.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      canvas.setPointerCapture(event.pointerId);
      go(event);
    });
    canvas.addEventListener('pointermove', go);
  }

  load(words: JumpWords | null): void {
    this.words = words;
    this.element.hidden = words === null || words.time_s.length < 2;
    if (words) this.plots = plotsOf(words);
    this.repaint();
  }

  /** Marks this time of the new motion; null: the shown motion has other times. */
  setTime(time_s: number | null): void {
    this.time_s = time_s;
    const range = this.range();
    const isShown = time_s !== null && range !== null && time_s >= range[0] &&
      time_s <= range[1] && this.width > 0;
    if (this.now.hidden === isShown) this.now.hidden = !isShown;
    if (!isShown) return;
    this.now.style.transform = `translate(${this.x(time_s).toFixed(1)}px, ${TOP_PX}px) ` +
      `scaleY(${2 * PLOT_PX + GAP_PX})`;
  }

  private range(): [number, number] | null {
    const times = this.words?.time_s ?? [];
    return times.length > 1 ? [times[0], times[times.length - 1]] : null;
  }

  private get plotWidth(): number {
    return Math.max(this.width - LEFT_PX - RIGHT_PX, 1);
  }

  private x(time_s: number): number {
    const [from, to] = this.range()!;
    return LEFT_PX + (time_s - from) / (to - from) * this.plotWidth;
  }

  // --- Painting ---

  /** Paints once, at the screen's next refresh. */
  private repaint(): void {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      const width = this.canvas.clientWidth;
      if (!this.range() || width === 0) return;
      this.width = width;
      this.paint(this.words!);
    });
  }

  private paint(words: JumpWords): void {
    const {canvas, theme} = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    canvas.style.height = `${HEIGHT_PX}px`;
    canvas.width = Math.round(this.width * ratio);
    canvas.height = Math.round(HEIGHT_PX * ratio);
    const context = canvas.getContext('2d')!;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.font = `11px ${getComputedStyle(canvas).fontFamily}`;
    context.textBaseline = 'middle';
    this.paintFlight(context, words);
    for (const plot of this.plots) this.paintAxes(context, plot);
    this.paintTimes(context);
    this.paintPhases(context, words);
    for (const plot of this.plots) {
      if (plot.strength !== null) this.paintStrength(context, words, plot, plot.strength);
      this.paintLine(context, plot, plot.captured, theme.colour('quiet'), 1.5, [4, 3]);
      this.paintLine(context, plot, plot.made, theme.colour('accent'), 2, []);
    }
    this.setTime(this.time_s);
  }

  private paintFlight(context: CanvasRenderingContext2D, {phases}: JumpWords): void {
    if (!phases) return;
    const [from, to] = [this.x(phases.takeoff_s), this.x(phases.landing_s)];
    context.fillStyle = this.theme.colour('color-mix(in srgb, var(--accent) 9%, transparent)');
    for (const {top} of this.plots) context.fillRect(from, top, to - from, PLOT_PX);
  }

  private y({top, low, high}: Plot, value: number): number {
    return top + (high - value) / (high - low) * PLOT_PX;
  }

  private paintAxes(context: CanvasRenderingContext2D, plot: Plot): void {
    const {theme} = this;
    const step = tickStep(plot.high - plot.low, 4);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    context.lineWidth = 1;
    context.textAlign = 'right';
    for (let k = Math.ceil(plot.low / step); k * step <= plot.high; ++k) {
      const y = Math.round(this.y(plot, k * step)) + 0.5;
      context.strokeStyle = theme.colour(k === 0 ? 'quiet' : 'rule');
      line(context, LEFT_PX, y, LEFT_PX + this.plotWidth, y);
      context.fillStyle = theme.colour('quiet');
      // The title is above the axis.
      if (y > plot.top + 4) context.fillText(fixed(k * step, decimals), LEFT_PX - 5, y);
    }
    context.textAlign = 'left';
    context.fillText(plot.title, 0, plot.top - 11);
  }

  private paintTimes(context: CanvasRenderingContext2D): void {
    const [from, to] = this.range()!;
    const step = tickStep(to - from, this.plotWidth / 50);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    context.textAlign = 'center';
    for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9; ++k) {
      const x = this.x(k * step);
      if (x > LEFT_PX + this.plotWidth - 14) continue;
      context.fillText(fixed(k * step, decimals), x, HEIGHT_PX - 8);
    }
    context.textAlign = 'right';
    context.fillText('s', LEFT_PX + this.plotWidth, HEIGHT_PX - 8);
  }

  /** Lines of P1 to P5, with their names above both plots. */
  private paintPhases(context: CanvasRenderingContext2D, {phases}: JumpWords): void {
    if (!phases) return;
    const marks = [phases.start_s, phases.lowest_s, phases.takeoff_s, phases.landing_s,
      phases.end_s];
    context.textAlign = 'center';
    context.strokeStyle = this.theme.colour('quiet');
    context.lineWidth = 1;
    const names_px = TOP_PX + PLOT_PX + 10;
    marks.forEach((time_s, i) => {
      const x = Math.round(this.x(time_s)) + 0.5;
      context.globalAlpha = 0.55;
      for (const {top} of this.plots) line(context, x, top, x, top + PLOT_PX);
      context.globalAlpha = 1;
      context.fillStyle = this.theme.colour('ink');
      context.fillText(`P${i + 1}`, x, names_px);
    });
  }

  /** The landing may take more: the line is that of the push. */
  private paintStrength(context: CanvasRenderingContext2D, {phases}: JumpWords, plot: Plot,
    value: number): void {
    const y = this.y(plot, value);
    const [from, to] = phases ? [this.x(phases.start_s), this.x(phases.takeoff_s)]
      : [LEFT_PX, LEFT_PX + this.plotWidth];
    context.strokeStyle = this.theme.colour('fair');
    context.fillStyle = this.theme.colour('fair');
    context.setLineDash([6, 3]);
    line(context, from, y, to, y);
    context.setLineDash([]);
    const words = `≤ ${fixed(value, 1)} g`;
    const isAfter = to + 50 < LEFT_PX + this.plotWidth;
    context.textAlign = isAfter ? 'left' : 'right';
    context.fillText(words, isAfter ? to + 5 : to - 2,
      isAfter ? y : y + (y - plot.top < 16 ? 9 : -8));
  }

  private paintLine(context: CanvasRenderingContext2D, plot: Plot, values: Values, colour: string,
    width: number, dash: number[]): void {
    const times = this.words!.time_s;
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.lineJoin = 'round';
    context.setLineDash(dash);
    context.beginPath();
    let isDown = false;
    values.forEach((value, i) => {
      if (value === null) {
        isDown = false;
        return;
      }
      const [x, y] = [this.x(times[i]), this.y(plot, value)];
      if (isDown) context.lineTo(x, y);
      else context.moveTo(x, y);
      isDown = true;
    });
    context.stroke();
    context.setLineDash([]);
  }
}

function line(context: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number):
  void {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}

function plotsOf(words: JumpWords): Plot[] {
  const {height_m, captured_height_m, push_g, captured_push_g, strength_g} = words;
  const [low, high] = rangeWithMargin([...height_m, ...captured_height_m]);
  const [least, most] = rangeWithMargin([...push_g, ...captured_push_g, strength_g, 0]);
  return [
    {title: 'height of the centre of mass [m]', top: TOP_PX, captured: captured_height_m,
      made: height_m, low, high, strength: null},
    {title: 'push [g]', top: TOP_PX + PLOT_PX + GAP_PX, captured: captured_push_g, made: push_g,
      low: least, high: most, strength: strength_g},
  ];
}
