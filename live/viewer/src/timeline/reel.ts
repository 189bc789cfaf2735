// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Source of the shown instants: a recording's block, or the last minute of a live session.

import {MotionBlock, PointBlock} from '../protocol/decode_blocks';
import {decodeFrame, SceneFrame} from '../protocol/decode_frame';
import {FrameRing} from './frame_ring';
import {Playback} from './playback';
import {Instant} from './instant';
import type {SceneWords} from '../protocol/protocol';
import type {GraphData} from './graph';
import {FileContacts, FileRows, listedCurve, RingContacts, RingResidual, RingRows}
  from './timeline_rows';
import type {Rows} from './timeline_rows';

const KEPT_S = 60;
const MAX_FRAMES = 7200;

export class Reel {
  readonly playback = new Playback();
  rows: Rows = new RingRows([], new FrameRing(1, 0));
  /** Contacts over time; null for a session without a performer. */
  contacts: Rows | null = null;
  graphs: readonly GraphData[] = [];
  points: PointBlock | null = null;
  private instant = new Instant([]);
  private scratch = new SceneFrame([]);
  private block: MotionBlock | null = null;
  private ring = new FrameRing(1, 0);
  private live = true;
  private layout = '';
  /** Skeleton whose sources the timeline shows. */
  private witness = -1;
  /** Frame `at` of a recording, adapted to a dragged constraint, until another frame is
   *  shown; later answers are ignored. */
  private adapted: {at: number; seeks: number; frame: SceneFrame | null} | null = null;

  /** The shown instant, after compose(). */
  get shown(): SceneFrame {
    return this.instant.shown;
  }

  /** Keeps the stored frames if the session continues. */
  setScene(scene: SceneWords): void {
    this.live = scene.mode === 'live';
    this.playback.rate_hz = scene.rate_hz > 0 ? scene.rate_hz : 30;
    this.adapted = null;
    const layout = JSON.stringify([scene.mode, scene.rate_hz, scene.skeletons.map(
      ({joints}) => joints.map(({name}) => name))]);
    if (this.live && layout === this.layout) return;
    this.layout = layout;
    this.instant = new Instant(scene.skeletons);
    this.scratch = new SceneFrame(scene.skeletons);
    this.block = null;
    this.points = null;
    this.witness = Math.max(scene.skeletons.findIndex(({estimate}) => estimate), -1);
    this.beginTimeline(scene);
  }

  private beginTimeline(scene: SceneWords): void {
    const {playback} = this;
    if (scene.file) {
      this.rows = new FileRows(scene.file);
      this.contacts = new FileContacts(scene.file);
      this.graphs = scene.file.graphs.map(({name, unit, values}) =>
        ({name, unit, curves: [listedCurve(values)]}));
      playback.following = false;
      playback.playing = false;
      playback.setRange(0, scene.file.frames - 1);
      return;
    }
    const witness = scene.skeletons[this.witness];
    const names = witness ? witness.joints.map(({name, bone}) => bone || name) : [];
    const capacity = Math.min(Math.ceil(KEPT_S * playback.rate_hz), MAX_FRAMES);
    this.ring = new FrameRing(capacity, names.length);
    this.rows = new RingRows(names, this.ring);
    this.contacts = witness ? new RingContacts(this.ring) : null;
    this.graphs = witness ? [{name: 'reprojection', unit: 'px',
      curves: [new RingResidual(this.ring)]}] : [];
    playback.setRange(0, 0);
    playback.follow();
  }

  /** Fetches the blocks of the scene. Throws an Error with the cause. */
  async load(scene: SceneWords, signal: AbortSignal): Promise<void> {
    const {file} = scene;
    if (!file) return;
    if (file.block) {
      const block = new MotionBlock(await fetched(file.block, signal),
        new SceneFrame(scene.skeletons));
      if (signal.aborted) return;
      this.block = block;
    }
    if (file.points_block) {
      const points = new PointBlock(await fetched(file.points_block, signal));
      if (signal.aborted) return;
      this.points = points;
      // Without skeletons, start at the first visible marker, often after the first frame.
      if (scene.skeletons.length === 0) this.playback.seek(points.firstSeen());
    }
  }

  /** Stores a received frame. Returns false if it belongs to another scene. */
  push(view: DataView): boolean {
    if (!this.live) return this.adapt(view);
    // Decoded now for the timeline, and again when shown, which may never happen.
    if (decodeFrame(view, 0, this.scratch) < 0) return false;
    const witness = this.scratch.skeletons[this.witness];
    if (witness && !witness.hasUncertainty) witness.source.fill(0);
    const tracked = witness?.hasTracking ? witness : null;
    this.ring.push(view, witness?.hasPose ? witness.source : null, tracked?.bears,
      tracked?.residual_px);
    this.playback.setRange(this.ring.first, this.ring.last);
    return true;
  }

  /** Begins a drag of a constraint: the server answers with this frame, adapted. */
  expectAdapted(): void {
    const {frame: at, seeks} = this.playback;
    if (!this.live) this.adapted = {at, seeks, frame: this.adapted?.frame ?? null};
  }

  private adapt(view: DataView): boolean {
    if (this.adapted?.seeks !== this.playback.seeks) return false;
    const frame = new SceneFrame(this.shown.skeletons.map(({joints}) =>
      ({joints: new Array(joints)})));
    if (decodeFrame(view, 0, frame) < 0) return false;
    this.adapted.frame = frame;
    return true;
  }

  /** Sets `shown` to the instant of the playback. Returns false if there is nothing to show. */
  compose(): boolean {
    const {time, frame} = this.playback;
    if (this.adapted?.at !== time || this.adapted.seeks !== this.playback.seeks) {
      this.adapted = null;
    }
    if (this.adapted?.frame) {
      this.take(this.adapted.frame);
      return true;
    }
    return this.instant.compose(time, frame, (i, into) => this.read(i, into));
  }

  private take(frame: SceneFrame): void {
    this.shown.frame = frame.frame;
    this.shown.time_s = frame.time_s;
    this.shown.sent_s = frame.sent_s;
    this.shown.skeletons.forEach((into, i) => into.copy(frame.skeletons[i]));
  }

  private read(i: number, into: SceneFrame): boolean {
    if (!this.live) {
      if (!this.block || i < 0 || i >= this.block.frames) return false;
      this.block.read(i, into);
      return true;
    }
    const view = this.ring.at(i);
    return view !== null && decodeFrame(view, 0, into) >= 0;
  }
}

/** Fetches a block. Throws an Error with the cause. */
export async function fetched(media: string, signal: AbortSignal): Promise<ArrayBuffer> {
  const answer = await fetch(media, {signal, credentials: 'same-origin'});
  if (!answer.ok) throw new Error(`${media}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}
