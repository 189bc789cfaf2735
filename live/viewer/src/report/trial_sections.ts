// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Sections on one trial: reprojection, tags and gaps, joint centres.

import {el} from '../base/elements';
import {boneWords, duration, fixed, plural} from '../base/words';
import {SOURCES} from '../protocol/protocol';
import type {Strip} from '../timeline/timeline_paint';
import {sourceStrip} from '../timeline/timeline_paint';
import {FileRows, listedCurve, RunRows} from '../timeline/timeline_rows';
import type {Run} from '../timeline/timeline_rows';
import {bar, chip, fold, lead, mm, paragraph, px, sourceLegend, table} from './common';
import type {GapFigures, TrialData, TrialFigures} from './data';
import {pageLink} from './page_links';
import type {Player} from './player';
import {bytesOf} from './recorded_body';

/** Returns the place of the highest residual. */
function worstFrame(values: readonly number[], {name, first_frame}: TrialFigures): HTMLElement | null {
  if (values.length === 0) return null;
  const worst = values.reduce((best, value, i) => (value > values[best] ? i : best), 0);
  const words = `frame ${worst + first_frame}, ${px(values[worst])}`;
  return el('span', {}, 'The worst is ', pageLink(name, worst + first_frame, words) ?? words, '.');
}

export function reprojectionSection(player: Player, {frame_rms_px: values}: TrialData,
  figures: TrialFigures): HTMLElement[] {
  const level = figures.rms_px;
  return [
    lead('The distance of detected tag corners from their places in the solved motion. A steady ' +
      'curve is good; peaks mark moments to check. Click to see them in the viewer. ',
      worstFrame(values, figures)),
    player.timeline([], [{name: 'RMS', unit: 'px', level: {value: level, name: 'RMS'}, curves: [
      // 0: no tag was seen.
      listedCurve(values.map((value) => value || null), {colour: 'measured'}),
      listedCurve(values.map(() => level), {dash: [5, 4], width: 1})]}]).element,
    table('Reprojection and time offset per camera', figures.cameras, [
      ['Camera', (camera) => camera.name],
      ['RMS', (camera) => px(camera.rms_px), 'number'],
      ['Median', (camera) => px(camera.median_px), 'number'],
      ['Corners', (camera) => String(camera.corners), 'number'],
      ['Time offset', ({offset_ms}) => `${offset_ms > 0 ? '+' : ''}${fixed(offset_ms, 1)} ms`,
        'number'],
      ['Offset is', (camera) => camera.clock],
    ]),
  ];
}

/** Returns the shade for a number of cameras. */
function seenColour(count: number, most: number): string {
  return `color-mix(in srgb, var(--seen-all) ${count === 0 ? 0 : 30 + 70 * count / most}%, ` +
    'var(--seen-none))';
}

/** Returns a row per tag, grouped by segment, with the numbers of cameras as sources. */
function tagStrips(tags: TrialData['tags'], most: number): Strip[] {
  const segments = [...new Set(tags.map(({segment}) => segment))];
  const looks = Array.from({length: most + 1}, (_, i) => ({colour: seenColour(i, most)}));
  return segments.map((segment) => {
    const members = tags.filter((tag) => tag.segment === segment);
    const rows = new RunRows(members.map((_, i) => (i === 0 ? boneWords(segment) : '')),
      members.map(({cameras}) => runsOf(bytesOf(cameras))));
    return {rows, base: 'seen-none', looks, marks: members.map(({id}) => String(id)),
      words: (row, frame) => `tag ${members[row].id}: ${plural(rows.source(row, frame), 'camera')}`};
  });
}

/** Returns the runs of equal values other than 0. */
function runsOf(values: Uint8Array): Run[] {
  const runs: Run[] = [];
  for (let i = 0, first = 0; i < values.length; ++i) {
    if (values[i + 1] === values[i]) continue;
    if (values[i] > 0) runs.push([first, i, values[i]]);
    first = i + 1;
  }
  return runs;
}

