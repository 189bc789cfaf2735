// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The verdict on a calibration, the recommended steps, and its tables.

import {el} from '../base/elements';
import {capitalized, fixed, plural} from '../base/words';
import {card, cards, fold, gradeOf, lead, mm, paragraph, px, showHead, table, withUnit}
  from './common';
import type {CalibratedCamera, Finding, RigFigures} from './data';
import {shownTarget} from './rig_viewer';

const MAX_OUTLIER_ROWS = 15;
const SEVERITY = {poor: '○ to fix', fair: '◐ to improve', note: 'note'};
const CHECKED_LAG_PX = 0.05;

function figureCards({cameras, limits, middle_error_mm, inlier_rms_px}: RigFigures): HTMLElement {
  const graded = (title: string, bounds: number[], value: number | null, text: string,
    unit: string, what: string): HTMLElement => {
    const [good, fair] = bounds;
    const way = good < fair ? 'up to' : 'from';
    return card(title, text, unit, what, gradeOf(bounds, value),
      `good ${way} ${good} ${unit}, can be used ${way} ${fair} ${unit}`);
  };
  const extreme = (key: 'centre_sigma_mm' | 'coverage_percent' | 'inlier_rms_px', sign: number):
    CalibratedCamera => cameras.reduce((a, b) => (sign * b[key] >= sign * a[key] ? b : a));
  const loose = extreme('centre_sigma_mm', 1);
  const narrow = extreme('coverage_percent', -1);
  const rough = extreme('inlier_rms_px', 1);
  return cards(
    graded('Points', limits.error_mm, middle_error_mm, fixed(middle_error_mm, 1), 'mm',
      'expected error of a point in the middle of the volume, at its worst height'),
    graded('Corners', limits.residual_px, inlier_rms_px, fixed(inlier_rms_px, 2), 'px',
      `RMS distance of corners from their expected places; worst in ${rough.name}: ` +
      `${fixed(rough.inlier_rms_px, 2)}`),
    card('Least certain position', `± ${fixed(loose.centre_sigma_mm, 1)}`, 'mm',
      `sigma of the position of ${loose.name}`),
    graded('Least coverage', limits.coverage_percent, narrow.coverage_percent,
      fixed(narrow.coverage_percent, 0), '%',
      `share of ${narrow.name}’s picture in which the target was seen`));
}

function judgement({verdict, middle_error_mm: error, findings}: RigFigures): string {
  const count = (severity: Finding['severity'], one: string, many: string): string => {
    const found = findings.filter((finding) => finding.severity === severity).length;
    return found === 1 ? one : `${found} ${many}`;
  };
  const point = error === null ? 'No two cameras see the middle of the volume.'
    : `The expected error of a point in the middle of the volume is ${mm(error)}.`;
  if (verdict === 'good') return `Good: these cameras can be used. ${point}`;
  if (verdict === 'fair') {
    return `Fair: these cameras can be used, and ${count('fair', 'one thing', 'things')} ` +
      `below would make them better. ${point}`;
  }
  return 'Look closer: do not use these cameras before you fix ' +
    `${count('poor', 'one thing', 'things')} below. ${point}`;
}

export function headSection(figures: RigFigures): void {
  const {findings, cameras, session, target, sightings, outliers} = figures;
  const found = findings.map(({severity, where, cause, next}) =>
    el('li', {class: `finding severity-${severity}`},
      el('span', {class: 'mark'}, SEVERITY[severity]),
      el('p', {}, el('span', {class: 'where'}, capitalized(where)), '. ',
        `${capitalized(cause)}.`),
      el('p', {class: 'next'}, el('b', {}, 'Do: '), `${next}.`)));
  showHead(`Cameras of ${session || 'the session'}`, 'calibration', [
    plural(cameras.length, 'camera'), target,
    `${plural(sightings, 'sighting')}, ${outliers} left out`].join(' · '), [
    el('p', {class: 'judgement'}, judgement(figures)),
    figureCards(figures),
    el('h2', {}, 'Recommended changes'),
    findings.length === 0 ? paragraph('None: coverage, tilt, shared views and errors are good.')
      : el('ul', {class: 'findings'}, ...found)]);
  document.title = `${session} – marey calibration`;
}

