// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Classification of every sample: one row per marker, time along x.

import {checkbox, el} from '../base/elements';
import {duration, fixed, percent, plural} from '../base/words';
import type {Look, Strip} from '../timeline/timeline_paint';
import {ROW_PX} from '../timeline/timeline_paint';
import {RunRows} from '../timeline/timeline_rows';
import type {Run} from '../timeline/timeline_rows';
import {fold, lead, mm, paragraph, table} from './common';
import type {Fate, Fault, FateRun, MarkerFates, MarkersData, MarkerTrial, MarkerTrialFigures}
  from './data';
import type {Player} from './player';

const FATE_MEANING: Record<Fate, string> = {
  'measured': 'as read from the file',
  'swapped': 'measured under another marker’s name; corrected',
  'cluster': 'filled from the markers that move most rigidly with it',
  'structure': 'filled from the correlation of this trial’s markers',
  'spline': 'filled by interpolation of its own path',
  'predicted': 'filled from its place on the solved skeleton',
  'left-empty': 'not known',
};
const FAULT_MEANING = 'wrong samples (ghost, jump, frozen, not a number) that were removed; the ' +
  'colour below shows whether they were filled';
const MAX_ROWS = 300;

export const isRemoved = ([, , fault]: Fault): boolean => fault !== 'swapped';

/** Returns first and last frame in the recording's numbering. */
export function frameWords(trial: MarkerTrial, first: number, frames: number): string {
  const from = first + trial.first_frame;
  return frames === 1 ? `frame ${from}` : `frames ${from} – ${from + frames - 1}`;
}

/** Totals of all markers. */
export function fateCounts({markers}: MarkerTrial, fates: readonly Fate[]): number[] {
  return fates.map((_, i) => markers.reduce((sum, {counts}) => sum + counts[i], 0));
}

function fateLegend(trial: MarkerTrial, fates: readonly Fate[]): HTMLElement {
  const counts = fateCounts(trial, fates);
  const all = Math.max(counts.reduce((sum, count) => sum + count, 0), 1);
  const entry = (kind: string, name: string, words: string, title: string): HTMLElement =>
    el('li', {title}, el('span', {class: `swatch ${kind}`,
      style: `background: var(--fate-${kind})`}), ' ', el('b', {}, name), ` ${words}`);
  const removed = trial.markers.flatMap(({faults}) => faults).filter(isRemoved)
    .reduce((sum, [, frames]) => sum + frames, 0);
  return el('ul', {class: 'legend fate-legend'},
    ...fates.map((fate, i) => counts[i] > 0 && entry(fate, fate, percent(counts[i] / all),
      `${FATE_MEANING[fate]}: ${plural(counts[i], 'sample')}`)),
    removed > 0 && entry('removed', 'removed', plural(removed, 'sample'), FAULT_MEANING));
}

function runWords(trial: MarkerTrial, figure: MarkerTrialFigures, fates: readonly Fate[],
  [first, frames, fate, median, worst, carriers]: FateRun): string {
  const parts = [`${fates[fate]}, ${frameWords(trial, first, frames)} ` +
    `(${duration(frames / figure.rate_hz)})`];
  if (median !== undefined) {
    parts.push(`sigma ${mm(median)}` + (worst! > median ? `, at most ${mm(worst!)}` : ''));
  }
  if (carriers?.length) parts.push(`by ${carriers.map((m) => trial.markers[m].label).join(', ')}`);
  return parts.join('; ');
}

function faultWords(trial: MarkerTrial, [first, frames, fault, off, other]: Fault): string {
  const whom = other === undefined ? '' : ` with ${trial.markers[other].label}`;
  return `${fault}${whom}, ${frameWords(trial, first, frames)}` +
    (off > 0 ? `, ${fixed(off, 0)} mm off` : '');
}

/** Returns the rows of markers. A fate is drawn in its colour, an unknown sample with a line,
 *  too, and a removed one with a bar at the upper edge. */
