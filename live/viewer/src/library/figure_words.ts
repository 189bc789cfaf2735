// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Figures of the quality gate as words.

import {short} from '../base/words';
import type {ClipWords, FigureWords, Verdict} from '../protocol/library_protocol';

const UNITS: readonly [RegExp, string][] = [[/_cm_s$/, '\u00a0cm/s'], [/_mm$/, '\u00a0mm'],
  [/_deg$/, '°'], [/_sigma$/, '\u00a0σ'], [/_s$/, '\u00a0s'], [/_frames$/, '\u00a0frames'],
  [/_share$/, ''], [/_count$/, ''], [/_ratio$/, '']];

/** Meanings of figures, for people. */
const MEANINGS: Record<string, string> = {
  cut: 'a jump of the whole body: frames are missing',
  drift_mm: 'path of a foot during one contact',
  flights: 'number of jumps that the rate can be checked with',
  flip_count: 'joints that turn by a large angle and back within few frames',
  float_mm: 'height of the soles above the floor while they bear',
  frozen_s: 'longest time in which a joint does not move and the rest does',
  gap_share: 'share of the joints that were inferred',
  jitter_mm: 'noise of the joints in quiet moments',
  limits_deg: 'angle beyond the range of human joints',
  longest_gap_s: 'longest time in which a joint was inferred',
  rate_ratio: 'rate of the file over the rate that free fall suggests, or its inverse',
  scale_sigma: 'size of the body against human proportions',
  self_mm: 'depth of a hand inside the body',
  sides_share: 'likelihood that left and right are exchanged',
  sigma_p95_mm: 'uncertainty of the limb joints',
  sink_mm: 'depth of the soles below the floor',
  slide_cm_s: 'level speed of the feet while they bear',
  sparc: 'smoothness of hips and hands',
  spike: 'a jump of a joint in a single frame, against the noise around it',
  still_share: 'share of the time in which nothing moves',
  swap_frames: 'frames in which left and right limbs are exchanged',
  tilt_deg: 'angle of the floor that the feet stand on',
  tpose_share: 'share of the time in a T-pose',
};

const ORDER: readonly (Verdict | null)[] = ['fail', 'warn', 'pass', null];

/** Returns "slide" for "slide_cm_s". */
export function figureName(name: string): string {
  const unit = UNITS.find(([end]) => end.test(name));
  return (unit ? name.replace(unit[0], '') : name).replaceAll('_', ' ');
}

/** Returns a value of a figure with its unit: "4.20 cm/s". */
export function figureValue(name: string, value: number): string {
  if (name.endsWith('_share')) return `${(100 * value).toFixed(1)}\u00a0%`;
  const unit = UNITS.find(([end]) => end.test(name))?.[1] ?? '';
  const text = Number.isInteger(value) ? String(value) : short(value);
  return text.replace('-', '−') + unit;
}

export function figureMeaning(name: string): string {
  return MEANINGS[name] ?? '';
}

/** Figures with the worst verdict first. */
export function worstFirst(figures: readonly FigureWords[]): FigureWords[] {
  return [...figures].sort((a, b) => ORDER.indexOf(a.verdict) - ORDER.indexOf(b.verdict) ||
    a.name.localeCompare(b.name));
}

/** Returns the verdict on problems of a kind: the worst of its figures'. A problem of an
 *  unknown kind is a warning. */
export function verdictOfKind(clip: Pick<ClipWords, 'figures'>, kind: string): Verdict {
  const own = clip.figures.filter((figure) => figure.kind === kind);
  return own.some(({verdict}) => verdict === 'fail') ? 'fail' : 'warn';
}
