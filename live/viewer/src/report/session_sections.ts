// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The head of a session's report, and its sections on subject, files and time.

import {el} from '../base/elements';
import {boneWords, duration, fixed, plural} from '../base/words';
import {bar, card, cards, fold, gradeOf, lead, mm, notes, px, showHead, table, withUnit, worstGrade}
  from './common';
import type {Column, Grade} from './common';
import type {AvatarFigures, ReportFigures, SubjectFigures, Summary, TrialFigures} from './data';
import {fileLink, pageWords} from './page_links';

/** Bounds of good and of fair values. */
const LIMITS = {
  solved_percent: [98, 90], calibration_px: [0.5, 1], solve_px: [1, 2], sigma_mm: [10, 20],
  camera: [2, 4], frame: [6, 12], joint: [20, 40],
};

function worstWords({worst}: Summary, kind: 'camera' | 'frame' | 'joint', unit: string,
  decimals: number): string {
  const found = worst[kind];
  return found === null ? '' : `; worst ${kind} ${found.name} (${found.trial}): ` +
    withUnit(found.value, decimals, unit);
}

function summaryCards(summary: Summary): HTMLElement {
  const {poor, worst} = summary;
  // Results that the program rates as unreliable have no good figure.
  const trust: Grade = poor.length === 0 ? 'good' : 'look closer';
  const graded = (title: string, value: string, unit: string, what: string,
    kind: keyof typeof LIMITS, grade: Grade): HTMLElement => {
    const [good, fair] = LIMITS[kind];
    const way = good < fair ? 'up to' : 'from';
    return card(title, value, unit, what, grade,
      `good ${way} ${good} ${unit}, fair ${way} ${fair} ${unit}`);
  };
  const worstOf = (kind: 'camera' | 'frame' | 'joint'): Grade =>
    gradeOf(LIMITS[kind], worst[kind]?.value ?? 0);
  return cards(
    card('Trust', poor.length === 0 ? 'yes' : 'no', '', poor.length === 0
      ? 'no check found a severe problem'
      : `${plural(poor.length, 'severe problem')}: ${poor[0]}`, trust),
    graded('Solved', fixed(summary.solved_percent, 1), '%',
      `${summary.frames_solved} of ${plural(summary.frames, 'frame')}`, 'solved_percent',
      gradeOf(LIMITS.solved_percent, summary.solved_percent)),
    graded('Cameras', fixed(summary.calibration_rms_px, 2), 'px',
      'RMS distance of the board from its expected place', 'calibration_px',
      gradeOf(LIMITS.calibration_px, summary.calibration_rms_px)),
    graded('Motion', fixed(summary.solve_rms_px, 2), 'px',
      'RMS distance of tags from their places on the solved body' +
        worstWords(summary, 'camera', 'px', 2) + worstWords(summary, 'frame', 'px', 2), 'solve_px',
      worstGrade(trust, gradeOf(LIMITS.solve_px, summary.solve_rms_px), worstOf('camera'),
        worstOf('frame'))),
    graded('Joints', `± ${fixed(summary.joint_sigma_median_mm, 1)}`, 'mm',
      'typical uncertainty (sigma) of a joint centre in a frame' +
        worstWords(summary, 'joint', 'mm', 1), 'sigma_mm',
      worstGrade(trust, gradeOf(LIMITS.sigma_mm, summary.joint_sigma_median_mm),
        worstOf('joint'))));
}

export function headSection({summary, warnings, session, trials}: ReportFigures): void {
  const avatars = new Set(trials.flatMap((trial) => trial.avatars.map(({name}) => name)));
  const about = [plural(summary.trials, 'trial'), `${duration(summary.recorded_s)} recorded`,
    ...(avatars.size > 0 ? [plural(avatars.size, 'avatar')] : []),
    `${duration(summary.processing_s)} to process`];
  showHead(session || 'Session', 'report', about.join(' · '),
    [pageWords(), summaryCards(summary), notes(warnings, 'warning')]);
}

type Bone = SubjectFigures['bones'][number];

/** Puts left and right of the same bone in one row. */
function pairBones(bones: readonly Bone[]): {words: string; one: Bone; other?: Bone}[] {
  const bare = (name: string): string => boneWords(name).replace(/^left /, '');
  return bones.filter(({to}) => !to.startsWith('right')).map((one) => ({
    words: `${bare(one.from)} – ${bare(one.to)}`, one, other: bones.find(({to}) =>
      one.to.startsWith('left') && to === one.to.replace('left', 'right'))}));
}

