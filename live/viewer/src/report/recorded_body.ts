// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A body in motion as a report stores it: positions and rotations per frame.

import {SkeletonFrame} from '../protocol/decode_frame';
import type {SkeletonWords, Vector} from '../protocol/protocol';
import type {Pose} from '../scene/posed_skeleton';
import {blend, turn} from '../scene/quaternions';
import type {BodyData} from './data';

const APART_M = 0.25; // Between bodies side by side.
const HEAD = 0.09; // Height of a head without its own top, as a share of the body's.

export function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
}

export class RecordedBody implements Pose {
  readonly joints: number;
  readonly parents: Int16Array;
  readonly p_in_world: Float32Array;
  /** Rotations from rest. */
  readonly world_from_joint: Float32Array;
  readonly frame: SkeletonFrame;
  readonly words: SkeletonWords;
  private readonly xyz: Int16Array;
  private readonly turns: Float32Array;
  private readonly source: Uint8Array | null;
  private readonly sigma: Uint16Array | null;

  constructor(readonly data: BodyData, isSubject: boolean) {
    const {points, name} = data;
    this.joints = points.length;
    this.parents = Int16Array.from(points, ({parent}) => parent);
    this.p_in_world = new Float32Array(3 * this.joints);
    this.world_from_joint = new Float32Array(4 * data.joints);
    this.frame = new SkeletonFrame(this.joints);
    this.xyz = new Int16Array(bytesOf(data.xyz).buffer);
    this.turns = Float32Array.from(new Int16Array(bytesOf(data.turns).buffer));
    this.source = data.source ? bytesOf(data.source) : null;
    this.sigma = data.sigma ? new Uint16Array(bytesOf(data.sigma).buffer) : null;
    this.frame.hasUncertainty = this.source !== null && this.sigma !== null;
    this.words = {name, kind: isSubject ? 'performer' : 'avatar', skin: null,
      joints: points.map((point) => ({...point, bone: point.bone ?? '',
        rest: {p: [0, 0, 0], q: [0, 0, 0, 1]}})), offset_m: [0, 0, 0], estimate: isSubject};
    this.show(0);
  }

  get frames(): number {
    return this.data.frames;
  }

  /** Returns the world position of a point of one frame. */
  recorded(frame: number, point: number): Vector {
    const {unit_m, origin_m} = this.data;
    const at = 3 * (frame * this.joints + point);
    return origin_m.map((o, k) => o + unit_m * this.xyz[at + k]) as Vector;
  }

  /** Sets the pose at `time` [frames], which may lie between two frames. */
  show(time: number): void {
    const {frame, joints, data: {joints: turned, unit_m, origin_m}} = this;
    frame.hasPose = this.frames > 0;
    if (!frame.hasPose) return;
    const last = this.frames - 1;
    const first = Math.min(Math.max(Math.floor(time), 0), last);
    const second = Math.min(first + 1, last);
    const share = Math.min(Math.max(time - first, 0), 1);
    for (let i = 0; i < 3 * joints; ++i) {
      const [a, b] = [first, second].map((f) => this.xyz[f * 3 * joints + i]);
      this.p_in_world[i] = origin_m[i % 3] + unit_m * (a + share * (b - a));
    }
    const [a, b] = [first, second].map((f) =>
      this.turns.subarray(4 * turned * f, 4 * turned * (f + 1)));
    for (let j = 0; j < turned; ++j) blend(this.world_from_joint, a, b, 4 * j, share);
    const nearest = share < 0.5 ? first : second;
    for (let i = 0; frame.hasUncertainty && i < joints; ++i) {
      // A tip has the source of its joint.
      const at = nearest * turned + (i < turned ? i : this.parents[i]);
      frame.source[i] = Math.min(this.source![at], 2);
      frame.sigma_m[i] = i < turned ? this.sigma![at] * 1e-4 : 0;
    }
  }

  /** The pose is that of show(). */
  setFrame(): void {}

  heading(): number {
    const ahead = [0, 0, 1];
    turn(ahead, 0, this.world_from_joint, 0, ahead, 0);
    return Math.atan2(ahead[0], ahead[2]);
  }

  /** Visits about `count` frames. */
  sample(count: number, visit: (frame: number) => void): void {
    const step = Math.max(1, Math.floor(this.frames / count));
    for (let frame = 0; frame < this.frames; frame += step) visit(frame);
  }

  /** Returns the mean heading. */
  meanHeading(): number {
    let [x, z] = [0, 0];
    this.sample(30, (frame) => {
      this.show(frame);
      x += Math.sin(this.heading());
      z += Math.cos(this.heading());
    });
    return Math.atan2(x, z);
  }

  /** Returns places of sampled frames, x y z each, with the offset. With `relative`, those of
   *  the floor are relative to the body's own path. */
  places(relative: boolean): number[] {
    const places: number[] = [];
    const {offset_m: [dx, dy, dz]} = this.words;
    this.sample(60, (frame) => {
      const [rx, , rz] = relative ? this.recorded(frame, 0) : [0, 0, 0];
      let high = -Infinity;
      let low = Infinity;
      for (let i = 0; i < this.joints; ++i) {
        const [x, y, z] = this.recorded(frame, i);
        places.push(x - rx + dx, y + dy, z - rz + dz);
        high = Math.max(high, y);
        low = Math.min(low, y);
      }
      const [x, , z] = this.recorded(frame, 0);
      places.push(x - rx + dx, high + HEAD * (high - low) + dy, z - rz + dz);
    });
    return places;
  }
}

/** Returns the horizontal unit vector perpendicular to the body's direction of travel; for a
 *  body that stays in place, the side direction of its root in the first frame. */
function sideOf(body: RecordedBody): [number, number] {
  const [x0, , z0] = body.recorded(0, 0);
  const [x1, , z1] = body.recorded(body.frames - 1, 0);
  const length = Math.hypot(x1 - x0, z1 - z0);
  if (length > 0.5) return [(z1 - z0) / length, -(x1 - x0) / length];
  body.show(0);
  return [Math.cos(body.heading()), -Math.sin(body.heading())];
}

/** Places the avatars next to the subject, alternately on its left and right, so that they
 *  start side by side and never intersect. */
export function standAbreast([subject, ...avatars]: readonly RecordedBody[]): void {
  if (!subject || subject.frames === 0) return;
  const [sx, sz] = sideOf(subject);
  /** The extent of a body to both sides of its first position. */
  const reachOf = (body: RecordedBody): [number, number] => {
    const [x0, , z0] = body.recorded(0, 0);
    const places = body.places(false);
    const along = places.flatMap((x, i) => (i % 3 !== 0 ? []
      : [(x - x0) * sx + (places[i + 2] - z0) * sz]));
    return [Math.min(...along), Math.max(...along)];
  };
  const edge = reachOf(subject);
  const [x0, , z0] = subject.recorded(0, 0);
  avatars.filter(({frames}) => frames > 0).forEach((avatar, i) => {
    const reach = reachOf(avatar);
    const right = i % 2 === 0 ? 0 : 1;
    const along = right === 0 ? edge[0] - APART_M - reach[1] : edge[1] + APART_M - reach[0];
    edge[right] = along + reach[right];
    const [x, , z] = avatar.recorded(0, 0);
    avatar.words.offset_m = [x0 - x + along * sx, 0, z0 - z + along * sz];
  });
}
