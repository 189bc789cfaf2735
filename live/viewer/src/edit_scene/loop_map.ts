// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The map of loops: the distance of each pair of frames as a colour. Rows are starts of a
// cycle, columns are its ends.

import {cellOfCycle, distanceAt, scaleEnd_mm, tickStep} from './loop_search';
import type {Cell} from './loop_search';
import type {LoopCandidateWords, LoopMapWords} from '../protocol/edit_protocol';
import {el} from '../base/elements';
import {scaleColour} from '../base/theme';
import type {Theme} from '../base/theme';
import {fixed} from '../base/words';

const LEFT_PX = 30;
const TOP_PX = 30;
const EDGE_PX = 8;
const COLOURS = 256;

export interface LoopMapListener {
  /** null: the pointer has left the map. */
  hovered(cell: Cell | null): void;
  /** `exact`: this cell; otherwise the nearest minimum is meant. */
  chosen(cell: Cell, exact: boolean): void;
}

export class LoopMap {
  private readonly canvas = el('canvas', {tabindex: 0, role: 'img', 'aria-label':
    'Distances of pairs of frames. Arrow keys move the chosen pair.'});
  private readonly column = el('div', {class: 'now'});
  private readonly row = el('div', {class: 'now'});
  readonly element = el('div', {class: 'loop-map', hidden: true}, this.canvas, this.column,
    this.row);
  private map: LoopMapWords | null = null;
  private candidates: readonly LoopCandidateWords[] = [];
  private picture: HTMLCanvasElement | null = null;
  private rate_hz = 30;
  /** Side of the map. [px] */
  private size = 1;
  private end_mm = 1;
  private selected: Cell | null = null;
  private hovered: Cell | null = null;
  private isWaiting = false;

  constructor(private readonly theme: Theme, private readonly listener: LoopMapListener) {
    new ResizeObserver(() => this.repaint()).observe(this.element);
    theme.onChange(() => this.repaint());
    const {canvas} = this;
    canvas.addEventListener('pointermove', (event) => this.hover(this.cellAt(event)));
    canvas.addEventListener('pointerleave', () => this.hover(null));
    canvas.addEventListener('click', (event) => {
      const cell = this.cellAt(event);
      if (cell) listener.chosen(cell, event.shiftKey);
    });
    canvas.addEventListener('keydown', (event) => this.key(event));
  }

  /** null: no map. */
  load(map: LoopMapWords | null, candidates: readonly LoopCandidateWords[], rate_hz: number):
    void {
    this.map = map && map.cells > 0 ? map : null;
    this.candidates = candidates;
    this.rate_hz = rate_hz;
    this.selected = null;
    this.hovered = null;
    this.element.hidden = this.map === null;
    this.end_mm = this.map ? scaleEnd_mm(this.map) : 1;
    this.picture = this.map ? pictureOf(this.map, this.end_mm) : null;
    this.repaint();
  }

  select(cell: Cell | null): void {
    this.selected = cell;
    this.repaint();
  }

  /** Marks this frame in both axes; null: it belongs to another motion. */
  setTime(time: number | null): void {
    const {map, column, row} = this;
    const isShown = map !== null && time !== null;
    if (column.hidden === isShown) {
      column.hidden = !isShown;
      row.hidden = !isShown;
    }
    if (!isShown) return;
    // Transforms cost no layout.
    const {size} = this;
    const at = Math.min((time + 0.5) / (map.cells * map.cell_frames), 1) * size;
    const x = (LEFT_PX + at).toFixed(1);
    column.style.transform = `translate(${x}px, ${TOP_PX}px) scaleY(${at.toFixed(1)})`;
    row.style.transform =
      `translate(${x}px, ${(TOP_PX + at).toFixed(1)}px) scaleX(${(size - at).toFixed(1)})`;
  }

  private cellAt({offsetX, offsetY}: MouseEvent): Cell | null {
    const {map, size} = this;
    if (!map) return null;
    const cell = (px: number): number => Math.floor(px / size * map.cells);
    const at = {row: cell(offsetY - TOP_PX), column: cell(offsetX - LEFT_PX)};
    return at.row >= 0 && at.column < map.cells && at.column > at.row ? at : null;
  }

  private hover(cell: Cell | null): void {
    if (cell?.row === this.hovered?.row && cell?.column === this.hovered?.column) return;
    this.hovered = cell;
    this.canvas.classList.toggle('over', cell !== null);
    this.listener.hovered(cell);
    this.repaint();
  }

  private key(event: KeyboardEvent): void {
    const step = {ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1],
      ArrowRight: [0, 1]}[event.key];
    const {map, selected} = this;
    if (!step || !map || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    const from = selected ?? (this.candidates[0] ? cellOfCycle(map, this.candidates[0])
      : {row: 0, column: Math.floor(map.cells / 2)});
    const to = {row: from.row + step[0], column: from.column + step[1]};
    if (to.row >= 0 && to.column > to.row && to.column < map.cells) {
      this.listener.chosen(to, true);
    }
  }

  // --- Painting ---

