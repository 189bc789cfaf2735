// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A body as solid capsules: a mannequin whose girth follows its size, because the report
// contains joints and no skin.

/** Numbers per capsule: a 3, b 3, radius at a and b, flatness, cap, side 3,
 *  colour 3. */
const CAPSULE = 16;

/** Capsules of all bodies at one instant. */
class Capsules {
  constructor() {
    this.values = new Float32Array(CAPSULE * 64);
    this.count = 0;
  }

  clear() {
    this.count = 0;
  }

  /** Adds a tapered capsule from a to b. Its section is an ellipse: `radius` along `side`,
   *  `flat` times `radius` across. `cap` is the roundness of the ends: 1 is a half ball. */
  add(a, b, radiusA, radiusB, colour, {side = null, flat = 1, cap = 1} = {}) {
    if ((this.count + 1) * CAPSULE > this.values.length) {
      const more = new Float32Array(this.values.length * 2);
      more.set(this.values);
      this.values = more;
    }
    const far = apart(a, b) < 1e-4 ? add(a, [0, 1e-4, 0]) : b;
    const along = unit(subtract(far, a));
    let across = side ?? (Math.abs(along[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]);
    across = subtract(across, scaled(along, dot(across, along)));
    this.values.set([...a, ...far, radiusA, radiusB, flat, cap, ...unit(across), ...colour],
      CAPSULE * this.count++);
  }
}

// Radii as shares of the stature, at the near and the far end.
const LIMBS = [
  ['UpperArm', 'LowerArm', 0.029, 0.022], ['LowerArm', 'Hand', 0.0225, 0.0155],
  ['UpperLeg', 'LowerLeg', 0.05, 0.033], ['LowerLeg', 'Foot', 0.034, 0.021],
];
const TORSO = ['hips', 'spine', 'chest', 'upperChest', 'neck'];
/** Half of the torso's width from the hips (0) to the root of the neck (1). */
const TORSO_WIDTH = [[0, 0.086], [0.25, 0.077], [0.5, 0.085], [0.7, 0.093], [0.85, 0.09],
  [0.94, 0.072], [1, 0.04]];
const TORSO_FLAT = 0.68;

function torsoWidth(share) {
  for (let i = 1; i < TORSO_WIDTH.length; ++i) {
    const [from, low] = TORSO_WIDTH[i - 1];
    const [to, high] = TORSO_WIDTH[i];
    if (share <= to) return low + (high - low) * (share - from) / (to - from);
  }
  return TORSO_WIDTH[TORSO_WIDTH.length - 1][1];
}

/** Builds the capsules of one body. */
class Figure {
  constructor(body) {
    this.body = body;
    this.stature = this.#measure();
    this.torso = TORSO.map((bone) => body.places.get(bone)).filter((j) => j !== undefined);
    this.fingers = [];
    for (let i = 0; i < body.joints; ++i) {
      if (body.bones[i] === null && body.parents[i] >= 0) this.fingers.push(i);
    }
  }

  #measure() {
    const {body} = this;
    if (body.frames === 0) return 1.7;
    body.show(0);
    const length = (from, to) => {
      const [a, b] = [body.places.get(from), body.places.get(to)];
      return a === undefined || b === undefined ? 0 : apart(body.at(a), body.at(b));
    };
    const leg = length('leftUpperLeg', 'leftLowerLeg') + length('leftLowerLeg', 'leftFoot');
    const trunk = length('hips', 'head');
    // Shares of the stature of an average person (Drillis and Contini 1966).
    if (leg > 0 && trunk > 0) return (leg + trunk) / 0.83;
    const {low, high} = boundsOf(body, false);
    return high[1] - low[1] || 1.7;
  }

  /** Adds the capsules of the instant set by body.show(). `colour(joint)` returns colours. */
  build(capsules, colour) {
    if (this.body.places.size === 0) {
      this.#sticks(capsules, colour);
      return;
    }
    this.#trunk(capsules, colour);
    this.#head(capsules, colour);
    for (const side of ['left', 'right']) {
      this.#limbs(side, capsules, colour);
      this.#hand(side, capsules, colour);
      this.#foot(side, capsules, colour);
    }
    const r = 0.0055 * this.stature;
    for (const joint of this.fingers) {
      const parent = this.body.parents[joint];
      capsules.add(this.body.at(parent), this.body.at(joint), r, r, colour(parent));
    }
  }

