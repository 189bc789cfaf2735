// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Problems, labels and events of a clip for the timeline.

import type {ClipWords, LabelWords} from '../protocol/library_protocol';
import type {Strip, TimelineData} from '../timeline/timeline_paint';
import {ROW_PX} from '../timeline/timeline_paint';
import type {Run} from '../timeline/timeline_rows';
import {RunRows} from '../timeline/timeline_rows';
import {figureValue, verdictOfKind} from './figure_words';

/** Indices into the looks of the strip of problems. */
const FAIL = 1;
const WARN = 2;
const LABEL = 1;
/** Labels that marey found are the last rows, and there are many. */
const BY_MAREY = 'marey';
const LEAST_PX = 4;

function grouped<T>(items: readonly T[], name: (item: T) => string): [string, T[]][] {
  const groups = new Map<string, T[]>();
  for (const item of items) {
    const same = groups.get(name(item));
    if (same) same.push(item);
    else groups.set(name(item), [item]);
  }
  return [...groups];
}

function problemStrip(clip: ClipWords, toFrame: (frame: number) => number): Strip {
  const kinds = grouped(clip.problems, ({kind}) => kind);
  const rows = new RunRows(kinds.map(([kind]) => kind), kinds.map(([kind, problems]) =>
    problems.map(({frames: [first, last]}): Run => [toFrame(first), toFrame(last),
      verdictOfKind(clip, kind) === 'fail' ? FAIL : WARN])));
  const mark = (colour: string) => ({colour, top: 1, height: ROW_PX - 4, least: LEAST_PX});
  return {kind: 'problems', rows, base: 'seen-none',
    looks: [mark('seen-none'), mark('poor'), mark('repaired')], words: (row, frame) => {
      const [kind, problems] = kinds[row];
      const here = problems.find(({frames: [first, last]}) =>
        frame >= toFrame(first) - 1 && frame <= toFrame(last) + 1);
      if (!here) return `${kind}: ${problems.length}`;
      const figure = clip.figures.find((one) => one.kind === kind)?.name ?? '';
      return `${kind}${here.joint ? `, ${here.joint}` : ''}: ${figureValue(figure, here.value)}`;
    }};
}

function labelStrip(labels: readonly LabelWords[], colour: string, rate_hz: number): Strip {
  const texts = grouped(labels, ({text}) => text).sort(([a], [b]) => a.localeCompare(b));
  const rows = new RunRows(texts.map(([text]) => text), texts.map(([, same]) =>
    same.map(({start_s, end_s}): Run => [start_s * rate_hz, end_s * rate_hz, LABEL])));
  const look = {colour, top: 3, height: ROW_PX - 8, least: LEAST_PX};
  return {kind: 'labels', rows, base: 'seen-none', looks: [look, look], words: (row, frame) => {
    const [text, same] = texts[row];
    const here = same.find(({start_s, end_s}) =>
      frame >= start_s * rate_hz - 1 && frame <= end_s * rate_hz + 1);
    return here ? `${text}, by ${here.by}` : text;
  }};
}

/** Timeline of a clip. `rate_hz`: frames of its scene per second. */
export function clipTimeline(clip: ClipWords, rate_hz: number): TimelineData {
  const toFrame = (frame: number): number => frame / clip.frame_step;
  const found = clip.labels.filter(({by}) => by === BY_MAREY);
  const given = clip.labels.filter(({by}) => by !== BY_MAREY);
  return {strips: [problemStrip(clip, toFrame), labelStrip(given, 'good', rate_hz),
    labelStrip(found, 'measured', rate_hz)], summary: null, graphs: [], rate_hz,
  first_frame: 0, live: false,
  notes: clip.events.map(({frame, name}) => ({frame: toFrame(frame), text: name}))};
}
