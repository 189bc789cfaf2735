// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The sections with tables.

/** Upper limits of good and of fair values. */
const GRADES = {
  unsolved_percent: [2, 10], calibration_px: [0.5, 1.0], solve_px: [1.0, 2.0],
  sigma_mm: [10, 20], worst_camera_px: [2.0, 4.0], worst_frame_px: [6.0, 12.0],
  worst_sigma_mm: [20, 40],
};

const WORDS = ['good', 'fair', 'look closer'];

function grade(kind, value) {
  const [good, fair] = GRADES[kind];
  if (value <= good) return {word: 'good', mark: '●'};
  return value <= fair ? {word: 'fair', mark: '◐'} : {word: 'look closer', mark: '○'};
}

/** Returns the worst of several grades, because a good mean may hide a poor part. */
function worstGrade(...grades) {
  return grades.reduce((a, b) => (WORDS.indexOf(b.word) > WORDS.indexOf(a.word) ? b : a));
}

/** Returns the grade of summary.worst[kind] and the name of its owner. */
function worstOf(worst, kind, gradeKind) {
  const found = worst[kind];
  return found === null ? grade(gradeKind, 0) : grade(gradeKind, found.value);
}

function named(worst, kind, unit, digits) {
  const found = worst[kind];
  if (found === null) return '';
  return `; worst ${kind} ${found.name} (${found.trial}): ` +
    `${fixed(found.value, digits)} ${unit}`;
}

/** Results that the program rates as unreliable have no good figure. */
function trust(summary) {
  const reasons = summary.poor.length;
  return reasons === 0 ? {word: 'good', mark: '●'} : {word: 'look closer', mark: '○'};
}

function trustVerdict(summary) {
  const reasons = summary.poor.length;
  const {word, mark} = trust(summary);
  return el('li', {class: `verdict grade-${word.replace(' ', '-')}`},
    el('span', {class: 'title'}, 'Trust'),
    el('span', {class: 'value'}, reasons === 0 ? 'yes' : 'no'),
    el('span', {class: 'grade'}, el('span', {'aria-hidden': 'true'}, `${mark} `), word),
    el('span', {class: 'what'}, reasons === 0 ? 'no check speaks against these results'
      : `${plural(reasons, 'reason', 'reasons')} not to: ${summary.poor[0]}`));
}

function verdict(title, value, unit, what, {word, mark}, kind) {
  const [good, fair] = GRADES[kind];
  const scale = kind === 'unsolved_percent'
    ? `good from ${100 - good} %, fair from ${100 - fair} %`
    : `good up to ${good} ${unit}, fair up to ${fair} ${unit}`;
  return el('li', {class: `verdict grade-${word.replace(' ', '-')}`, title: scale},
    el('span', {class: 'title'}, title),
    el('span', {class: 'value'}, value, el('span', {class: 'unit'}, ` ${unit}`)),
    el('span', {class: 'grade'}, el('span', {'aria-hidden': 'true'}, `${mark} `), word),
    el('span', {class: 'what'}, what));
}

function verdicts(summary) {
  const unsolved = 100 - summary.solved_percent;
  const {worst} = summary;
  return el('ul', {class: 'verdicts'},
    trustVerdict(summary),
    verdict('Solved', fixed(summary.solved_percent, 1), '%',
      `${summary.frames_solved} of ${plural(summary.frames, 'frame', 'frames')}`,
      grade('unsolved_percent', unsolved), 'unsolved_percent'),
    verdict('Cameras', fixed(summary.calibration_rms_px, 2), 'px',
      'how far the board is from where the cameras expect it',
      grade('calibration_px', summary.calibration_rms_px), 'calibration_px'),
    verdict('Motion', fixed(summary.solve_rms_px, 2), 'px',
      'how far tags are from where the solved body has them' +
        named(worst, 'camera', 'px', 2) + named(worst, 'frame', 'px', 2),
      worstGrade(trust(summary), grade('solve_px', summary.solve_rms_px),
        worstOf(worst, 'camera', 'worst_camera_px'),
        worstOf(worst, 'frame', 'worst_frame_px')), 'solve_px'),
    verdict('Joints', `± ${fixed(summary.joint_sigma_median_mm, 1)}`, 'mm',
      'typical uncertainty (sigma) of a joint centre in a frame' +
        named(worst, 'joint', 'mm', 1),
      worstGrade(trust(summary), grade('sigma_mm', summary.joint_sigma_median_mm),
        worstOf(worst, 'joint', 'worst_sigma_mm')), 'sigma_mm'));
}