export function subjectSection(subject: SubjectFigures): HTMLElement[] {
  const {unplaced_tags: unplaced, limb_ratio, mass_kg, tags} = subject;
  const length = (bone?: Bone): string => (bone
    ? `${fixed(bone.length_mm / 10, 1)} cm ± ${mm(bone.sigma_mm)}` : '');
  const about = [`stature ${fixed(subject.stature_m, 2)} m`,
    ...(mass_kg === null ? [] : [`${fixed(mass_kg, 0)} kg`]),
    ...(limb_ratio > 0 ? [`limbs ${fixed(limb_ratio, 2)} × those of an average person of that ` +
      'stature'] : []), `fit ${px(subject.rms_px)}`];
  return [
    lead(`${subject.name || 'The subject'}: ${about.join(', ')}.`),
    table('Lengths of the subject', pairBones(subject.bones), [
      ['From joint to joint', ({words}) => words],
      ['Left or middle', ({one}) => length(one), 'number'],
      ['Right', ({other}) => length(other), 'number'],
    ]),
    el('h3', {}, 'Tags on the body'),
    lead(`${plural(tags.length, 'tag is', 'tags are')} placed` + (unplaced.length === 0 ? '.'
      : `; seen too rarely to be located: ${unplaced.join(', ')}.`)),
    fold('All tags as a table', table('Tags of the subject', tags, [
      ['Tag', ({id}) => String(id)],
      ['Segment', ({segment}) => boneWords(segment)],
      ['Edge', ({size_mm}) => mm(size_mm), 'number'],
      ['Place', ({sigma_mm}) => `± ${mm(sigma_mm)}`, 'number'],
      ['Tilt', ({sigma_deg}) => `± ${fixed(sigma_deg, 2)}°`, 'number'],
      ['Sightings', ({sightings}) => String(sightings), 'number'],
    ])),
  ];
}

export function avatarsSection(trials: readonly TrialFigures[]): HTMLElement[] {
  type Row = AvatarFigures & {trial: string};
  const rows: Row[] = trials.flatMap(({name: trial, files, avatars}) =>
    [{trial, name: 'subject', files}, ...avatars.map((avatar) => ({...avatar, trial}))]);
  const optional = (value: number | undefined, decimals: number, unit: string): string =>
    (value === undefined ? '' : withUnit(value, decimals, unit));
  const columns: Column<Row>[] = [
    ['Trial', ({trial}) => trial],
    ['Body', ({name}) => name],
    ['Files', ({files}) => el('span', {class: 'files'},
      ...files.flatMap((file) => [fileLink(file), ' ']))],
    ['Foot slide before', (row) => optional(row.slide_before_cm_per_s, 2, 'cm/s'), 'number'],
    ['after', (row) => optional(row.slide_after_cm_per_s, 2, 'cm/s'), 'number'],
    ['Floor penetration', (row) => optional(row.penetration_mm, 1, 'mm'), 'number'],
  ];
  const isSome = trials.some(({avatars}) => avatars.length > 0);
  return [
    lead(isSome ? 'The motion on every body, as files for animation programs. Foot slide is the ' +
      'speed of feet that should stand still: before, with copied joint rotations; after, in ' +
      'the written file.'
      : 'The motion of the subject. Use --avatar to transfer it to a character.'),
    table('Files and avatars', rows, isSome ? columns : columns.slice(0, 3)),
  ];
}

export function timingsSection({timings, summary}: ReportFigures): HTMLElement[] {
  const longest = Math.max(...timings.map(({seconds}) => seconds), 1e-9);
  return [
    lead(`${duration(summary.processing_s)} for ${duration(summary.recorded_s)} of recording: ` +
      `${fixed(summary.times_real_time, 1)} × real time. Stages that reuse results of an ` +
      'earlier run take almost no time.'),
    table('Time by stage', timings, [
      ['Stage', ({stage}) => stage],
      ['Share', ({seconds}) => bar(seconds, null, longest)],
      ['Time', ({seconds}) => `${fixed(seconds, 2)} s`, 'number'],
      ['× real time', ({seconds}) => (summary.recorded_s > 0
        ? fixed(seconds / summary.recorded_s, 2) : ''), 'number'],
    ]),
  ];
}