export function togetherSection(figures: RigFigures): HTMLElement[] {
  const {shared_views: shared, limits: {shared_instants: enough}, cameras} = figures;
  if (shared.length === 0) return [paragraph('No data.')];
  // Opposite cameras may share no view, but every camera must be connected to the rest.
  const best = (i: number): number => Math.max(...shared[i].filter((_, k) => k !== i));
  const cell = (i: number, k: number): HTMLElement => el('span', {class: i === k ? 'own'
    : (best(i) < enough || best(k) < enough) && 'weak'}, String(shared[i][k]));
  return [
    lead('The number of instants at which two cameras saw it together. These shared views ' +
      'determine the cameras’ positions relative to each other. Two cameras without shared ' +
      'views are connected through others, which is less accurate.'),
    table(`Instants at which two cameras saw the ${shownTarget(figures)} together`,
      [...cameras.keys()], [
        ['Camera', (i) => cameras[i].name],
        ...cameras.map(({name}, k) =>
          [name, (i: number) => cell(i, k), 'number'] as const),
      ], 'matrix'),
  ];
}

/** The estimated clocks. */
function clocksPart({cameras}: RigFigures): HTMLElement[] {
  const found = (camera: CalibratedCamera, name: string): CalibratedCamera['parameters'][number] |
    undefined => camera.parameters.find((parameter) => parameter.name === name);
  if (!cameras.some((camera) => found(camera, 'offset'))) return [];
  const cell = (name: string, unit: string, decimals: number) => (camera: CalibratedCamera) => {
    const parameter = found(camera, name);
    if (!parameter) return '';
    const {value, sigma} = parameter;
    return sigma > 0 ? `${fixed(value, decimals)} ± ${withUnit(sigma, decimals, unit)}` : 'held';
  };
  return [
    el('h3', {}, 'Clocks'),
    lead('Offset: delay of a frame against the first camera’s frame of the same number. Drift: ' +
      'change of the offset over time. Row to row: delay between adjacent rows of the picture.'),
    table('Clocks of the cameras', cameras, [
      ['Camera', ({name}) => name],
      ['Offset', cell('offset', 'ms', 2), 'number'],
      ['Drift', cell('drift', 'ppm', 1), 'number'],
      ['Row to row', cell('line_delay', 'µs', 1), 'number'],
    ]),
  ];
}

function lagPart({cameras}: RigFigures, target: string): HTMLElement[] {
  const lags = cameras.flatMap(({name, clock_lag: lag}) => (lag ? [{name, ...lag}] : []));
  if (lags.length === 0) return [];
  if (lags.every(({explained_px}) => explained_px <= CHECKED_LAG_PX)) {
    return [paragraph('All cameras started together: their errors do not follow the ' +
      `${target}’s movement.`)];
  }
  return [
    el('h3', {}, 'Synchronous start'),
    lead(`Errors that follow the ${target}’s movement show that a camera is late (positive) or ` +
      `early compared with the others. The ${target}’s place is computed from all cameras, so ` +
      'the true lag is larger.'),
    table('Lag of every camera', lags, [
      ['Camera', ({name}) => name],
      ['Late by', (lag) => `${fixed(lag.lag_ms, 2)} ± ${fixed(lag.sigma_ms, 2)} ms`, 'number'],
      ['Accounts for', ({explained_px}) => px(explained_px), 'number'],
    ]),
  ];
}