  #sticks(capsules, colour) {
    const {body} = this;
    const r = 0.016 * this.stature;
    body.parents.forEach((parent, i) => {
      if (parent >= 0) capsules.add(body.at(parent), body.at(i), r, 0.8 * r, colour(parent));
    });
  }

  #trunk(capsules, colour) {
    const {body, torso, stature} = this;
    if (torso.length < 2) return;
    const at = torso.map((joint) => body.at(joint));
    const sides = torso.map((joint) => body.turned(joint, [1, 0, 0]));
    const lengths = at.slice(1).map((p, i) => apart(p, at[i]));
    const total = lengths.reduce((sum, length) => sum + length, 0) || 1;
    let before = 0;
    lengths.forEach((length, i) => {
      const pieces = Math.max(1, Math.round(12 * length / total));
      for (let k = 0; k < pieces; ++k) {
        const [s, e] = [k / pieces, (k + 1) / pieces];
        const radius = (t) => stature * torsoWidth((before + t * length) / total);
        capsules.add(mix(at[i], at[i + 1], s), mix(at[i], at[i + 1], e), radius(s),
          radius(e), colour(torso[i]),
          {side: mix(sides[i], sides[i + 1], s), flat: TORSO_FLAT, cap: 0.55});
      }
      before += length;
    });
  }

  #head(capsules, colour) {
    const {body, stature} = this;
    const head = body.places.get('head');
    if (head === undefined) return;
    const at = body.at(head);
    const neck = body.places.get('neck');
    if (neck !== undefined) {
      capsules.add(body.at(neck), at, 0.031 * stature, 0.029 * stature, colour(neck));
    }
    const tip = body.tips.get(head);
    const up = tip === undefined
      ? scaled(body.turned(head, [0, 1, 0]), 0.125 * stature)
      : subtract(body.at(tip), at);
    const high = Math.hypot(...up);
    const forward = scaled(body.turned(head, [0, 0, 1]), high);
    const place = (upward, ahead) => add(add(at, scaled(up, upward)), scaled(forward, ahead));
    const side = body.turned(head, [1, 0, 0]);
    const paint = colour(head);
    capsules.add(place(0.3, 0.14), place(0.66, 0.06), 0.25 * high, 0.34 * high, paint,
      {side, flat: 1.12});
    // The nose shows the facing direction.
    capsules.add(place(0.5, 0.42), place(0.36, 0.47), 0.035 * high, 0.055 * high, paint);
  }

  #limbs(side, capsules, colour) {
    const {body, stature} = this;
    for (const [from, to, near, far] of LIMBS) {
      const a = body.places.get(side + from);
      const b = body.places.get(side + to);
      if (a === undefined || b === undefined) continue;
      capsules.add(body.at(a), body.at(b), near * stature, far * stature, colour(a));
    }
    const collar = body.places.get(`${side}Shoulder`);
    const arm = body.places.get(`${side}UpperArm`);
    if (collar !== undefined && arm !== undefined) {
      capsules.add(body.at(collar), body.at(arm), 0.026 * stature, 0.035 * stature,
        colour(collar));
    }
    const leg = body.places.get(`${side}UpperLeg`);
    const hips = body.places.get('hips');
    if (leg !== undefined && hips !== undefined) {
      capsules.add(mix(body.at(hips), body.at(leg), 0.55), body.at(leg), 0.05 * stature,
        0.05 * stature, colour(hips));
    }
  }

  #hand(side, capsules, colour) {
    const {body, stature} = this;
    const hand = body.places.get(`${side}Hand`);
    if (hand === undefined) return;
    const at = body.at(hand);
    const first = this.fingers.find((joint) => body.parents[joint] === hand);
    const tip = body.tips.get(hand);
    const outward = body.turned(hand, [side === 'left' ? 1 : -1, 0, 0]);
    let end = add(at, scaled(outward, 0.09 * stature));
    if (tip !== undefined) end = body.at(tip);
    if (first !== undefined) end = add(at, scaled(outward, 0.045 * stature));
    capsules.add(at, end, 0.0165 * stature, 0.0135 * stature, colour(hand),
      {side: body.turned(hand, [0, 0, 1]), flat: 0.55});
  }

  #foot(side, capsules, colour) {
    const {body, stature} = this;
    const foot = body.places.get(`${side}Foot`);
    if (foot === undefined) return;
    const ankle = body.at(foot);
    const toes = body.places.get(`${side}Toes`);
    const down = body.turned(foot, [0, -1, 0]);
    const ahead = body.turned(foot, [0, 0, 1]);
    const ball = toes === undefined
      ? add(ankle, add(scaled(down, 0.03 * stature), scaled(ahead, 0.085 * stature)))
      : body.at(toes);
    const drop = Math.max(dot(subtract(ball, ankle), down), 0);
    const heel = add(ankle, add(scaled(down, drop), scaled(ahead, -0.022 * stature)));
    const paint = colour(foot);
    const shape = {side: body.turned(foot, [1, 0, 0]), flat: 0.8};
    capsules.add(heel, ball, 0.017 * stature, 0.021 * stature, paint, shape);
    capsules.add(ankle, ball, 0.021 * stature, 0.017 * stature, paint, shape);
    const end = body.tips.get(toes) === undefined
      ? add(ball, scaled(body.turned(toes ?? foot, [0, 0, 1]), 0.03 * stature))
      : body.at(body.tips.get(toes));
    capsules.add(ball, end, 0.02 * stature, 0.012 * stature,
      toes === undefined ? paint : colour(toes), shape);
  }
}
