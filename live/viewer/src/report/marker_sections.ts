// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The head of a report on labelled markers, and its tables.

import {el} from '../base/elements';
import {boneWords, fixed, percent, plural} from '../base/words';
import {listedCurve} from '../timeline/timeline_rows';
import {bar, card, cards, chip, lead, mm, notes, paragraph, showHead, sortableTable, table}
  from './common';
import type {Column} from './common';
import type {Fate, Label, MarkersData, MarkerTrial, MarkerTrialFigures} from './data';
import {fateCounts, isRemoved} from './marker_fates';
import {pageWords} from './page_links';
import type {Player} from './player';

const JOINT_WORDS: Record<string, string> = {UpperArm: 'shoulder', LowerArm: 'elbow',
  Hand: 'wrist', UpperLeg: 'hip', LowerLeg: 'knee', Foot: 'ankle', Toes: 'ball of the foot',
  Shoulder: 'collarbone'};

/** Common names of joints; otherwise the name of the bone that starts there. */
function jointWords(bone: string): string {
  const found = /^(left|right)([A-Z][A-Za-z]+)$/.exec(bone);
  return found && JOINT_WORDS[found[2]] ? `${found[1]} ${JOINT_WORDS[found[2]]}` : boneWords(bone);
}

function fitCards({trials}: MarkersData['figures']): HTMLElement[] {
  const solved = trials.reduce((sum, trial) => sum + trial.frames_solved, 0);
  const frames = trials.reduce((sum, trial) => sum + trial.frames_with_markers, 0);
  const worst = trials.filter(({rms_mm}) => rms_mm !== null)
    .sort((a, b) => b.rms_mm! - a.rms_mm!)[0];
  return [
    card('Off the body', fixed(worst?.rms_mm, 1), 'mm', 'RMS distance of markers from their ' +
      `places on the body${trials.length > 1 && worst ? `, worst in ${worst.trial}` : ''}`),
    card('Solved', fixed(100 * solved / Math.max(frames, 1), 1), '%',
      `${solved} of ${plural(frames, 'frame')} with markers`),
  ];
}

function headCards({kind, figures, fates, trials}: MarkersData): HTMLElement {
  const totals = trials.map((trial) => fateCounts(trial, fates));
  const count = (...names: Fate[]): number => names.reduce((sum, name) => sum +
    totals.reduce((part, counts) => part + counts[fates.indexOf(name)], 0), 0);
  const all = Math.max(count(...fates), 1);
  const [filled, predicted, empty] = [count('cluster', 'structure', 'spline'),
    count('predicted'), count('left-empty')];
  const faults = trials.flatMap(({markers}) => markers.flatMap((marker) => marker.faults));
  const removed = faults.filter(isRemoved).length;
  const swapped = (faults.length - removed) / 2;
  return cards(...(kind === 'fit' ? fitCards(figures) : []),
    card('Filled', percent((filled + predicted) / all), '',
      `${filled} samples from the other markers` +
      (kind === 'fit' ? `, ${predicted} from the skeleton` : '')),
    card('Left empty', percent(empty / all), '', `${plural(empty, 'sample')} without an estimate`),
    card('Wrong', String(faults.length - swapped), 'runs',
      `of samples: ${removed} removed, ${swapped} swapped and corrected`));
}

export function headSection(data: MarkersData): void {
  const {kind, figures, trials} = data;
  const isFit = kind === 'fit';
  const [first] = figures.trials;
  const about = [
    ...(isFit ? [`${fixed(figures.stature_m, 3)} m tall`] : []),
    figures.label_set ? `labels: ${figures.label_set}` : 'labels of an unknown set',
    plural(figures.labels.length, 'label'),
    ...(isFit ? [plural(trials.length, 'trial')]
      : [`${first.frames} frames at ${Number(first.rate_hz.toFixed(3))} Hz`]),
    ...(isFit && figures.fit_rms_mm !== undefined
      ? [`RMS ${mm(figures.fit_rms_mm)} between markers and body in the fit`] : [])];
  showHead(isFit ? figures.subject : first.file, kind, about.join(' · '), [
    isFit && pageWords(), headCards(data),
    notes([...figures.warnings, ...trials.flatMap((trial, i) =>
      trial.notes.map((note) => `${figures.trials[i].file}: ${note}`))], 'note')]);
}