export function checksSection(figures: RigFigures): HTMLElement[] {
  const {cross_validation: check, warp_mm: warp} = figures;
  const target = shownTarget(figures);
  return [
    ...(check === null ? [lead('No frames were held out to check the calibration.')] : [
      lead('If only the even frames are used for the calibration, the RMS error is ' +
        `${px(check.seen_rms_px)} in these frames and ${px(check.held_out_rms_px)} in the odd ` +
        'frames; the two should be close. The table shows how much each camera differs between ' +
        'the calibrations from even and from odd frames, and its error if only the other ' +
        `cameras determine the place of the ${target}.`),
      table('Cross-validation', check.cameras, [
        ['Camera', ({name}) => name],
        ['Position difference', (c) => mm(c.centre_apart_mm), 'number'],
        ['Rotation difference', (c) => `${fixed(c.turn_apart_deg, 3)}°`, 'number'],
        ['Focal length difference', (c) => px(c.focal_apart_px, 1), 'number'],
        ['Held out (median)', (c) => px(c.held_out_median_px), 'number'],
      ])]),
    ...lagPart(figures, target),
    ...clocksPart(figures),
    ...(warp === null ? [] : [paragraph(`The board is bent: its edges rise by ${mm(warp[0], 2)} ` +
      `along x and ${mm(warp[1], 2)} along y, and it is twisted by ${mm(warp[2], 2)}. The ` +
      'calibration takes this into account.')]),
  ];
}

const PARAMETER_WORDS: Record<string, string> = {
  focal_x: 'Focal length x', focal_y: 'Focal length y', centre_x: 'Picture centre x',
  centre_y: 'Picture centre y', rotation_x: 'Rotation vector x', rotation_y: 'Rotation vector y',
  rotation_z: 'Rotation vector z', x: 'Place x', y: 'Place y', z: 'Place z',
  offset: 'Clock offset', drift: 'Clock drift', line_delay: 'Delay from row to row',
};
const UNIT_WORDS: Record<string, string> = {deg: '°', us: 'µs'};

export function parametersSection({cameras, sigma_factor}: RigFigures): HTMLElement[] {
  const units = new Map(cameras.flatMap(({parameters}) =>
    parameters.map(({name, unit}) => [name, unit] as const)));
  /** Rounds a value to the second digit of its sigma. */
  const text = (value: number, sigma: number): string => fixed(value, sigma > 0
    ? Math.min(Math.max(Math.ceil(1 - Math.log10(sigma)), 0), 9) : 4);
  const cell = (camera: CalibratedCamera) => (name: string) => {
    const parameter = camera.parameters.find((one) => one.name === name);
    if (!parameter) return '';
    const {value, sigma} = parameter;
    return el('span', {}, text(value, sigma), el('span', {class: 'sigma'},
      sigma > 0 ? ` ± ${text(sigma, sigma)}` : ' (held)'));
  };
  return [
    lead('All estimated numbers, each with its standard deviation. The standard deviations are ' +
      `${fixed(sigma_factor, 1)} times as large as those of independent corners with the stated ` +
      'detection errors.'),
    table('Parameters of every camera', [...units.keys()], [
      ['Parameter', (name) => {
        const unit = units.get(name)!;
        return (PARAMETER_WORDS[name] ?? name) + (unit && ` [${UNIT_WORDS[unit] ?? unit}]`);
      }],
      ...cameras.map((camera) => [camera.name, cell(camera), 'number'] as const),
    ]),
  ];
}

export function outliersSection(figures: RigFigures): HTMLElement[] {
  const {outlier_frames: frames, outliers, sightings} = figures;
  if (frames.length === 0) return [lead('All sightings agree: none was left out.')];
  const made = (rows: typeof frames): HTMLElement => table('Frames with outliers', rows, [
    ['Camera', ({camera}) => camera],
    ['Frame', ({frame}) => (frame !== null ? String(frame)
      : shownTarget(figures) === 'wand' ? 'scenery' : 'floor'), 'number'],
    ['Left out', (row) => `${row.left_out} of ${row.of}`, 'number'],
    ['Median error', (row) => px(row.median_error_px, 1), 'number'],
  ]);
  const rest = frames.slice(MAX_OUTLIER_ROWS);
  return [
    lead(`${outliers} of ${sightings} sightings do not agree with the rest and were left out, ` +
      'in the frames below, the worst first. A hand, blur or a mirror can cause single ' +
      'outliers. If most are of one camera, it was moved or is not synchronized.'),
    made(frames.slice(0, MAX_OUTLIER_ROWS)),
    ...(rest.length === 0 ? [] : [fold(`${rest.length} more`, made(rest))]),
  ];
}
