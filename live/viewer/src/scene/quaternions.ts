// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Rotations in flat arrays, x y z w, without allocation.

type Numbers = Float32Array | Float64Array | number[];

/** out = a b: first b, then a. `out` may be one of them. */
export function multiply(out: Numbers, o: number, a: Numbers, i: number, b: Numbers,
  k: number): void {
  const ax = a[i], ay = a[i + 1], az = a[i + 2], aw = a[i + 3];
  const bx = b[k], by = b[k + 1], bz = b[k + 2], bw = b[k + 3];
  out[o] = aw * bx + ax * bw + ay * bz - az * by;
  out[o + 1] = aw * by - ax * bz + ay * bw + az * bx;
  out[o + 2] = aw * bz + ax * by - ay * bx + az * bw;
  out[o + 3] = aw * bw - ax * bx - ay * by - az * bz;
}

/** out = inverse(a) b, for unit quaternions. `out` may be one of them. */
export function multiplyInverse(out: Numbers, o: number, a: Numbers, i: number, b: Numbers,
  k: number): void {
  const ax = -a[i], ay = -a[i + 1], az = -a[i + 2], aw = a[i + 3];
  const bx = b[k], by = b[k + 1], bz = b[k + 2], bw = b[k + 3];
  out[o] = aw * bx + ax * bw + ay * bz - az * by;
  out[o + 1] = aw * by - ax * bz + ay * bw + az * bx;
  out[o + 2] = aw * bz + ax * by - ay * bx + az * bw;
  out[o + 3] = aw * bw - ax * bx - ay * by - az * bz;
}

/** out = v rotated by q. `out` may be v. */
export function turn(out: Numbers, o: number, q: Numbers, i: number, v: Numbers,
  k: number): void {
  const x = q[i], y = q[i + 1], z = q[i + 2], w = q[i + 3];
  const vx = v[k], vy = v[k + 1], vz = v[k + 2];
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  out[o] = vx + w * tx + y * tz - z * ty;
  out[o + 1] = vy + w * ty + z * tx - x * tz;
  out[o + 2] = vz + w * tz + x * ty - y * tx;
}

/** out = interpolation from a to b along the shorter arc; `share` 0 is a, 1 is b. Normalised
 *  linear: frames are so close that the difference to slerp is invisible. */
export function blend(out: Numbers, a: Numbers, b: Numbers, i: number, share: number): void {
  const alike = a[i] * b[i] + a[i + 1] * b[i + 1] + a[i + 2] * b[i + 2] + a[i + 3] * b[i + 3];
  const far = alike < 0 ? -share : share;
  let sum = 0;
  for (let k = i; k < i + 4; ++k) {
    out[k] = (1 - share) * a[k] + far * b[k];
    sum += out[k] * out[k];
  }
  const scale = sum > 0 ? 1 / Math.sqrt(sum) : 1;
  for (let k = i; k < i + 4; ++k) out[k] *= scale;
}
