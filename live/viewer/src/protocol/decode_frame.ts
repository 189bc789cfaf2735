// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Binary frames (docs/formats/page.md, kind 1), read into reused arrays: a
// frame costs no allocation.

import type {SkeletonWords} from './protocol';

export const FRAME_KIND = 1;
const FRAME_VERSION = 1;
const HEADER_BYTES = 24;
const HAS_POSE = 1;
const HAS_DOUBT = 2;
const HAS_BALANCE = 4;
const HAS_TRACKING = 8;
const HAS_ZMP = 16;
/** Maximum stored corners of a support polygon; feet and hands have far fewer. */
const MAX_CORNERS = 64;

/** One skeleton at one instant. */
export class SkeletonFrame {
  readonly joints: number;
  hasPose = false;
  hasUncertainty = false;
  hasBalance = false;
  hasTracking = false;
  readonly root_in_world = new Float32Array(3);
  /** x y z w of every joint, the rest rotation included. */
  readonly parent_from_joint: Float32Array;
  readonly sigma_m: Float32Array;
  /** Indices into SOURCES. */
  readonly source: Uint8Array;
  readonly centre_of_mass_in_world = new Float32Array(3);
  /** x z of every corner on the floor. */
  readonly support_xz = new Float32Array(2 * MAX_CORNERS);
  corners = 0;
  hasZmp = false;
  /** x z of the zero moment point on the floor. */
  readonly zmp_xz = new Float32Array(2);
  /** NaN: unknown. */
  residual_px = NaN;
  /** Bits: left heel, left ball, right heel, right ball. */
  bears = 0;

  constructor(joints: number) {
    this.joints = joints;
    this.parent_from_joint = new Float32Array(4 * joints);
    this.sigma_m = new Float32Array(joints);
    this.source = new Uint8Array(joints);
    for (let i = 0; i < joints; ++i) this.parent_from_joint[4 * i + 3] = 1;
  }

  /** Copies another figure's values. Precondition: the same number of joints. */
  copy(other: SkeletonFrame): void {
    const {hasPose, hasUncertainty, hasBalance, hasTracking, hasZmp} = other;
    const {corners, residual_px, bears} = other;
    Object.assign(this, {hasPose, hasUncertainty, hasBalance, hasTracking, hasZmp, corners,
      residual_px, bears});
    this.root_in_world.set(other.root_in_world);
    this.parent_from_joint.set(other.parent_from_joint);
    this.sigma_m.set(other.sigma_m);
    this.source.set(other.source);
    this.centre_of_mass_in_world.set(other.centre_of_mass_in_world);
    this.support_xz.set(other.support_xz);
    this.zmp_xz.set(other.zmp_xz);
  }
}

/** Everything of one instant. */
export class SceneFrame {
  frame = 0;
  time_s = 0;
  /** On the server's clock. */
  sent_s = 0;
  readonly skeletons: SkeletonFrame[];

  constructor(skeletons: readonly Pick<SkeletonWords, 'joints'>[]) {
    this.skeletons = skeletons.map(({joints}) => new SkeletonFrame(joints.length));
  }
}

/** Reads the frame that starts at `offset`. Returns its end, or -1 if it is truncated or
 *  belongs to another scene; the content of `into` is then undefined. */
export function decodeFrame(view: DataView, offset: number, into: SceneFrame): number {
  if (offset + HEADER_BYTES > view.byteLength) return -1;
  if (view.getUint8(offset) !== FRAME_KIND) return -1;
  if (view.getUint8(offset + 1) !== FRAME_VERSION) return -1;
  if (view.getUint16(offset + 2, true) !== into.skeletons.length) return -1;
  into.frame = view.getUint32(offset + 4, true);
  into.time_s = view.getFloat64(offset + 8, true);
  into.sent_s = view.getFloat64(offset + 16, true);
  let at = offset + HEADER_BYTES;
  for (const skeleton of into.skeletons) {
    at = decodeSkeleton(view, at, skeleton);
    if (at < 0) return -1;
  }
  return at;
}

function decodeSkeleton(view: DataView, start: number, into: SkeletonFrame): number {
  const {joints} = into;
  if (start + 4 > view.byteLength) return -1;
  const flags = view.getUint8(start);
  if (view.getUint16(start + 2, true) !== joints) return -1;
  into.hasPose = (flags & HAS_POSE) !== 0;
  into.hasUncertainty = (flags & HAS_DOUBT) !== 0;
  into.hasBalance = (flags & HAS_BALANCE) !== 0;
  into.hasTracking = (flags & HAS_TRACKING) !== 0;
  into.hasZmp = into.hasBalance && (flags & HAS_ZMP) !== 0;
  let at = start + 4;
  if (into.hasPose) {
    if (at + 12 + 16 * joints > view.byteLength) return -1;
    at = readFloats(view, at, into.root_in_world, 3);
    at = readFloats(view, at, into.parent_from_joint, 4 * joints);
  }
  if (into.hasUncertainty) {
    if (at + 4 * joints + paddedBytes(joints) > view.byteLength) return -1;
    at = readFloats(view, at, into.sigma_m, joints);
    for (let i = 0; i < joints; ++i) into.source[i] = Math.min(view.getUint8(at + i), 2);
    at += paddedBytes(joints);
  }
  if (into.hasBalance) at = decodeBalance(view, at, into);
  return at >= 0 && into.hasTracking ? decodeTracking(view, at, into) : at;
}

function decodeBalance(view: DataView, start: number, into: SkeletonFrame): number {
  if (start + 16 > view.byteLength) return -1;
  let at = readFloats(view, start, into.centre_of_mass_in_world, 3);
  const corners = view.getUint16(at, true);
  at += 4;
  if (at + 8 * corners > view.byteLength) return -1;
  into.corners = Math.min(corners, MAX_CORNERS);
  readFloats(view, at, into.support_xz, 2 * into.corners);
  at += 8 * corners;
  if (!into.hasZmp) return at;
  return at + 8 <= view.byteLength ? readFloats(view, at, into.zmp_xz, 2) : -1;
}

function decodeTracking(view: DataView, start: number, into: SkeletonFrame): number {
  if (start + 8 > view.byteLength) return -1;
  into.residual_px = view.getFloat32(start, true);
  into.bears = view.getUint8(start + 4);
  return start + 8;
}

function paddedBytes(count: number): number {
  return (count + 3) & ~3;
}

function readFloats(view: DataView, start: number, into: Float32Array, count: number): number {
  for (let i = 0; i < count; ++i) into[i] = view.getFloat32(start + 4 * i, true);
  return start + 4 * count;
}