  /** Paints once, at the screen's next refresh. */
  private repaint(): void {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      const width = this.canvas.clientWidth;
      if (!this.map || width === 0) return;
      this.size = Math.max(width - LEFT_PX - EDGE_PX, 1);
      this.paint(this.map);
    });
  }

  private paint(map: LoopMapWords): void {
    const {canvas, size} = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    canvas.style.height = `${TOP_PX + size + EDGE_PX}px`;
    canvas.width = Math.round(canvas.clientWidth * ratio);
    canvas.height = Math.round((TOP_PX + size + EDGE_PX) * ratio);
    const context = canvas.getContext('2d')!;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.font = `11px ${getComputedStyle(canvas).fontFamily}`;
    this.paintAxes(context, map);
    context.imageSmoothingEnabled = false;
    context.drawImage(this.picture!, LEFT_PX, TOP_PX, size, size);
    this.paintLegend(context);
    for (const candidate of this.candidates) {
      this.ring(context, cellOfCycle(map, candidate), 3.5, 1.2, scaleColour(0), '#fff');
    }
    if (this.hovered) this.ring(context, this.hovered, 3.5, 1, scaleColour(0), '#fff');
    if (this.selected) this.cross(context, this.selected);
  }

  private paintAxes(context: CanvasRenderingContext2D, map: LoopMapWords): void {
    const {size, theme} = this;
    const length_s = map.cells * map.cell_frames / this.rate_hz;
    const step_s = tickStep(length_s, size / 42);
    context.fillStyle = theme.colour('quiet');
    context.strokeStyle = theme.colour('rule');
    context.lineWidth = 1;
    context.textBaseline = 'middle';
    const decimals = Math.max(0, -Math.floor(Math.log10(step_s) + 1e-9));
    for (let k = 0; k * step_s <= length_s; ++k) {
      const at = k * step_s / length_s * size;
      const text = fixed(k * step_s, decimals);
      context.textAlign = 'center';
      context.fillText(text, LEFT_PX + at, TOP_PX - 8);
      context.textAlign = 'right';
      if (k > 0) context.fillText(text, LEFT_PX - 5, TOP_PX + at);
      context.beginPath();
      context.moveTo(LEFT_PX + at, TOP_PX);
      context.lineTo(LEFT_PX + at, TOP_PX + at);
      context.moveTo(LEFT_PX, TOP_PX + at);
      context.lineTo(LEFT_PX + at, TOP_PX + at);
      context.stroke();
    }
    context.textAlign = 'right';
    context.fillText('end [s]', LEFT_PX + size, TOP_PX - 22);
    context.textAlign = 'left';
    context.fillText('start [s]', 0, TOP_PX - 22);
  }

  /** In the empty half, below the diagonal. */
  private paintLegend(context: CanvasRenderingContext2D): void {
    const {size, theme, end_mm} = this;
    const [x, y, width, height] = [LEFT_PX + 0.06 * size, TOP_PX + 0.86 * size, 0.42 * size, 8];
    const bar = context.createLinearGradient(x, 0, x + width, 0);
    for (let k = 0; k <= 8; ++k) bar.addColorStop(k / 8, scaleColour(1 - k / 8));
    context.fillStyle = theme.colour('card');
    context.fillRect(x - 8, y - 24, width + 34, height + 44);
    context.fillStyle = bar;
    context.fillRect(x, y, width, height);
    context.fillStyle = theme.colour('quiet');
    context.textAlign = 'left';
    context.fillText('distance [mm]', x, y - 10);
    context.textAlign = 'center';
    for (const share of [0, 0.5, 1]) {
      const decimals = end_mm < 10 ? 1 : 0;
      context.fillText((share === 1 ? '≥ ' : '') + fixed(share * end_mm, share ? decimals : 0),
        x + share * width, y + height + 9);
    }
  }

  private middle({row, column}: Cell): [number, number] {
    const {cells} = this.map!;
    return [LEFT_PX + (column + 0.5) / cells * this.size, TOP_PX + (row + 0.5) / cells * this.size];
  }

  private ring(context: CanvasRenderingContext2D, cell: Cell, radius: number, width: number,
    outer: string, inner: string): void {
    const [x, y] = this.middle(cell);
    for (const [colour, thick] of [[outer, width + 2], [inner, width]] as const) {
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.strokeStyle = colour;
      context.lineWidth = thick;
      context.stroke();
    }
  }

  /** The chosen cell, with lines to both axes. */
  private cross(context: CanvasRenderingContext2D, cell: Cell): void {
    const [x, y] = this.middle(cell);
    for (const [colour, width, dash] of [[this.theme.colour('card'), 3, []],
      [this.theme.colour('ink'), 1.5, [4, 3]]] as const) {
      context.strokeStyle = colour;
      context.lineWidth = width;
      context.setLineDash([...dash]);
      context.beginPath();
      context.moveTo(x, TOP_PX);
      context.lineTo(x, y);
      context.lineTo(LEFT_PX, y);
      context.stroke();
    }
    context.setLineDash([]);
    this.ring(context, cell, 5.5, 2, scaleColour(0), '#fff');
  }

  /** Words of a cell: start, end, period, distance. */
  words({row, column}: Cell): string {
    const {map, rate_hz} = this;
    if (!map) return '';
    const second = (cell: number): number => cell * map.cell_frames / rate_hz;
    return `start ${fixed(second(row), 2)} s, end ${fixed(second(column), 2)} s, period ` +
      `${fixed(second(column - row), 2)} s, ${fixed(distanceAt(map, row, column), 0)} mm`;
  }
}

/** Returns a picture of one pixel per cell; transparent below the diagonal. */
function pictureOf(map: LoopMapWords, end_mm: number): HTMLCanvasElement {
  const {cells, distance_mm} = map;
  const made = el('canvas', {width: cells, height: cells});
  const context = made.getContext('2d')!;
  const image = context.createImageData(cells, cells);
  const palette = Array.from({length: COLOURS}, (_, i) =>
    (scaleColour(1 - i / (COLOURS - 1)).match(/\d+/g) ?? []).map(Number));
  for (let row = 0; row < cells; ++row) {
    for (let column = row; column < cells; ++column) {
      const i = row * cells + column;
      const share = Math.min(distance_mm[i] / end_mm, 1);
      image.data.set([...palette[Math.round((COLOURS - 1) * share)], 255], 4 * i);
    }
  }
  context.putImageData(image, 0, 0);
  return made;
}
