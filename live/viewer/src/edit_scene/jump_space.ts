// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The search space of a push: all lowest points (P2) with a push that is never negative, before
// which the body falls and after which it rises. P2 is dragged within it.

import {clampToSpace, islandsOf} from './jump_search';
import {rangeWithMargin} from './jump_curves';
import {tickStep} from './loop_search';
import type {JumpWords, LowestWords, PushRule, SpaceColumnWords} from '../protocol/edit_protocol';
import {el} from '../base/elements';
import type {Theme} from '../base/theme';
import {fixed} from '../base/words';

const LEFT_PX = 40;
const RIGHT_PX = 10;
const TOP_PX = 20;
const PLOT_PX = 190;
const BOTTOM_PX = 30;
const HEIGHT_PX = TOP_PX + PLOT_PX + BOTTOM_PX;
const REACH_PX = 22;
/** Steps of the arrow keys; with shift, a fifth of them. */
const KEY_AT = 0.01;
const KEY_HEIGHT_M = 0.005;

export const RULE_COLOURS: Record<PushRule, string> = {force: 'repaired', fall: 'measured',
  rise: 'inferred'};

export interface SpaceListener {
  moved(point: LowestWords): void;
  /** The drag or the key press is over. */
  ended(): void;
  /** It was given up with Escape. */
  cancelled(): void;
}

export class JumpSpace {
  private readonly canvas = el('canvas', {tabindex: 0, role: 'img', 'aria-label':
    'Allowed lowest points of the push. Arrow keys move the lowest point.'});
  readonly element = el('div', {class: 'jump-space'}, this.canvas);
  private space: readonly SpaceColumnWords[] = [];
  private islands: SpaceColumnWords[][] = [];
  private captured: LowestWords | null = null;
  private point: LowestWords | null = null;
  private x: [number, number] = [0, 1];
  private y: [number, number] = [0, 1];
  /** The held pointer, its distance from the point [px], and the point before. */
  private grip: {pointer: number | null; off: [number, number]; before: LowestWords;
    isMoved: boolean} | null = null;
  private width = 0;
  private isWaiting = false;

