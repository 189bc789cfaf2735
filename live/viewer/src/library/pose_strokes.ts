// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Postures of a clip as strokes.

import type {PosePoints} from '../protocol/library_protocol';

/** Bones of a posture, in the order of its points. */
export const BONES = ['hips', 'spine', 'chest', 'upperChest', 'neck', 'head', 'leftShoulder',
  'leftUpperArm', 'leftLowerArm', 'leftHand', 'rightShoulder', 'rightUpperArm', 'rightLowerArm',
  'rightHand', 'leftUpperLeg', 'leftLowerLeg', 'leftFoot', 'leftToes', 'rightUpperLeg',
  'rightLowerLeg', 'rightFoot', 'rightToes'] as const;

/** The eye is to the right of the body, so that the left side is behind the trunk. */
export type StrokeSide = 'behind' | 'trunk' | 'front';

const CHAINS: readonly [StrokeSide, readonly (typeof BONES)[number][]][] = [
  ['behind', ['upperChest', 'leftUpperArm', 'leftLowerArm', 'leftHand']],
  ['behind', ['hips', 'leftUpperLeg', 'leftLowerLeg', 'leftFoot', 'leftToes']],
  ['trunk', ['hips', 'spine', 'chest', 'upperChest', 'neck', 'head']],
  ['front', ['hips', 'rightUpperLeg', 'rightLowerLeg', 'rightFoot', 'rightToes']],
  ['front', ['upperChest', 'rightUpperArm', 'rightLowerArm', 'rightHand']],
];

const STROKES = CHAINS.map(([side, bones]): [StrokeSide, number[]] =>
  [side, bones.map((bone) => BONES.indexOf(bone))]);
const NECK = BONES.indexOf('neck');
const HEAD = BONES.indexOf('head');
/** Radius of the head's circle, and the height that fits at least. */
const HEAD_MM = 105;
const LEAST_HEIGHT_MM = 1900;
const LEAST_WIDTH_MM = 800;

/** A stroke in pixels: x and y by turns. */
export interface Stroke {side: StrokeSide; points: number[]}
export interface Circle {x: number; y: number; radius: number}
export interface PoseStrokes {strokes: Stroke[]; head: Circle; ground_px: number}

export interface Box {left: number; top: number; width: number; height: number}

/** Returns the scale at which all postures fit into boxes of this size. [px per mm] */
export function scaleOf(poses: readonly PosePoints[], width: number, height: number): number {
  let high = LEAST_HEIGHT_MM;
  let wide = LEAST_WIDTH_MM / 2;
  for (const points of poses) {
    for (let i = 0; i < points.length; i += 2) {
      wide = Math.max(wide, Math.abs(points[i]));
      high = Math.max(high, points[i + 1] + HEAD_MM);
    }
  }
  // A lying body is wider than its box before it is too small to be seen.
  return Math.min(height / high, Math.max(width / (2 * wide), 0.6 * height / high));
}

/** Returns a posture in a box, on its lower edge. */
export function strokesOf(points: PosePoints, scale: number, box: Box): PoseStrokes {
  const ground_px = box.top + box.height;
  const middle = box.left + box.width / 2;
  const x = (bone: number): number => middle + scale * points[2 * bone];
  const y = (bone: number): number => ground_px - scale * points[2 * bone + 1];
  const strokes = STROKES.map(([side, bones]) =>
    ({side, points: bones.flatMap((bone) => [x(bone), y(bone)])}));
  // The head's joint is at its base.
  const [dx, dy] = [x(HEAD) - x(NECK), y(HEAD) - y(NECK)];
  const length = Math.hypot(dx, dy);
  const radius = HEAD_MM * scale;
  const [ux, uy] = length > 0.3 ? [dx / length, dy / length] : [0, -1];
  return {strokes, head: {x: x(HEAD) + radius * ux, y: y(HEAD) + radius * uy, radius}, ground_px};
}