function headSection({summary, warnings, session, trials}) {
  const avatars = new Set(trials.flatMap((t) => t.avatars.map((avatar) => avatar.name)));
  const parts = [plural(summary.trials, 'trial', 'trials'),
    `${duration(summary.recorded_s)} recorded`,
    ...(avatars.size > 0 ? [plural(avatars.size, 'avatar', 'avatars')] : []),
    `${duration(summary.processing_s)} to process`];
  return [
    el('h1', {}, session || 'Session'),
    el('p', {class: 'about'}, parts.join(' · ')),
    pageWords(),
    verdicts(summary),
    ...(warnings.length === 0 ? [] : [el('div', {class: 'warnings', role: 'note'},
      el('h2', {}, plural(warnings.length, 'warning', 'warnings')),
      el('ul', {}, ...warnings.map((text) => el('li', {}, text))))]),
  ];
}

/** Returns the place of the highest residual. */
function worstFrame(trial, {name, first_frame: first}) {
  const worst = trial.frame_rms_px.reduce((best, value, i, all) =>
    (value > all[best] ? i : best), 0);
  if (trial.frame_rms_px.length === 0) return null;
  const words = `frame ${worst + first}, ${fixed(trial.frame_rms_px[worst], 2)} px`;
  return el('span', {}, 'The worst is ', pageLink(name, worst + first, words) ?? words, '.');
}

function reprojectionSection(player, trial, figures) {
  return [
    el('p', {class: 'lead'}, 'The distance between where a camera saw the corners of the ' +
      'tags and where the solved motion puts them. Steady is good; a hump marks moments ' +
      'to look at. Click to see them in the viewer. ', worstFrame(trial, figures)),
    lineGraph(player, trial.frame_rms_px, {unit: 'px', level: figures.rms_px,
      levelName: 'RMS', firstFrame: figures.first_frame,
      name: 'Reprojection of every frame'}),
    table([
      {title: 'Camera', cell: (camera) => camera.name},
      {title: 'RMS', number: true, cell: (camera) => `${fixed(camera.rms_px, 2)} px`},
      {title: 'Median', number: true, cell: (camera) => `${fixed(camera.median_px, 2)} px`},
      {title: 'Corners', number: true, cell: (camera) => String(camera.corners)},
      {title: 'Time offset', number: true, cell: (camera) =>
        `${camera.offset_ms > 0 ? '+' : ''}${fixed(camera.offset_ms, 1)} ms`},
      {title: 'Offset is', cell: (camera) => camera.clock},
    ], figures.cameras, 'Reprojection and time offset per camera'),
  ];
}

/** Draws the median as a bar and 95 % as a whisker, on a common scale. */
function doubtBar(joint, highest) {
  const share = (value) => `${Math.min(100, 100 * value / highest)}%`;
  return el('div', {class: 'doubt', 'aria-hidden': 'true'},
    el('span', {class: 'whisker', style: `width: ${share(joint.p95_sigma_mm)}`}),
    el('span', {class: 'median', style: `width: ${share(joint.median_sigma_mm)}`}));
}

function sourceBar(joint) {
  return el('div', {class: 'shares', title: SOURCES.map((source) =>
    `${source} ${fixed(joint[`${source}_percent`], 1)} %`).join(', ')},
  ...SOURCES.map((source) => el('span', {class: `fill-${source}`,
    style: `width: ${joint[`${source}_percent`]}%`})));
}

function jointsSection(figures) {
  if (figures.joints.length === 0) return [el('p', {}, 'No joints were solved.')];
  const highest = Math.max(...figures.joints.map((joint) => joint.p95_sigma_mm), 1);
  return [
    el('p', {class: 'lead'}, 'How well each joint centre is known, by the solver’s own ' +
      'reckoning: half of the frames have a smaller sigma than the bar, 95 % a smaller ' +
      `one than the whisker. The widest ends at ${fixed(highest, 0)}\u00a0mm.`),
    el('div', {class: 'row'}, sourceLegend(false)),
    table([
      {title: 'Joint', cell: (joint) => boneWords(joint.joint)},
      {title: 'Sigma', cell: (joint) => doubtBar(joint, highest)},
      {title: 'Median', number: true, cell: (joint) => `${fixed(joint.median_sigma_mm, 1)} mm`},
      {title: '95 %', number: true, cell: (joint) => `${fixed(joint.p95_sigma_mm, 1)} mm`},
      {title: 'Seen', cell: sourceBar},
    ], figures.joints, 'Doubt of every joint centre'),
  ];
}

/** Puts left and right of the same bone in one row. */
function pairBones(bones) {
  const rows = [];
  for (const bone of bones) {
    if (bone.to.startsWith('right')) continue;
    const mirrored = bones.find((other) => bone.to.startsWith('left') &&
      other.to === bone.to.replace('left', 'right'));
    const bare = (name) => boneWords(name).replace(/^left /, '');
    rows.push({words: `${bare(bone.from)} – ${bare(bone.to)}`, one: bone, other: mirrored});
  }
  return rows;
}