function gapTable(gaps: readonly GapFigures[], trial: string): HTMLElement {
  return table('Gaps, the longest first', [...gaps].sort((a, b) => b.duration_s - a.duration_s), [
    ['Segment', (gap) => boneWords(gap.segment)],
    ['Frames', (gap) => {
      const words = `${gap.first_frame} – ${gap.last_frame}`;
      return pageLink(trial, gap.first_frame, words) ?? words;
    }, 'number'],
    ['Length', (gap) => `${fixed(gap.duration_s, 2)} s`, 'number'],
    ['Bridged as', (gap) => chip(gap.bridged_as, gap.bridged_as)],
  ]);
}

/** Returns rows of the segments that have gaps. */
export function gapRows({gaps, first_frame}: TrialFigures): FileRows {
  const names = [...new Set(gaps.map(({segment}) => segment))];
  return new FileRows({first_frame, tracks: names.map((name) => ({name,
    gaps: gaps.filter(({segment}) => segment === name).map((gap) =>
      [gap.first_frame, gap.last_frame, gap.bridged_as])}))});
}

export function tagsSection(player: Player, {tags}: TrialData, figures: TrialFigures): HTMLElement[] {
  const {gaps, name} = figures;
  const most = Math.max(1, ...tags.map(({cameras}) => bytesOf(cameras).reduce((a, b) =>
    Math.max(a, b), 0)));
  const lost = gaps.reduce((sum, gap) => sum + gap.duration_s, 0);
  return [
    lead('Every row is a tag, every column is a frame. Darker means that more cameras saw the ' +
      'tag: two or more locate it well, one locates it less accurately, none leaves a gap.'),
    el('ul', {class: 'legend'}, ...Array.from({length: most + 1}, (_, i) => el('li', {},
      el('span', {class: 'swatch', style: `background: ${seenColour(i, most)}`}),
      i === 0 ? ' unseen' : ` ${plural(i, 'camera')}`))),
    player.timeline(tagStrips(tags, most)).element,
    el('h3', {}, 'Gaps'),
    ...(gaps.length === 0 ? [paragraph('None: every segment was seen in every frame.')] : [
      lead(`A segment with tags was not seen ${plural(gaps.length, 'time')}, ${duration(lost)} ` +
        'in total. Every file that marey writes marks such frames of a segment as not seen.'),
      sourceLegend(false, SOURCES.slice(1)),
      player.timeline([{...sourceStrip(gapRows(figures)), base: 'card'}]).element,
      fold('All gaps as a table', gapTable(gaps, name))]),
  ];
}

export function jointsSection({joints}: TrialFigures): HTMLElement[] {
  if (joints.length === 0) return [paragraph('No joints were solved.')];
  const highest = Math.max(...joints.map((joint) => joint.p95_sigma_mm), 1);
  return [
    lead('The uncertainty of each joint centre, as estimated by the solver: the bar is the ' +
      'median sigma of all frames, the whisker the 95th percentile. The longest whisker ends at ' +
      `${fixed(highest, 0)}\u00a0mm.`),
    el('div', {class: 'row'}, sourceLegend(false)),
    table('Uncertainty of every joint centre', joints, [
      ['Joint', ({joint}) => boneWords(joint)],
      ['Sigma', (joint) => bar(joint.median_sigma_mm, joint.p95_sigma_mm, highest)],
      ['Median', (joint) => mm(joint.median_sigma_mm), 'number'],
      ['95 %', (joint) => mm(joint.p95_sigma_mm), 'number'],
      ['Seen', (joint) => el('div', {class: 'shares', title: SOURCES.map((source) =>
        `${source} ${fixed(joint[`${source}_percent`], 1)} %`).join(', ')},
      ...SOURCES.map((source) => el('span', {class: `fill-${source}`,
        style: `width: ${joint[`${source}_percent`]}%`})))],
    ]),
  ];
}
