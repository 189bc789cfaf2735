// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The picture of the edit page's tools on the timeline.

import type {TimelineLayout} from '../timeline/timeline_extension';
import {AXIS_PX} from '../timeline/timeline_paint';
import type {EditView} from '../edit/edit_view';
import {spansOfOp} from './op_handles';
import {shownBy} from './op_times';
import type {Handle} from './timeline_handles';
import {axisHandles, trimmedFrames} from './timeline_handles';
import type {Brush} from './timeline_tools';

/** Height of the bar of the selected operation's span, in the axis. */
export const SPAN_PX = 8;
const TRIM_PX = 7;
const HATCH_PX = 7;

export interface Painted {
  selected: number | null;
  dragged: {handle: Handle; now: number} | null;
  /** The handle under the pointer. */
  near: Handle | null;
  brush: Brush | null;
}

export class ToolsPainter {
  constructor(private readonly context: CanvasRenderingContext2D,
    private readonly layout: TimelineLayout, private readonly view: EditView) {}

  paint({selected, dragged, near, brush}: Painted): void {
    const {context, layout: {left_px, width_px, height_px}} = this;
    context.save();
    context.beginPath();
    context.rect(left_px - TRIM_PX - 1, 0, width_px + 2 * TRIM_PX + 2, height_px);
    context.clip();
    this.cutOff(dragged);
    if (selected !== null) this.selectedSpans(selected, dragged);
    for (const handle of axisHandles(this.view, selected)) {
      const isDragged = dragged?.handle.name === handle.name && dragged.handle.where === 'axis';
      const at = isDragged ? dragged.now : handle.frame;
      const isBright = isDragged || near?.name === handle.name;
      if (handle.role === 'trim') this.trimHandle(handle, at, isBright);
      else if (handle.role === 'op' && handle.side === 'point') this.point(at, isBright);
    }
    if (brush) this.brushed(brush);
    if (dragged) this.line(dragged.now);
    if (dragged) this.edge(dragged.handle, dragged.now, true);
    else if (near) this.edge(near, near.frame, false);
    context.restore();
  }

  private fill(from_px: number, to_px: number, top: number, height: number, colour: string,
    alpha = 1): void {
    const {context, layout} = this;
    const left = Math.max(from_px, layout.left_px);
    const right = Math.min(to_px, layout.left_px + layout.width_px);
    if (right <= left) return;
    context.globalAlpha = alpha;
    context.fillStyle = layout.colour(colour);
    context.fillRect(left, top, right - left, height);
    context.globalAlpha = 1;
  }

  /** Hatches what a cut removes. */
  private cutOff(dragged: Painted['dragged']): void {
    const shown = shownBy(this.view);
    if (!shown) return;
    const [from, to] = trimmedFrames(shown);
    const side = dragged?.handle.role === 'trim' ? dragged.handle.side : null;
    const {left_px, width_px, x} = this.layout;
    this.hatch(left_px, x(side === 'start' ? dragged!.now : from ?? 0));
    this.hatch(x(side === 'end' ? dragged!.now : to ?? shown.output.frames - 1),
      left_px + width_px);
  }

  private hatch(from_px: number, to_px: number): void {
    const {context, layout: {left_px, width_px, height_px, colour}} = this;
    const left = Math.max(from_px, left_px);
    const right = Math.min(to_px, left_px + width_px);
    if (right - left < 1) return;
    this.fill(left, right, 0, height_px, 'card', 0.6);
    context.save();
    context.beginPath();
    context.rect(left, 0, right - left, height_px);
    context.clip();
    context.strokeStyle = colour('quiet');
    context.globalAlpha = 0.55;
    context.lineWidth = 1;
    context.beginPath();
    // Lines keep their places while the edge moves.
    const first = Math.floor((left - height_px) / HATCH_PX) * HATCH_PX;
    for (let at = first; at < right; at += HATCH_PX) {
      context.moveTo(at, height_px);
      context.lineTo(at + height_px, 0);
    }
    context.stroke();
    context.restore();
  }

