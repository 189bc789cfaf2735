// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Shapes of bones and joints, and the matrices of their instances.

import {BufferGeometry, CylinderGeometry, Float32BufferAttribute, IcosahedronGeometry} from
  'three';

const WAIST = 0.2; // Widest place of an octahedron, from its near end.

/** Returns an octahedron from the origin to (0, 1, 0), radius 1 at its waist, flat faces. */
export function boneGeometry(): BufferGeometry {
  const around = [[1, 0], [0, -1], [-1, 0], [0, 1]];
  const corners: number[] = [];
  around.forEach(([x, z], i) => {
    const [u, w] = around[(i + 1) % 4];
    corners.push(0, 1, 0, x, WAIST, z, u, WAIST, w);
    corners.push(0, 0, 0, u, WAIST, w, x, WAIST, z);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(corners, 3));
  geometry.computeVertexNormals();
  return geometry;
}

/** Returns an open tube from the origin to (0, 1, 0), radius 1. */
export function tubeGeometry(): BufferGeometry {
  return new CylinderGeometry(1, 1, 1, 20, 1, true).translate(0, 0.5, 0);
}

// Radii of a solid body, as shares of its stature, by the bone's end without its side.
const GIRTHS: [RegExp, number][] = [[/LowerArm$/, 0.026], [/Hand$/, 0.02], [/LowerLeg$/, 0.042],
  [/Foot$/, 0.028], [/Toes$/, 0.021], [/UpperLeg$/, 0.05], [/Shoulder$/, 0.03],
  [/UpperArm$/, 0.03], [/^(spine|chest|upperChest)$/, 0.075], [/^neck$/, 0.05], [/^head$/, 0.032]];

/** Returns the radius of the bone that ends at `bone`, which `near` begins. */
export function girthOf(bone: string, near: string): number {
  const known = GIRTHS.find(([end]) => end.test(bone));
  return known ? known[1] : near === 'head' ? 0.047 : /Hand$/.test(near) ? 0.016 : 0.014;
}

export function ballGeometry(detail: number): BufferGeometry {
  return new IcosahedronGeometry(1, detail);
}

/** Writes column-major matrix k of `out`: the bone from point `a` to point `b` of `p` with
 *  `radius`, moved by (dx, dy, dz). A bone of length 0 is not drawn. */
export function boneMatrix(out: Float32Array, k: number, p: Float32Array, a: number, b: number,
  radius: number, dx: number, dy: number, dz: number): void {
  const o = 16 * k;
  let ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
  const length = Math.hypot(ux, uy, uz);
  if (length < 1e-5) {
    out.fill(0, o, o + 15);
    out[o + 15] = 1;
    return;
  }
  ux /= length; uy /= length; uz /= length;
  // Any perpendicular axis is suitable, if it does not jump from frame to frame.
  let sx: number, sy: number, sz: number;
  if (Math.abs(uy) < 0.94) {
    sx = uz; sy = 0; sz = -ux;
  } else {
    sx = 0; sy = -uz; sz = uy;
  }
  const across = radius / Math.hypot(sx, sy, sz);
  sx *= across; sy *= across; sz *= across;
  out[o] = sx; out[o + 1] = sy; out[o + 2] = sz; out[o + 3] = 0;
  out[o + 4] = ux * length; out[o + 5] = uy * length; out[o + 6] = uz * length; out[o + 7] = 0;
  out[o + 8] = sy * uz - sz * uy; out[o + 9] = sz * ux - sx * uz;
  out[o + 10] = sx * uy - sy * ux; out[o + 11] = 0;
  out[o + 12] = p[a] + dx; out[o + 13] = p[a + 1] + dy; out[o + 14] = p[a + 2] + dz;
  out[o + 15] = 1;
}

/** Writes column-major matrix k of `out`: a ball at point `a` of `p`. */
export function ballMatrix(out: Float32Array, k: number, p: Float32Array, a: number,
  radius: number, dx: number, dy: number, dz: number): void {
  const o = 16 * k;
  out.fill(0, o, o + 12);
  out[o] = radius; out[o + 5] = radius; out[o + 10] = radius;
  out[o + 12] = p[a] + dx; out[o + 13] = p[a + 1] + dy; out[o + 14] = p[a + 2] + dz;
  out[o + 15] = 1;
}

/** Projects matrix k onto the floor, along light from slightly oblique above. */
export function flatten(out: Float32Array, k: number, floor_m: number): void {
  const o = 16 * k;
  for (let c = 0; c < 12; c += 4) {
    out[o + c] += 0.28 * out[o + c + 1];
    out[o + c + 2] += -0.2 * out[o + c + 1];
    out[o + c + 1] = 0;
  }
  const above = out[o + 13] - floor_m;
  out[o + 12] += 0.28 * above;
  out[o + 14] += -0.2 * above;
  out[o + 13] = floor_m;
}
