// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Bodies in motion, as app/report_body.h writes them.

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
}

/** One body. `points` are the world positions and `turns` the rotations from rest at the
 *  instant of the last show(). */
class Body {
  constructor(data) {
    this.name = data.name;
    this.frames = data.frames;
    this.joints = data.joints;
    this.names = data.points.map((p) => p.name);
    this.parents = data.points.map((p) => p.parent);
    this.bones = data.points.map((p) => p.bone);
    this.unit = data.unit_m;
    this.origin = data.origin_m;
    this.xyz = new Int16Array(bytesOf(data.xyz).buffer);
    this.quaternions = new Int16Array(bytesOf(data.turns).buffer);
    this.source = data.source ? bytesOf(data.source) : null;
    this.sigma = data.sigma ? new Uint16Array(bytesOf(data.sigma).buffer) : null;
    this.offset = [0, 0, 0];
    this.points = new Float32Array(this.parents.length * 3);
    this.turns = new Float32Array(this.joints * 4);
    this.places = new Map();
    this.bones.forEach((bone, i) => { if (bone) this.places.set(bone, i); });
    this.tips = new Map();
    for (let i = this.joints; i < this.parents.length; ++i) {
      this.tips.set(this.parents[i], i);
    }
  }

  /** Returns the world position of a point of one frame, without the offset. */
  recorded(frame, point) {
    const at = 3 * (frame * this.parents.length + point);
    return [0, 1, 2].map((k) => this.origin[k] + this.unit * this.xyz[at + k]);
  }

  /** Sets the instant `time` [frames], which may lie between two frames. */
  show(time) {
    if (this.frames === 0) return;
    const last = this.frames - 1;
    const first = Math.min(Math.max(Math.floor(time), 0), last);
    const second = Math.min(first + 1, last);
    const share = Math.min(Math.max(time - first, 0), 1);
    this.frame = share < 0.5 ? first : second;
    const count = this.points.length;
    for (let i = 0; i < count; ++i) {
      const a = this.xyz[first * count + i];
      const b = this.xyz[second * count + i];
      this.points[i] =
        this.origin[i % 3] + this.unit * (a + share * (b - a)) + this.offset[i % 3];
    }
    this.#showTurns(first, second, share);
  }

  #showTurns(first, second, share) {
    for (let j = 0; j < this.joints; ++j) {
      const a = 4 * (first * this.joints + j);
      const b = 4 * (second * this.joints + j);
      let dot = 0;
      for (let k = 0; k < 4; ++k) dot += this.quaternions[a + k] * this.quaternions[b + k];
      const sign = dot < 0 ? -1 : 1;
      let square = 0;
      for (let k = 0; k < 4; ++k) {
        const value = (1 - share) * this.quaternions[a + k] +
          sign * share * this.quaternions[b + k];
        this.turns[4 * j + k] = value;
        square += value * value;
      }
      const length = Math.sqrt(square) || 1;
      for (let k = 0; k < 4; ++k) this.turns[4 * j + k] /= length;
    }
  }

  at(point) {
    return [this.points[3 * point], this.points[3 * point + 1], this.points[3 * point + 2]];
  }

  /** Rotates a direction of the rest pose by the joint's current rotation. */
  turned(joint, v) {
    const [x, y, z, w] = this.turns.subarray(4 * joint, 4 * joint + 4);
    const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]),
      2 * (x * v[1] - y * v[0])];
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
      v[2] + w * t[2] + x * t[1] - y * t[0]];
  }

  sourceNow(joint) {
    return this.source ? this.source[this.frame * this.joints + joint] : 0;
  }

  /** Returns the sigma of a joint. [m] */
  sigmaNow(joint) {
    return this.sigma ? this.sigma[this.frame * this.joints + joint] * 1e-4 : 0;
  }
}

/** Returns the lowest and highest corner of the chosen frames; with `relative`, floor
 *  coordinates are relative to the body's own path. */
function boundsOf(body, relative) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const step = Math.max(1, Math.floor(body.frames / 200));
  for (let frame = 0; frame < body.frames; frame += step) {
    const root = relative ? body.recorded(frame, 0) : [0, 0, 0];
    for (let i = 0; i < body.parents.length; ++i) {
      const p = body.recorded(frame, i);
      for (let k = 0; k < 3; ++k) {
        const value = p[k] - (k === 1 ? 0 : root[k]);
        low[k] = Math.min(low[k], value);
        high[k] = Math.max(high[k], value);
      }
    }
  }
  return {low, high};
}

/** Returns the horizontal unit vector perpendicular to the body's direction of travel. For a
 *  body that stays in place, the side direction of its root in the first frame. */
function sideOf(body) {
  const first = body.recorded(0, 0);
  const last = body.recorded(body.frames - 1, 0);
  const way = [last[0] - first[0], last[2] - first[2]];
  const length = Math.hypot(...way);
  if (length > 0.5) return [way[1] / length, 0, -way[0] / length];
  body.show(0);
  const side = body.turned(0, [1, 0, 0]);
  const flat = Math.hypot(side[0], side[2]) || 1;
  return [side[0] / flat, 0, side[2] / flat];
}

/** Returns the extent of a body to both sides of its first position, along `side`. */
function reachOf(body, side) {
  const start = body.recorded(0, 0);
  const reach = [0, 0];
  for (let frame = 0; frame < body.frames; frame += 2) {
    for (let i = 0; i < body.parents.length; ++i) {
      const p = body.recorded(frame, i);
      const along = (p[0] - start[0]) * side[0] + (p[2] - start[2]) * side[2];
      reach[0] = Math.min(reach[0], along);
      reach[1] = Math.max(reach[1], along);
    }
  }
  return reach;
}

/** Places the avatars next to the subject, alternately on its left and right, so that they
 *  start side by side and never intersect. */
function standAbreast(bodies) {
  const [subject, ...avatars] = bodies;
  if (!subject || subject.frames === 0) return;
  const kApart = 0.25; // [m]
  const side = sideOf(subject);
  const edge = reachOf(subject, side);
  const start = subject.recorded(0, 0);
  avatars.forEach((avatar, i) => {
    if (avatar.frames === 0) return;
    const reach = reachOf(avatar, side);
    const right = i % 2 === 0;
    const along = right ? edge[0] - kApart - reach[1] : edge[1] + kApart - reach[0];
    edge[right ? 0 : 1] = along + reach[right ? 0 : 1];
    const own = avatar.recorded(0, 0);
    avatar.offset = [start[0] - own[0] + along * side[0], 0,
      start[2] - own[2] + along * side[2]];
  });
}