function subjectSection(subject, unplaced) {
  const length = (bone) => (bone
    ? `${fixed(bone.length_mm / 10, 1)} cm ± ${fixed(bone.sigma_mm, 1)} mm` : '');
  const about = [`stature ${fixed(subject.stature_m, 2)} m`,
    ...(subject.mass_kg === null ? [] : [`${fixed(subject.mass_kg, 0)} kg`]),
    ...(subject.limb_ratio > 0 ? [`limbs ${fixed(subject.limb_ratio, 2)} × the average ` +
      'person’s of that stature'] : []),
    `fit ${fixed(subject.rms_px, 2)} px`];
  return [
    el('p', {class: 'lead'}, `${subject.name || 'The subject'}: ${about.join(', ')}.`),
    table([
      {title: 'From joint to joint', cell: (row) => row.words},
      {title: 'Left or middle', number: true, cell: (row) => length(row.one)},
      {title: 'Right', number: true, cell: (row) => length(row.other)},
    ], pairBones(subject.bones), 'Lengths of the subject'),
    el('h3', {}, 'Tags on the body'),
    el('p', {class: 'lead'}, `${plural(subject.tags.length, 'tag is', 'tags are')} placed` +
      (unplaced.length === 0 ? '.'
        : `; not placed, for want of sightings: ${unplaced.join(', ')}.`)),
    el('details', {}, el('summary', {}, 'All tags as a table'), tagTable(subject.tags)),
  ];
}

function tagTable(tags) {
  return table([
    {title: 'Tag', cell: (tag) => String(tag.id)},
    {title: 'Segment', cell: (tag) => boneWords(tag.segment)},
    {title: 'Edge', number: true, cell: (tag) => `${fixed(tag.size_mm, 1)} mm`},
    {title: 'Place', number: true, cell: (tag) => `± ${fixed(tag.sigma_mm, 1)} mm`},
    {title: 'Tilt', number: true, cell: (tag) => `± ${fixed(tag.sigma_deg, 2)}°`},
    {title: 'Sightings', number: true, cell: (tag) => String(tag.sightings)},
  ], tags, 'Tags of the subject');
}

function avatarsSection(trials) {
  const rows = trials.flatMap((trial) => [
    {trial: trial.name, name: 'subject', files: trial.files},
    ...trial.avatars.map((avatar) => ({trial: trial.name, ...avatar}))]);
  const speed = (value) => (value === undefined ? '' : `${fixed(value, 2)} cm/s`);
  const files = (row) => {
    const links = row.files.flatMap((file) => [fileLink(file), ' ']);
    return el('span', {class: 'files'}, ...links);
  };
  const columns = [
    {title: 'Trial', cell: (row) => row.trial},
    {title: 'Body', cell: (row) => row.name},
    {title: 'Files', cell: files},
    {title: 'Foot slide before', number: true, cell: (row) => speed(row.slide_before_cm_per_s)},
    {title: 'after', number: true, cell: (row) => speed(row.slide_after_cm_per_s)},
    {title: 'Into the floor', number: true, cell: (row) =>
      (row.penetration_mm === undefined ? '' : `${fixed(row.penetration_mm, 1)} mm`)},
  ];
  const some = trials.some((trial) => trial.avatars.length > 0);
  return [
    el('p', {class: 'lead'}, some
      ? 'The motion on every body, ready for an animation program. Foot slide is how fast ' +
        'planted feet still move: before, with the joint rotations copied; after, as written.'
      : 'The subject’s own motion. Give --avatar to put it on a character.'),
    table(some ? columns : columns.slice(0, 3), rows, 'Files and avatars'),
  ];
}

function timingsSection({timings, summary}) {
  const longest = Math.max(...timings.map((timing) => timing.seconds), 1e-9);
  return [
    el('p', {class: 'lead'}, `${duration(summary.processing_s)} for ` +
      `${duration(summary.recorded_s)} of recording: ` +
      `${fixed(summary.times_real_time, 1)} × real time. What was kept from an earlier run ` +
      'takes next to none.'),
    table([
      {title: 'Stage', cell: (timing) => timing.stage},
      {title: 'Share', cell: (timing) => el('div', {class: 'doubt', 'aria-hidden': 'true'},
        el('span', {class: 'median', style: `width: ${100 * timing.seconds / longest}%`}))},
      {title: 'Time', number: true, cell: (timing) => `${fixed(timing.seconds, 2)} s`},
      {title: '× real time', number: true, cell: (timing) => (summary.recorded_s > 0
        ? fixed(timing.seconds / summary.recorded_s, 2) : '')},
    ], timings, 'Time by stage'),
  ];
}
