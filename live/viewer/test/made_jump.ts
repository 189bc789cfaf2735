// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A made jump with a push of the thesis law (Kulpa 2005, 6.3), its search space by brute force,
// and the answer that marey gives for it.

import type {JumpWords, LowestWords, OpKeys, PushRule, SpaceColumnWords} from
  '../src/protocol/edit_protocol';

const G = 9.81;
const T = 0.7;
const START_M = 1;
const END_M = 1.08;
const TAKEOFF_M_S = 2.43;
const STEPS = 240;

/** H + w (a + b (x - s)), H the quintic between rest at 0 and take-off at 1, w = x³(1 - x)³. */
export function thesisPush(s: number, lowest_m: number): (x: number) => [number, number, number] {
  const d = END_M - START_M;
  const v = TAKEOFF_M_S * T;
  const c = [START_M, 0, 0, 10 * d - 4 * v, -15 * d + 7 * v, 6 * d - 3 * v];
  const hermite = (x: number): [number, number] => [
    c.reduce((sum, one, k) => sum + one * x ** k, 0),
    c.reduce((sum, one, k) => sum + (k > 0 ? k * one * x ** (k - 1) : 0), 0)];
  const w = (x: number): number => x ** 3 * (1 - x) ** 3;
  const slope = (x: number): number => 3 * x * x * (1 - x) ** 2 * (1 - 2 * x);
  const a = (lowest_m - hermite(s)[0]) / w(s);
  const b = -(hermite(s)[1] + a * slope(s)) / w(s);
  const height = (x: number): number => hermite(x)[0] + w(x) * (a + b * (x - s));
  const e = 1e-4;
  return (x) => {
    const at = Math.min(Math.max(x, e), 1 - e);
    const [before, here, after] = [at - e, at, at + e].map(height);
    return [height(x), (after - before) / (2 * e * T), (after - 2 * here + before) / (e * T) ** 2];
  };
}

/** Each instant gives one bound, as the height is affine in the lowest one. */
export function columnAt(s: number): SpaceColumnWords | null {
  const [low, high] = [thesisPush(s, 0.5), thesisPush(s, 1)];
  let [from, to]: [[number, PushRule], [number, PushRule]] =
    [[-Infinity, 'force'], [Infinity, 'force']];
  const bound = (at0: number, at1: number, least: number, rule: PushRule): void => {
    const gain = (at1 - at0) / 0.5;
    if (Math.abs(gain) < 1e-9) return;
    const z = 0.5 + (least - at0) / gain;
    if (gain > 0 && z > from[0]) from = [z, rule];
    if (gain < 0 && z < to[0]) to = [z, rule];
  };
  for (let i = 1; i < STEPS; ++i) {
    const x = i / STEPS;
    const [p0, p1] = [low(x), high(x)];
    bound(p0[2], p1[2], -G, 'force');
    if (x < s - 0.01) bound(-p0[1], -p1[1], 0, 'fall');
    if (x > s + 0.01) bound(p0[1], p1[1], 0, 'rise');
  }
  return from[0] < to[0] ? [s, from[0], to[0], from[1], to[1]] : null;
}

export function madeSpace(columns = 96): SpaceColumnWords[] {
  return Array.from({length: columns}, (_, i) => columnAt((i + 1) / (columns + 1)))
    .filter((one) => one !== null);
}

const SPACE = madeSpace();
const START_S = 0.6;

/** The answer of marey for an operation on the second of three jumps. */
export function madeJump(id: string, op: number, keys: OpKeys): JumpWords {
  const number = Number(keys.jump ?? 1);
  const captured: LowestWords = {at: 0.68, height_m: 0.745};
  const isThesis = keys.law === 'thesis';
  const wanted = keys.lowest as unknown as LowestWords | undefined;
  const lowest = wanted ?? {at: 0.66, height_m: 0.77};
  const rise = Number(keys.apex_by_m ?? 0);
  const take_off = START_S + T;
  const v = Math.sqrt(TAKEOFF_M_S ** 2 + 2 * G * rise);
  const flight = 2 * v / G + 0.01;
  const landing = take_off + flight;
  const end = landing + 0.5;
  const made = thesisPush(lowest.at, lowest.height_m);
  const before = thesisPush(0.63, 0.79);
  const time_s: number[] = [];
  const curves = {height_m: [] as number[], captured_height_m: [] as number[],
    push_g: [] as number[], captured_push_g: [] as number[]};
  const at = (t: number, push: typeof made, speed: number): [number, number] => {
    if (t < START_S) return [START_M, 1];
    if (t <= take_off) {
      const [z, , a] = push((t - START_S) / T);
      return [z, a / G + 1];
    }
    const air = t - take_off;
    if (t < landing) return [END_M + speed * air - G / 2 * air * air * (speed / v), 0];
    const share = (t - landing) / 0.5;
    return [0.98 - 0.25 * Math.sin(Math.PI * share) * (1 - share / 2) + 0.02 * share,
      1 + 2.6 * Math.exp(-12 * share) * Math.min(share / 0.04, 1) - Math.max(0, 1 - share / 0.02)];
  };
  for (let t = 0.4; t < end + 0.1; t += 0.01) {
    time_s.push(t);
    const [z, f] = at(t, made, v);
    const [z0, f0] = at(t, before, TAKEOFF_M_S);
    curves.height_m.push(z);
    curves.push_g.push(f);
    curves.captured_height_m.push(z0);
    curves.captured_push_g.push(f0);
  }
  const found = (takeoff_s: number, rise_m: number, fall_m_s2: number): JumpWords['jumps'][0] => ({
    start_s: takeoff_s - T, takeoff_s, apex_s: takeoff_s + 0.25, landing_s: takeoff_s + 0.5,
    end_s: takeoff_s + 1, airtime_s: 2 * Math.sqrt(2 * rise_m / G), rise_m, fall_m_s2,
    lowest_at: captured.at, lowest_m: captured.height_m, takeoff: 'measured',
    landing: 'measured', findings: fall_m_s2 > -11 ? [] : [{severity: 'fair', id: 'fall',
      text: 'The captured flight falls at −12.2 m/s² instead of −9.81 m/s².',
      next: 'Set ballistic, which makes it a parabola.', value: 12.2, limit: 10.81, unit: ''}]});
  return {type: 'jump', id, revision: 1, op, output: 0, number,
    jumps: [found(1.3, 0.301, -9.6), found(3.42, 0.318, -12.2), found(5.9, 0.287, -9.9)],
    refusal: rise > 1 ? 'The body does not get that high: at most 0.62 m higher.' : '',
    time_s, ...curves,
    phases: {start_s: START_S, lowest_s: START_S + lowest.at * T, takeoff_s: take_off,
      apex_s: take_off + v / G, landing_s: landing, end_s: end},
    strength_g: 3.6, space: isThesis ? SPACE : [], lowest: isThesis ? lowest : null};
}
