// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The instant that the viewer and all timelines of a report show.

import type {Theme} from '../base/theme';
import type {GraphData} from '../timeline/graph';
import {Playback} from '../timeline/playback';
import {TimeWindow} from '../timeline/time_window';
import {Timeline} from '../timeline/timeline';
import type {Strip} from '../timeline/timeline_paint';
import type {Rows} from '../timeline/timeline_rows';

const LONGEST_STEP_S = 0.1; // A page that was suspended does not jump.
const TALL_GRAPH_PX = 176;

export class Player {
  readonly playback = new Playback();
  /** Called when the time or the playing state has changed. */
  onTime: () => void = () => {};
  private timelines: Timeline[] = [];
  private window = new TimeWindow();
  private firstFrame = 0;
  private asked = 0;
  private last_ms = 0;

  constructor(readonly theme: Theme) {
    this.playback.loop = true;
  }

  /** Starts another trial, without timelines. */
  load(frames: number, rate_hz: number, firstFrame: number): void {
    this.timelines = [];
    this.window = new TimeWindow();
    this.firstFrame = firstFrame;
    this.playback.rate_hz = rate_hz;
    this.playback.setRange(0, frames - 1);
    this.seek(0);
  }

  /** Returns a timeline of this trial; all have the same frame at the same x. */
  timeline(strips: readonly Strip[], graphs: readonly GraphData[] = [],
    summary: Rows | null = null, folds = false): Timeline {
    const {theme, window, firstFrame: first_frame, playback: {rate_hz}} = this;
    const made = new Timeline(theme, (frame) => this.show(frame),
      {window, scrolled: true, ...(folds ? {} : {graph_px: TALL_GRAPH_PX})});
    made.load({strips, graphs, summary, rate_hz, first_frame, notes: [], live: false});
    this.timelines.push(made);
    this.place(made);
    return made;
  }

  /** Stops, and shows this frame. */
  show(frame: number): void {
    this.playback.pause();
    this.seek(frame);
  }

  seek(frame: number): void {
    this.playback.seek(frame);
    this.changed();
  }

  play(on: boolean): void {
    if (on) this.playback.play();
    else this.playback.pause();
    this.changed();
  }

  /** Called after a change of `playback`. */
  changed(): void {
    for (const timeline of this.timelines) this.place(timeline);
    this.onTime();
    if (!this.playback.playing) this.last_ms = 0;
    else if (this.asked === 0) this.asked = requestAnimationFrame((now_ms) => this.advance(now_ms));
  }

  private place(timeline: Timeline): void {
    const {first, last, time, frame} = this.playback;
    timeline.place(first, last, time, frame);
  }

  private advance(now_ms: number): void {
    this.asked = 0;
    if (!this.playback.playing) return;
    const seconds = this.last_ms === 0 ? 0 : (now_ms - this.last_ms) / 1000;
    this.last_ms = now_ms;
    this.playback.advance(Math.min(seconds, LONGEST_STEP_S), false);
    this.changed();
  }
}
