// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Vectors are arrays of three; matrices are column-major arrays of sixteen, as in
// WebGL.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0]];
const mix = (a, b, t) => add(scaled(a, 1 - t), scaled(b, t));
const unit = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));
const apart = (a, b) => Math.hypot(...subtract(a, b));

function product(a, b) {
  const out = new Array(16).fill(0);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      for (let k = 0; k < 4; ++k) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return out;
}

function perspective(angle, aspect, near, far) {
  const f = 1 / Math.tan(angle / 2);
  return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
    0, 0, 2 * far * near / (near - far), 0];
}

function lookAt(eye, target) {
  const z = unit(subtract(eye, target));
  const x = unit(cross([0, 1, 0], z));
  const y = cross(z, x);
  return [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0,
    -dot(x, eye), -dot(y, eye), -dot(z, eye), 1];
}

/** Projects a point into a picture of width x height; null behind the eye. */
function projected(clipFromWorld, p, width, height) {
  const m = clipFromWorld;
  const w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
  if (w < 0.05) return null;
  const x = m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12];
  const y = m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13];
  return {x: (0.5 + 0.5 * x / w) * width, y: (0.5 - 0.5 * y / w) * height, depth: w};
}

/** Returns the projection of a distant light onto the floor: x and z of [centre - half,
 *  centre + half] fill the picture; height becomes the depth. */
function shadowFromWorld(centre, half, light) {
  const s = 1 / half;
  const [kx, kz] = [-light[0] / light[1], -light[2] / light[1]];
  return [s, 0, 0, 0, s * kx, s * kz, 0.4, 0, 0, s, 0, 0,
    -s * centre[0], -s * centre[2], -0.9, 1];
}
