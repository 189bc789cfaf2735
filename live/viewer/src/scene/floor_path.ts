// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Paths on the floor: the way of a body's hips, points along it, and curves through points.

import {SceneFrame} from '../protocol/decode_frame';
import type {SkeletonWords} from '../protocol/protocol';
import {PosedSkeleton} from './posed_skeleton';

/** Frames of a motion, such as a MotionBlock. */
export interface MotionFrames {
  readonly frames: number;
  read(i: number, into: SceneFrame): void;
}

/** Places on the floor, x z each [m]: one every `every` frames, and one of the last frame. */
export interface FloorPath {xz: Float64Array; every: number; frames: number}

const PLACES_PER_S = 15;
const MAX_PLACES = 4000;

/** Returns the way of the hips (or the root) of a skeleton of the scene. Linear in frames. */
export function hipsPath(motion: MotionFrames, skeletons: readonly SkeletonWords[],
  which: number, rate_hz: number): FloorPath {
  const {frames} = motion;
  const every = Math.max(1, Math.floor(rate_hz / PLACES_PER_S), Math.ceil(frames / MAX_PLACES));
  const count = frames > 0 ? Math.ceil((frames - 1) / every) + 1 : 0;
  const xz = new Float64Array(2 * count);
  const scratch = new SceneFrame(skeletons);
  const words = skeletons[which];
  const hips = Math.max(words.joints.findIndex(({bone}) => bone === 'hips'), 0);
  const pose = new PosedSkeleton(words);
  for (let k = 0; k < count; ++k) {
    motion.read(Math.min(k * every, frames - 1), scratch);
    const frame = scratch.skeletons[which];
    if (frame.hasPose && hips > 0) pose.setFrame(frame);
    const p = hips > 0 ? pose.p_in_world.subarray(3 * hips, 3 * hips + 3) : frame.root_in_world;
    xz[2 * k] = p[0];
    xz[2 * k + 1] = p[2];
  }
  return {xz, every, frames};
}

/** Writes the place at a frame, with fractions. Precondition: the path has places. */
export function placeAt({xz, every, frames}: FloorPath, frame: number, into: number[]): void {
  const last = xz.length / 2 - 1;
  const at = Math.min(Math.max(frame, 0), frames - 1);
  const k = Math.max(Math.min(Math.floor(at / every), last - 1), 0);
  const end = Math.min((k + 1) * every, frames - 1);
  const share = end > k * every ? (at - k * every) / (end - k * every) : 0;
  const next = Math.min(k + 1, last);
  for (let c = 0; c < 2; ++c) {
    into[c] = (1 - share) * xz[2 * k + c] + share * xz[2 * next + c];
  }
}

/** Returns the mean of the `reach` places before and after each one; fewer near the ends, so
 *  that these stay and a straight path stays straight. */
export function smoothed(xz: ArrayLike<number>, reach: number): Float64Array {
  const count = xz.length / 2;
  const sums = new Float64Array(2 * count + 2);
  for (let i = 0; i < 2 * count; ++i) sums[i + 2] = sums[i] + xz[i];
  return Float64Array.from({length: 2 * count}, (_, i) => {
    const k = i >> 1;
    const near = Math.min(reach, k, count - 1 - k);
    return (sums[2 * (k + near + 1) + (i & 1)] - sums[2 * (k - near) + (i & 1)]) / (2 * near + 1);
  });
}

/** Returns the length of the path up to each place. */
export function waysOf(xz: ArrayLike<number>): Float64Array {
  const ways = new Float64Array(xz.length / 2);
  for (let k = 1; k < ways.length; ++k) {
    ways[k] = ways[k - 1] + Math.hypot(xz[2 * k] - xz[2 * k - 2], xz[2 * k + 1] - xz[2 * k - 1]);
  }
  return ways;
}

/** Returns the largest distance of a place from the first one. */
export function reachOf(xz: ArrayLike<number>): number {
  let reach = 0;
  for (let i = 2; i < xz.length; i += 2) {
    reach = Math.max(reach, Math.hypot(xz[i] - xz[0], xz[i + 1] - xz[1]));
  }
  return reach;
}

