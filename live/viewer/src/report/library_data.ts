// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Data of the page of a library's check (docs/formats/library_check.md).

export const VERDICTS = ['pass', 'warn', 'fail'] as const;
/** An index into VERDICTS. */
export type Verdict = 0 | 1 | 2;

interface Total {clips: number; hours: number}
export interface FigureSummary {
  figure: string; kind: string; limits: [number, number] | null; clips: number;
  warned: number; failed: number; median: number; p95: number;
  worst: {clip: string; name: string; value: number; joint: string;
    frames: [number, number] | null};
}
export interface KindSummary {kind: string; clips: number; problems: number; seconds: number}
export interface FailedSource {source: string; where: string; cause: string; next: string}
export interface CheckSummary {
  marey_version: string; library: string; query: string; total: Total;
  verdicts: Record<(typeof VERDICTS)[number], Total>; duplicates: number;
  figures: FigureSummary[]; kinds: KindSummary[]; failed: FailedSource[];
}

/** id, name, source, verdict, frames, rate [Hz], value of each figure, digit of each
 *  verdict or '-', places of figures that warn or fail (figure, joint, first and last frame
 *  or -1), problems (kind, joint, first frame, last frame, value, verdict). */
export type ClipRow = [string, string, string, Verdict, number, number, (number | null)[],
  string, [number, string, number, number][],
  [number, string, number, number, number, Verdict][]];

export interface LibraryData {
  summary: CheckSummary; folder: string; left_out: number; clips: ClipRow[];
}

export interface Problem {
  kind: number; joint: string; start_s: number; end_s: number; value: number;
  verdict: Verdict;
}
export interface Clip {
  id: string; name: string; source: string; verdict: Verdict; seconds: number;
  values: (number | null)[];
  /** One for each figure; null: it is only reported. */
  verdicts: (Verdict | null)[];
  places: Map<number, {joint: string; start_s: number | null}>;
  problems: Problem[];
  /** Position from the worst clip to the best. */
  rank: number;
  /** Text that the filter searches, in lower case. */
  words: string;
}

export function clipOf(row: ClipRow, {kinds}: CheckSummary, rank = 0): Clip {
  const [id, name, source, verdict, frames, rate, values, digits, places, problems] = row;
  const step = rate > 0 ? 1 / rate : 0;
  return {id, name, source, verdict, seconds: frames * step, values,
    verdicts: [...digits].map((digit) => (digit === '-' ? null : Number(digit) as Verdict)),
    places: new Map(places.map(([figure, joint, first]) =>
      [figure, {joint, start_s: first < 0 ? null : first * step}])),
    problems: problems.map(([kind, joint, first, last, value, level]) =>
      ({kind, joint, start_s: first * step, end_s: (last + 1) * step, value, verdict: level})),
    rank,
    words: [id, name, source, ...new Set(problems.map(([kind]) => kinds[kind].kind))]
      .join('\n').toLowerCase()};
}

/** Returns the number of bars of a histogram that each value is in, and its end: the last bar
 *  holds all values above. Limits are always inside. */
export function histogram(values: readonly number[], limits: readonly [number, number] | null,
  bars: number): {counts: number[]; from: number; to: number; above: number} {
  let from = Math.min(0, ...limits ?? []);
  let highest = 0;
  for (const value of values) {
    from = Math.min(from, value);
    highest = Math.max(highest, value);
  }
  const to = limits ? Math.max(limits[1] * 1.25, 1e-9) : Math.max(highest, from + 1e-9);
  const counts = new Array<number>(bars).fill(0);
  let above = 0;
  for (const value of values) {
    if (value > to) above += 1;
    else counts[Math.min(bars - 1, Math.floor(bars * (value - from) / (to - from)))] += 1;
  }
  return {counts, from, to, above};
}