  private selectedSpans(selected: number, dragged: Painted['dragged']): void {
    const shown = shownBy(this.view);
    if (!shown) return;
    const {x, height_px} = this.layout;
    for (const {name, frames: [first, last]} of spansOfOp(shown, selected)) {
      let [from, to] = [first, last];
      const {handle, now} = dragged ?? {handle: null, now: 0};
      if (handle?.role === 'op' && handle.name === `start of ${name}`) from = now;
      else if (handle?.role === 'op' && handle.name === `end of ${name}`) to = now;
      else if (handle?.side === 'span' && handle.name === name) {
        [from, to] = [now, now + last - first];
      }
      this.fill(x(from), x(to), 0, height_px, 'accent', 0.1);
      this.fill(x(from), x(to), 0, SPAN_PX, 'accent', 0.55);
      for (const at of [from, to]) this.fill(x(at) - 2, x(at) + 2, 0, AXIS_PX - 5, 'accent');
    }
  }

  private isVisible(x_px: number): boolean {
    const {left_px, width_px} = this.layout;
    return x_px >= left_px - 1 && x_px <= left_px + width_px + 1;
  }

  /** A grip outside of the kept part, with a line in its middle. */
  private trimHandle({side}: Handle, frame: number, isBright: boolean): void {
    const {context, layout: {x, colour}} = this;
    const at = x(frame);
    if (!this.isVisible(at)) return;
    const left = side === 'start' ? at - TRIM_PX : at;
    context.fillStyle = colour(isBright ? 'accent' : 'quiet');
    context.beginPath();
    context.roundRect(left, 1, TRIM_PX, AXIS_PX - 2,
      side === 'start' ? [4, 0, 0, 4] : [0, 4, 4, 0]);
    context.fill();
    context.fillStyle = colour('card');
    context.fillRect(left + TRIM_PX / 2 - 0.5, 6, 1, AXIS_PX - 12);
  }

  private point(frame: number, isBright: boolean): void {
    const {context, layout: {x, colour}} = this;
    const at = x(frame);
    if (!this.isVisible(at)) return;
    const half = isBright ? 7 : 6;
    const middle = SPAN_PX;
    context.fillStyle = colour('accent');
    context.strokeStyle = colour('card');
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(at - half, middle);
    context.lineTo(at, middle - half);
    context.lineTo(at + half, middle);
    context.lineTo(at, middle + half);
    context.closePath();
    context.fill();
    context.stroke();
  }

  private line(frame: number): void {
    const at = this.layout.x(frame);
    this.fill(at - 0.5, at + 0.5, 0, this.layout.height_px, 'accent');
  }

  private brushed({from, to, row}: Brush): void {
    const {x, height_px, bands} = this.layout;
    const [left, right] = [x(from), x(to)];
    this.fill(left, right, 0, height_px, 'accent', 0.18);
    for (const at of [left, right]) this.fill(at - 1, at + 1, 0, height_px, 'accent');
    const band = row === null ? undefined
      : bands.find((one) => one.strip?.kind === 'contacts' && one.row === row);
    if (band) this.fill(x(from - 0.5), x(to + 0.5), band.top, band.height - 2, 'accent', 0.5);
  }

  /** A handle in its row: a bar, and while it is dragged the change. */
  private edge(handle: Handle, now: number, isDragged: boolean): void {
    const {context, layout: {x, bands, colour}} = this;
    const band = bands.find((one) => one.strip?.kind === handle.where && one.row === handle.row);
    if (handle.where === 'axis' || !band) return;
    const at = x(now + handle.shift);
    const was = x(handle.frame + handle.shift);
    if (isDragged && handle.side !== 'point') {
      this.fill(Math.min(at, was), Math.max(at, was), band.top, band.height - 2, 'accent', 0.45);
    }
    if (!this.isVisible(at)) return;
    context.fillStyle = colour('accent');
    context.strokeStyle = colour('card');
    context.lineWidth = 1.5;
    context.beginPath();
    context.roundRect(at - 2.5, band.top - 2, 5, band.height + 2, 2.5);
    context.stroke();
    context.fill();
  }
}
