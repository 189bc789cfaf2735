// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Extension of a timeline by a page: handles that are dragged, and a picture on top.

import type {Band, Strip} from './timeline_paint';

/** A place on the timeline under a pointer. */
export interface TimelinePlace {
  /** May have a fraction, and be outside of the motion. */
  frame: number;
  /** The row at the pointer. null: the axis, the summary, a graph. */
  strip: Strip | null;
  row: number;
  area: 'axis' | 'summary' | 'row' | 'graph' | 'none';
  /** From the left and the upper edge of the timeline. */
  x_px: number;
  y_px: number;
  /** A handle this near is meant: less for a mouse than for a finger. */
  reach_px: number;
  layout: TimelineLayout;
  event: PointerEvent;
}

export interface TimelineLayout {
  /** Left edge and width of the plot. */
  left_px: number;
  width_px: number;
  /** Height of all: the axis, the rows and the graphs. */
  height_px: number;
  bands: readonly Band[];
  /** Distance of a frame from the timeline's left edge. [px] */
  x(frame: number): number;
  /** Returns a CSS colour by its name in styles/colours.css. */
  colour(name: string): string;
}

/** A drag. The timeline calls drop() or cancel() exactly once, and then paint(). */
export interface Grip {
  move(frame: number, event: PointerEvent): void;
  /** The pointer was released after it moved. */
  drop(): void;
  /** Escape, a second finger, or a press without a movement. */
  cancel(): void;
  /** Text of the tip at the pointer. */
  words(): string;
}

export interface TimelineHost {
  readonly element: HTMLElement;
  /** Calls paint() at the screen's next refresh. */
  repaint(): void;
  /** Shows a frame, as a press on the timeline does. */
  seek(frame: number): void;
  /** Distance of a frame from the left edge of the window. [px] */
  clientX(frame: number): number;
}

export interface TimelineExtension {
  /** Called once, by the timeline. */
  attach?(host: TimelineHost): void;
  /** Asked when the pointer is pressed. null: the timeline seeks, as without an extension. A
   *  press that does not move seeks, too. */
  grab(place: TimelinePlace): Grip | null;
  /** Returns the cursor and the text for a pointer that is not pressed. null as argument: it has
   *  left; as result: no handle is near. */
  hover(place: TimelinePlace | null): {cursor: string; words: string | null} | null;
  /** Paints over the axis, the rows and the graphs, on an empty canvas. [CSS px] */
  paint(context: CanvasRenderingContext2D, layout: TimelineLayout): void;
}