  constructor(private readonly theme: Theme, private readonly listener: SpaceListener) {
    new ResizeObserver(() => this.repaint()).observe(this.element);
    theme.onChange(() => this.repaint());
    const {canvas} = this;
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(kind, ({pointerId}) => {
        if (this.grip?.pointer === pointerId) this.end(kind === 'pointercancel');
      });
    }
    canvas.addEventListener('keydown', (event) => this.key(event));
    canvas.addEventListener('keyup', () => this.endKeys());
    canvas.addEventListener('blur', () => this.endKeys());
  }

  get isHeld(): boolean {
    return this.grip !== null;
  }

  load(words: JumpWords | null): void {
    this.space = words?.space ?? [];
    this.islands = islandsOf(this.space);
    const found = words?.jumps[words.number - 1];
    this.captured = found?.lowest_at ? {at: found.lowest_at, height_m: found.lowest_m} : null;
    if (!this.isHeld) this.point = words?.lowest ?? null;
    this.element.hidden = this.space.length === 0;
    if (!this.isHeld) this.fit();
    this.repaint();
  }

  private fit(): void {
    const points = [this.captured, this.point].filter((one) => one !== null);
    const [from, to] = rangeWithMargin([...this.space.map(([at]) => at),
      ...points.map(({at}) => at)], 0.12);
    this.x = [Math.max(from, 0), Math.min(to, 1)];
    this.y = rangeWithMargin([...this.space.flatMap(([, low, high]) => [low, high]),
      ...points.map(({height_m}) => height_m)], 0.12);
  }

  // --- Gestures ---

  private get plotWidth(): number {
    return Math.max(this.width - LEFT_PX - RIGHT_PX, 1);
  }

  private pixel({at, height_m}: LowestWords): [number, number] {
    const {x: [from, to], y: [low, high]} = this;
    return [LEFT_PX + (at - from) / (to - from) * this.plotWidth,
      TOP_PX + (high - height_m) / (high - low) * PLOT_PX];
  }

  private pointAt(x_px: number, y_px: number): LowestWords {
    const {x: [from, to], y: [low, high]} = this;
    return {at: from + (x_px - LEFT_PX) / this.plotWidth * (to - from),
      height_m: high - (y_px - TOP_PX) / PLOT_PX * (high - low)};
  }

  private isNear({offsetX, offsetY}: MouseEvent): boolean {
    if (!this.point) return false;
    const [x, y] = this.pixel(this.point);
    return Math.hypot(x - offsetX, y - offsetY) <= REACH_PX;
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || !this.point || this.grip || !this.isNear(event)) return;
    const [x, y] = this.pixel(this.point);
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({preventScroll: true});
    this.grip = {pointer: event.pointerId, off: [x - event.offsetX, y - event.offsetY],
      before: this.point, isMoved: false};
    event.preventDefault();
    this.repaint();
  }

  private move(event: PointerEvent): void {
    const {grip} = this;
    if (!grip || grip.pointer !== event.pointerId) {
      this.canvas.classList.toggle('over', this.isNear(event));
      return;
    }
    this.moveTo(this.pointAt(event.offsetX + grip.off[0], event.offsetY + grip.off[1]));
  }

  private moveTo(wanted: LowestWords): void {
    const made = clampToSpace(this.space, wanted);
    if (!made || !this.grip) return;
    if (made.at === this.point?.at && made.height_m === this.point.height_m) return;
    this.grip.isMoved = true;
    this.point = made;
    this.repaint();
    this.listener.moved(made);
  }

  private end(isCancelled: boolean): void {
    const {grip} = this;
    this.grip = null;
    if (!grip) return;
    if (isCancelled || !grip.isMoved) this.point = grip.before;
    this.repaint();
    if (isCancelled) this.listener.cancelled();
    else if (grip.isMoved) this.listener.ended();
  }

  private endKeys(): void {
    if (this.grip && this.grip.pointer === null) this.end(false);
  }

  private key(event: KeyboardEvent): void {
    if (event.key === 'Escape' && this.grip) {
      event.preventDefault();
      event.stopPropagation();
      this.end(true);
      return;
    }
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1],
      ArrowDown: [0, -1]}[event.key];
    if (!step || !this.point || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.grip ??= {pointer: null, off: [0, 0], before: this.point, isMoved: false};
    const share = event.shiftKey ? 0.2 : 1;
    this.moveTo({at: this.point.at + share * step[0] * KEY_AT,
      height_m: this.point.height_m + share * step[1] * KEY_HEIGHT_M});
  }

  // --- Painting ---

  /** Paints once, at the screen's next refresh. */
  private repaint(): void {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      const width = this.canvas.clientWidth;
      if (this.space.length === 0 || width === 0) return;
      this.width = width;
      this.paint();
    });
  }

  private paint(): void {
    const {canvas} = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    canvas.style.height = `${HEIGHT_PX}px`;
    canvas.width = Math.round(this.width * ratio);
    canvas.height = Math.round(HEIGHT_PX * ratio);
    const context = canvas.getContext('2d')!;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.font = `11px ${getComputedStyle(canvas).fontFamily}`;
    context.textBaseline = 'middle';
    this.paintAxes(context);
    for (const island of this.islands) this.paintIsland(context, island);
    if (this.captured) this.paintCaptured(context, this.captured);
    if (this.point) this.paintPoint(context, this.point);
  }

  private paintAxes(context: CanvasRenderingContext2D): void {
    const {theme, x: [from, to], y: [low, high]} = this;
    const ticks = (range: [number, number], count: number): [number[], number] => {
      const step = tickStep(range[1] - range[0], count);
      const out: number[] = [];
      for (let k = Math.ceil(range[0] / step); k * step <= range[1]; ++k) out.push(k * step);
      return [out, Math.max(0, -Math.floor(Math.log10(step) + 1e-9))];
    };
    context.lineWidth = 1;
    context.fillStyle = theme.colour('quiet');
    context.strokeStyle = theme.colour('rule');
    const [heights, decimals] = ticks([low, high], 5);
    context.textAlign = 'right';
    for (const height_m of heights) {
      const y = Math.round(this.pixel({at: from, height_m})[1]) + 0.5;
      stroke(context, [[LEFT_PX, y], [LEFT_PX + this.plotWidth, y]]);
      context.fillText(fixed(height_m, decimals), LEFT_PX - 5, y);
    }
    const [shares] = ticks([100 * from, 100 * to], this.plotWidth / 45);
    context.textAlign = 'center';
    for (const percent of shares) {
      const x = Math.round(this.pixel({at: percent / 100, height_m: low})[0]) + 0.5;
      stroke(context, [[x, TOP_PX], [x, TOP_PX + PLOT_PX]]);
      context.fillText(fixed(percent, 0), x, TOP_PX + PLOT_PX + 9);
    }
    context.textAlign = 'left';
    context.fillText('height of P2 [m]', 0, 8);
    context.textAlign = 'right';
    context.fillText('time of P2 [% of the push]', LEFT_PX + this.plotWidth,
      TOP_PX + PLOT_PX + 23);
  }

  /** A part of the space. Its edges have the colours of the rules that bind there. */
  private paintIsland(context: CanvasRenderingContext2D, island: SpaceColumnWords[]): void {
    const {theme} = this;
    const [bottom, top] = [1, 2].map((k) => island.map((column) =>
      this.pixel({at: column[0], height_m: column[k] as number})));
    const area = [...top, ...[...bottom].reverse()];
    context.save();
    path(context, area);
    context.fillStyle = theme.colour('color-mix(in srgb, var(--accent) 7%, transparent)');
    context.fill();
    context.clip();
    // The colours fade towards the middle.
    context.globalAlpha = 0.1;
    for (const width of [44, 32, 22, 13, 6]) this.paintEdges(context, island, width);
    context.restore();
    this.paintEdges(context, island, 2.5);
  }

  private paintEdges(context: CanvasRenderingContext2D, island: SpaceColumnWords[],
    width: number): void {
    context.lineWidth = width;
    context.lineJoin = 'round';
    context.lineCap = width < 5 ? 'round' : 'butt';
    for (const [height, rule] of [[1, 3], [2, 4]] as const) {
      const points = island.map((column) => this.pixel({at: column[0],
        height_m: column[height]}));
      // A run of columns with the same rule is one line, so that its parts do not overlap.
      for (let from = 0; from < island.length;) {
        let to = from + 1;
        while (to < island.length && island[to][rule] === island[from][rule]) ++to;
        context.strokeStyle = this.theme.colour(RULE_COLOURS[island[from][rule]]);
        const half = (i: number): number[][] => (i <= 0 || i >= island.length ? []
          : [[0, 1].map((k) => (points[i - 1][k] + points[i][k]) / 2)]);
        stroke(context, [...half(from), ...points.slice(from, to), ...half(to)]);
        from = to;
      }
    }
    for (const column of [island[0], island[island.length - 1]]) {
      context.strokeStyle = this.theme.colour(RULE_COLOURS[column[4]]);
      stroke(context, [column[1], column[2]].map((height_m) =>
        this.pixel({at: column[0], height_m})));
    }
  }

  private paintCaptured(context: CanvasRenderingContext2D, point: LowestWords): void {
    const [x, y] = this.pixel(point);
    context.strokeStyle = this.theme.colour('quiet');
    context.fillStyle = this.theme.colour('quiet');
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(x, y, 4.5, 0, 2 * Math.PI);
    context.stroke();
    // The name is on the side without P2, if there is room.
    const isAfter = point.at >= (this.point?.at ?? 0);
    const isLeft = isAfter ? x > LEFT_PX + this.plotWidth - 64 : x > LEFT_PX + 64;
    context.textAlign = isLeft ? 'right' : 'left';
    context.fillText('captured', isLeft ? x - 9 : x + 9, isLeft === isAfter ? y - 13 : y);
  }

  private paintPoint(context: CanvasRenderingContext2D, point: LowestWords): void {
    const [x, y] = this.pixel(point);
    for (const [radius, colour] of [[9, 'card'], [7, 'accent']] as const) {
      context.fillStyle = this.theme.colour(colour);
      context.beginPath();
      context.arc(x, y, this.isHeld ? radius + 1.5 : radius, 0, 2 * Math.PI);
      context.fill();
    }
    const isLeft = this.captured ? this.captured.at >= point.at
      : x > LEFT_PX + this.plotWidth / 2;
    context.textAlign = isLeft ? 'right' : 'left';
    const at = isLeft ? x - 13 : x + 13;
    context.lineJoin = 'round';
    context.lineWidth = 3;
    context.strokeStyle = this.theme.colour('card');
    context.strokeText('P2', at, y);
    context.fillStyle = this.theme.colour('ink');
    context.fillText('P2', at, y);
  }
}

type Pixels = readonly (readonly number[])[];

function path(context: CanvasRenderingContext2D, points: Pixels): void {
  context.beginPath();
  for (const [x, y] of points) context.lineTo(x, y);
}

function stroke(context: CanvasRenderingContext2D, points: Pixels): void {
  path(context, points);
  context.stroke();
}