/** Returns `count` points at equal distances along the path, its ends included.
 *  Preconditions: count >= 2, two places. */
export function equidistant(xz: ArrayLike<number>, count: number): [number, number][] {
  const ways = waysOf(xz);
  const length = ways[ways.length - 1];
  let k = 0;
  return Array.from({length: count}, (_, i) => {
    const way = length * i / (count - 1);
    while (k < ways.length - 2 && ways[k + 1] < way) ++k;
    const step = ways[k + 1] - ways[k];
    const share = step > 0 ? Math.min((way - ways[k]) / step, 1) : 0;
    return [xz[2 * k] + share * (xz[2 * k + 2] - xz[2 * k]),
      xz[2 * k + 1] + share * (xz[2 * k + 3] - xz[2 * k + 1])];
  });
}

/** Number of points for a path of this length: about one per metre, 4 to 8. */
export function pointCount(length_m: number): number {
  return Math.min(Math.max(Math.round(length_m) + 1, 4), 8);
}

export interface NearPlace {
  /** Index of the place before it. */
  segment: number;
  x: number; z: number; away_m: number;
}

/** Returns the point of the path nearest to (x, z); null without a segment. */
export function nearestOnPath(xz: ArrayLike<number>, x: number, z: number): NearPlace | null {
  let best: NearPlace | null = null;
  for (let k = 0; 2 * k + 3 < xz.length; ++k) {
    const [ax, az] = [xz[2 * k], xz[2 * k + 1]];
    const [dx, dz] = [xz[2 * k + 2] - ax, xz[2 * k + 3] - az];
    const square = dx * dx + dz * dz;
    const share = square > 0
      ? Math.min(Math.max(((x - ax) * dx + (z - az) * dz) / square, 0), 1) : 0;
    const at = {segment: k, x: ax + share * dx, z: az + share * dz};
    const away_m = Math.hypot(at.x - x, at.z - z);
    if (!best || away_m < best.away_m) best = {...at, away_m};
  }
  return best;
}

/** Returns the second derivatives at the knots of the natural cubic spline. */
function bendsOf(knots: readonly number[], values: readonly number[]): number[] {
  const count = knots.length;
  const bends = new Array<number>(count).fill(0);
  const above = new Array<number>(count).fill(0);
  for (let i = 1; i < count - 1; ++i) {
    const before = knots[i] - knots[i - 1];
    const after = knots[i + 1] - knots[i];
    const pivot = 2 * (before + after) - before * above[i - 1];
    above[i] = after / pivot;
    const bend = 6 * ((values[i + 1] - values[i]) / after - (values[i] - values[i - 1]) / before);
    bends[i] = (bend - before * bends[i - 1]) / pivot;
  }
  for (let i = count - 2; i > 0; --i) bends[i] -= above[i] * bends[i + 1];
  return bends;
}

/** Returns places on the natural cubic spline through points, by the length of its chords, as
 *  the operation `path` computes it: `steps` from each point to the next. Equal neighbours are
 *  skipped. */
export function curveThrough(points: readonly (readonly [number, number])[],
  steps: number): Float64Array {
  const kept = points.filter(([x, z], i) => i === 0 ||
    Math.hypot(x - points[i - 1][0], z - points[i - 1][1]) > 1e-6);
  if (kept.length < 2) return Float64Array.from(kept.flat());
  const knots = Array.from(waysOf(kept.flat()));
  const columns = [0, 1].map((c) => kept.map((point) => point[c]));
  const bends = columns.map((values) => bendsOf(knots, values));
  const out = new Float64Array(2 * ((kept.length - 1) * steps + 1));
  let at = 0;
  for (let i = 0; i + 1 < kept.length; ++i) {
    const width = knots[i + 1] - knots[i];
    for (let s = i === 0 ? 0 : 1; s <= steps; ++s) {
      const b = s / steps;
      const a = 1 - b;
      for (let c = 0; c < 2; ++c) {
        out[at++] = a * columns[c][i] + b * columns[c][i + 1] + width * width / 6 *
          ((a * a * a - a) * bends[c][i] + (b * b * b - b) * bends[c][i + 1]);
      }
    }
  }
  return out;
}