export function residualsSection(player: Player, {figures}: MarkersData,
  {residuals}: MarkerTrial, figure: MarkerTrialFigures): HTMLElement[] {
  if (!residuals) {
    return [paragraph('This trial was not solved: it shows too few of the body’s markers.')];
  }
  const {step, rms_mm, worst_mm} = residuals;
  const level = figure.rms_mm!;
  const perFrame = (values: readonly (number | null)[]): (number | null)[] =>
    Array.from({length: figure.frames}, (_, i) => values[Math.floor(i / step)]);
  const segments = new Map(figures.labels.map(({label, segment}) => [label, segment ?? '']));
  const widest = Math.max(...figure.by_marker.map((marker) => marker.worst_mm), 1);
  return [
    lead('The RMS distance of measured markers from their places on the solved body, for ' +
      'each frame in the graph and for each marker in the table. Whiskers end at the worst frame.'),
    player.timeline([], [{name: 'RMS', unit: 'mm', level: {value: level, name: `all ${mm(level)}`},
      curves: [listedCurve(perFrame(rms_mm), {colour: 'measured'}),
        ...(step > 1 ? [listedCurve(perFrame(worst_mm), {colour: 'repaired', width: 1})] : []),
        listedCurve(perFrame(rms_mm).map(() => level), {dash: [5, 4], width: 1})]}]).element,
    sortableTable('Distance of every marker from the body', figure.by_marker, [
      ['Marker', ({marker}) => marker, '', ({marker}) => marker],
      ['Segment', ({marker}) => boneWords(segments.get(marker) ?? ''), '',
        ({marker}) => segments.get(marker) ?? ''],
      ['Distance', (m) => bar(m.rms_mm, m.worst_mm, widest)],
      ['RMS', (m) => mm(m.rms_mm), 'number', (m) => m.rms_mm],
      ['Worst', (m) => mm(m.worst_mm), 'number', (m) => m.worst_mm],
      ['Frames', (m) => String(m.frames), 'number', (m) => m.frames],
    ], 3),
  ];
}

const ORIGIN_MEANING: Record<string, string> = {
  movement: 'the movement of markers on both sides of it',
  landmarks: 'its place relative to nearby landmarks',
  proportions: 'an average body of this size',
  given: 'the given subject',
};

export function jointsSection({figures, lengths}: MarkersData): HTMLElement[] {
  const evidence = new Map(figures.joints.map((joint) => [joint.joint, joint]));
  const rows = lengths.map((length) => ({...length, origin: 'given', range_deg: null,
    ...evidence.get(length.joint)}));
  const origins = [...new Set(rows.map(({origin}) => origin))];
  return [
    lead('The evidence for each joint centre, the uncertainty of its place in the parent ' +
      'segment (sigma per coordinate), its range of rotation in all trials, and its distance ' +
      'from the parent joint.'),
    el('ul', {class: 'legend'}, ...origins.map((origin) => el('li', {},
      chip(origin, `${origin}: ${ORIGIN_MEANING[origin] ?? ''}`)))),
    table('Evidence for joint centres', rows, [
      ['Joint', ({joint}) => jointWords(joint)],
      ['Found from', ({origin}) => chip(origin, origin)],
      ['Sigma', ({sigma_mm}) => mm(sigma_mm), 'number'],
      ['Range', ({range_deg}) => (range_deg === null ? '' : `${fixed(range_deg, 0)}°`), 'number'],
      ['Length', ({length_mm}) => `${fixed(length_mm / 10, 1)} cm`, 'number'],
      ['from', ({from}) => jointWords(from)],
    ]),
  ];
}

const USE_MEANING: Record<string, string> = {
  named: 'used according to its name',
  found: 'name without a known meaning; placed by its movement',
  moved: 'moves with another segment than its name suggests',
  given: 'as in the given subject',
  'left-out': 'not used',
};

export function labelsSection({kind, figures, trials}: MarkersData): HTMLElement[] {
  const isFit = kind === 'fit';
  const all = Math.max(figures.trials.reduce((sum, trial) => sum + trial.frames, 0), 1);
  const landmark = ({landmark: name}: Label): string => name?.replaceAll('_', ' ') ?? '–';
  const fitColumns: Column<Label>[] = [
    ['Use', ({use, why}) => el('span', {class: `use-${use}`, title: USE_MEANING[use]},
      why ? `${use}: it ${why}` : use), '', ({use}) => use],
    ['Segment', ({segment}) => boneWords(segment ?? ''), '', ({segment}) => segment ?? ''],
    ['Place', ({sigma_mm}) => (sigma_mm === undefined ? '' : `± ${mm(sigma_mm)}`), 'number',
      ({sigma_mm}) => sigma_mm ?? -1],
    ['Strays', ({stray_mm}) => (stray_mm === undefined ? '' : mm(stray_mm)), 'number',
      ({stray_mm}) => stray_mm ?? -1],
  ];
  const prefix = figures.prefix ? `, all with the prefix “${figures.prefix}”` : '';
  const set = figures.label_set ? `The labels are ${figures.label_set}${prefix}. `
    : 'The set of the labels is unknown. ';
  return [
    lead(set + (isFit
      ? 'The meaning and the use of each label, the uncertainty of its place on the segment, ' +
        'and its movement from there by soft tissue and noise. Seen is the share of the frames ' +
        `of ${trials.length > 1 ? 'all trials' : 'the trial'}.`
      : 'The meaning that each label appears to have.')),
    sortableTable('Labels', figures.labels, [
      ['Label', ({label}) => label, '', ({label}) => label],
      ['Meaning', landmark, '', landmark],
      ...(isFit ? fitColumns : []),
      ['Seen', ({samples}) => percent(samples / all), 'number', ({samples}) => samples],
    ], 0),
  ];
}