function fateStrip(trial: MarkerTrial, figure: MarkerTrialFigures, fates: readonly Fate[],
  markers: readonly MarkerFates[]): Strip {
  const line = fates.length;
  const looks: Look[] = [...fates.map((fate) => ({colour: `fate-${fate}`, least: 1.5})),
    {colour: 'quiet', top: ROW_PX / 2 - 1.5, height: 1, least: 1.5},
    {colour: 'fate-removed', height: 4, least: 2}];
  const runs = markers.map(({runs: filled, faults}): Run[] => [
    ...filled.flatMap(([first, count, fate]): Run[] => [[first, first + count - 1, fate],
      ...(fates[fate] === 'left-empty' ? [[first, first + count - 1, line] as Run] : [])]),
    ...faults.filter(isRemoved).map(([first, count]): Run =>
      [first, first + count - 1, line + 1])]);
  const covers = (frame: number) => ([first, frames]: FateRun | Fault): boolean =>
    frame >= first && frame < first + frames;
  const marks = markers.map(({counts}) => percent((counts[0] + counts[1]) /
    Math.max(counts.reduce((sum, count) => sum + count, 0), 1)));
  return {rows: new RunRows(markers.map(({label}) => label), runs), base: 'fate-measured', looks,
    marks, words: (row, frame) => {
      const {label, runs: filled, faults} = markers[row];
      const run = filled.find(covers(frame));
      const words = [run ? runWords(trial, figure, fates, run) : 'measured',
        ...faults.filter(covers(frame)).map((fault) => faultWords(trial, fault))];
      return `${label}: ${words.join('; read: ')}`;
    }};
}

/** A gap or a run of wrong samples, as a row of the table. */
interface Repair {
  marker: string; first: number; frames: number; what: string; colour: string; sigma_mm?: number;
  worst_mm?: number; why: string;
}

function repairs({markers}: MarkerTrial, fates: readonly Fate[]): Repair[] {
  const all = markers.flatMap(({label: marker, runs, faults}) => [
    ...runs.filter(([, , fate]) => fates[fate] !== 'swapped').map(
      ([first, frames, fate, sigma_mm, worst_mm, carriers]): Repair => ({marker, first, frames,
        what: fates[fate], colour: fates[fate], sigma_mm, worst_mm,
        why: (carriers ?? []).map((m) => markers[m].label).join(', ')})),
    ...faults.map((fault): Repair => {
      const [first, frames, what, off, other] = fault;
      return {marker, first, frames, what, colour: isRemoved(fault) ? 'removed' : what,
        why: [...(other === undefined ? [] : [`with ${markers[other].label}`]),
          ...(off > 0 ? [`${fixed(off, 0)} mm off`] : [])].join(', ')};
    })]);
  return all.sort((a, b) => b.frames - a.frames);
}

function repairTable(trial: MarkerTrial, figure: MarkerTrialFigures, fates: readonly Fate[]):
  HTMLElement {
  const rows = repairs(trial, fates);
  const more = rows.length - MAX_ROWS;
  return fold(`${plural(rows.length, 'gap or run', 'gaps and runs')} of wrong samples as a table`,
    table('Gaps and wrong samples, the longest first', rows.slice(0, MAX_ROWS), [
      ['Marker', ({marker}) => marker],
      ['Frames', ({first, frames}) => frameWords(trial, first, frames).replace(/^frames? /, ''),
        'number'],
      ['Length', ({frames}) => `${fixed(frames / figure.rate_hz, 3)} s`, 'number'],
      ['What', ({what, colour}) => el('span', {class: 'chip',
        style: `border-color: var(--fate-${colour})`}, what)],
      ['Sigma', ({sigma_mm}) => (sigma_mm === undefined ? '' : mm(sigma_mm)), 'number'],
      ['at most', ({worst_mm}) => (worst_mm === undefined ? '' : mm(worst_mm)), 'number'],
      ['Source or error', ({why}) => why],
    ], 'bounded'),
    more > 0 && el('p', {class: 'about'}, `${more} shorter ones are not listed here.`));
}

export function samplesSection(player: Player, {fates}: MarkersData, trial: MarkerTrial,
  figure: MarkerTrialFigures): HTMLElement[] {
  const {markers} = trial;
  const touched = markers.filter(({runs, faults}) => runs.length + faults.length > 0);
  if (touched.length === 0) {
    return [paragraph(`${plural(markers.length, 'marker')}, all present in every frame, without ` +
      'wrong samples.')];
  }
  const place = el('div');
  const show = (shown: readonly MarkerFates[]): void => place.replaceChildren(
    player.timeline([fateStrip(trial, figure, fates, shown)]).element);
  show(markers);
  return [
    lead('Every row is a marker, with its share of measured frames; every column is a frame. ' +
      'Point at a gap or a fault for details.'),
    fateLegend(trial, fates),
    ...(touched.length === markers.length ? [] : [checkbox(
      `only the ${plural(touched.length, 'repaired marker')}`, false,
      (on) => show(on ? touched : markers), {class: 'switch'})]),
    place,
    repairTable(trial, figure, fates),
  ];
}
