// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The verdict on a calibration, the recommended steps, and its tables.

/** `limits` as in calibration.json: the bounds of good and of usable values. */
function gradeCard(limits, value) {
  if (value === null) return {word: 'look closer', mark: '○'};
  const [good, fair] = limits;
  const reaches = (limit) => (good < fair ? value <= limit : value >= limit);
  if (reaches(good)) return {word: 'good', mark: '●'};
  return reaches(fair) ? {word: 'fair', mark: '◐'} : {word: 'look closer', mark: '○'};
}

/** A value without limits has no grade. */
function card(title, limits, value, text, unit, what) {
  const {word, mark} = limits ? gradeCard(limits, value) : {word: '', mark: ''};
  const [good, fair] = limits ?? [0, 0];
  const way = good < fair ? 'up to' : 'from';
  return el('li', {class: `verdict grade-${word.replace(' ', '-')}`,
    title: limits && `good ${way} ${good} ${unit}, can be used ${way} ${fair} ${unit}`},
  el('span', {class: 'title'}, title),
  el('span', {class: 'value'}, text, el('span', {class: 'unit'}, ` ${unit}`)),
  limits && el('span', {class: 'grade'}, el('span', {'aria-hidden': 'true'}, `${mark} `),
    word),
  el('span', {class: 'what'}, what));
}

function cards(figures) {
  const worst = (key, better) => figures.cameras.reduce((a, b) =>
    ((better(b[key], a[key])) ? a : b));
  const loose = worst('centre_sigma_mm', (b, a) => b <= a);
  const narrow = worst('coverage_percent', (b, a) => b >= a);
  const rough = worst('inlier_rms_px', (b, a) => b <= a);
  const middle = figures.middle_error_mm;
  const {limits} = figures;
  return el('ul', {class: 'verdicts'},
    card('Points', limits.error_mm, middle, middle === null ? '–' : fixed(middle, 1), 'mm',
      'expected error of a point in the middle of the volume, at its worst height'),
    card('Corners', limits.residual_px, figures.inlier_rms_px, fixed(figures.inlier_rms_px, 2), 'px',
      'how far corners are from where the cameras expect them; worst in ' +
      `${rough.name}: ${fixed(rough.inlier_rms_px, 2)}`),
    card('Least sure place', null, loose.centre_sigma_mm,
      `± ${fixed(loose.centre_sigma_mm, 1)}`, 'mm', `sigma of where ${loose.name} stands`),
    card('Least coverage', limits.coverage_percent, narrow.coverage_percent,
      fixed(narrow.coverage_percent, 0), '%',
      `share of ${narrow.name}’s picture in which it was shown`));
}

function judgement({verdict, middle_error_mm: error, findings}) {
  const counted = (count, one, many) => (count === 1 ? one : `${count} ${many}`);
  const poor = findings.filter((finding) => finding.severity === 'poor').length;
  const fair = findings.filter((finding) => finding.severity === 'fair').length;
  const stands = error === null ? 'No two cameras see the middle of the volume.'
    : `A point in the middle of the volume will stand about ${fixed(error, 1)} mm from the ` +
      'truth.';
  if (verdict === 'good') return `Good: these cameras can be used. ${stands}`;
  if (verdict === 'fair') {
    return `Fair: these cameras can be used, and ${counted(fair, 'one thing', 'things')} ` +
      `below would make them better. ${stands}`;
  }
  return `Look closer: do not use these cameras before ${counted(poor, 'one thing is',
    'things are')} put right. ${stands}`;
}

const SEVERITY = {poor: '○ put right', fair: '◐ could be better', note: 'note'};

function findingItem({severity, where, cause, next}) {
  const text = cause[0].toUpperCase() + cause.slice(1);
  return el('li', {class: `finding severity-${severity}`},
    el('span', {class: 'mark'}, SEVERITY[severity]),
    el('p', {}, el('span', {class: 'where'}, where[0].toUpperCase() + where.slice(1)), '. ',
      el('span', {}, `${text}.`)),
    el('p', {class: 'next'}, el('b', {}, 'Do: '), `${next}.`));
}

function headSection(figures) {
  const {findings, cameras} = figures;
  return [
    el('h1', {}, `Cameras of ${figures.session || 'the session'}`),
    el('p', {class: 'about'}, [plural(cameras.length, 'camera', 'cameras'), figures.target,
      `${plural(figures.sightings, 'sighting', 'sightings')}, ` +
      `${figures.outliers} left out`].join(' · ')),
    el('p', {class: 'judgement'}, judgement(figures)),
    cards(figures),
    el('h2', {}, 'What to record again, and why'),
    findings.length === 0
      ? el('p', {}, 'Nothing: coverage, tilt, views in common and errors are as they ' +
          'should be.')
      : el('ul', {class: 'findings'}, ...findings.map(findingItem)),
  ];
}

function togetherSection(figures) {
  const shared = figures.shared_views;
  const enough = figures.limits.shared_instants;
  if (shared.length === 0) return [el('p', {}, 'No data.')];
  const rows = figures.cameras.map((camera, i) => ({camera, i}));
  // Opposite cameras may share no view, but every camera must be connected to the rest.
  const best = (i) => Math.max(...shared[i].filter((_, k) => k !== i));
  const cell = (i, k) => el('span', {class: i === k ? 'own'
    : best(i) < enough || best(k) < enough ? 'weak' : null}, String(shared[i][k]));
  const made = table([
    {title: 'Camera', cell: ({camera}) => camera.name},
    ...figures.cameras.map((camera, k) => ({title: camera.name, number: true,
      cell: ({i}) => cell(i, k)})),
  ], rows, `Instants at which two cameras saw the ${shownTarget(figures)} together`);
  made.classList.add('matrix');
  return [
    el('p', {class: 'lead'}, 'At how many instants two cameras saw it together: these hold ' +
      'the cameras to each other. Two that never share a view are joined through others, ' +
      'which is less sure.'),
    made,
  ];
}

/** The estimated clocks. */
function clocksPart({cameras}) {
  const of = (camera, name) => camera.parameters.find((p) => p.name === name);
  if (!cameras.some((camera) => of(camera, 'offset'))) return [];
  const cell = (name, unit, decimals) => (camera) => {
    const found = of(camera, name);
    if (!found) return '';
    return found.sigma > 0
      ? `${fixed(found.value, decimals)} ± ${fixed(found.sigma, decimals)} ${unit}` : 'held';
  };
  return [
    el('h3', {}, 'Clocks'),
    el('p', {class: 'lead'}, 'By how much each camera’s frames were taken later than the ' +
      'first camera’s of the same number, how fast its clock runs away, and how long it ' +
      'takes from one row of the picture to the next.'),
    table([
      {title: 'Camera', cell: (camera) => camera.name},
      {title: 'Offset', number: true, cell: cell('offset', 'ms', 2)},
      {title: 'Drift', number: true, cell: cell('drift', 'ppm', 1)},
      {title: 'Row to row', number: true, cell: cell('line_delay', 'µs', 1)},
    ], cameras, 'Clocks of the cameras'),
  ];
}

function checksSection(figures) {
  const check = figures.cross_validation;
  const target = shownTarget(figures);
  const out = [];
  if (check === null) {
    out.push(el('p', {class: 'lead'}, 'The calibration was not checked against frames that ' +
      'it did not use.'));
  } else {
    out.push(el('p', {class: 'lead'}, `Calibrated from the even frames alone, the cameras ` +
      `are ${fixed(check.seen_rms_px, 2)} px off in these and ` +
      `${fixed(check.held_out_rms_px, 2)} px in the odd ones, which were not used: the ` +
      'closer the better. Below, how far even and odd frames put each camera apart, and ' +
      `how far off it is when the others alone say where the ${target} was.`),
    table([
      {title: 'Camera', cell: (camera) => camera.name},
      {title: 'Place apart', number: true, cell: (c) => `${fixed(c.centre_apart_mm, 1)} mm`},
      {title: 'Turned apart', number: true, cell: (c) => `${fixed(c.turn_apart_deg, 3)}°`},
      {title: 'Focal length apart', number: true, cell: (c) =>
        `${fixed(c.focal_apart_px, 1)} px`},
      {title: 'Held out (median)', number: true, cell: (c) =>
        (c.held_out_median_px === null ? '–' : `${fixed(c.held_out_median_px, 2)} px`)},
    ], check.cameras, 'Cross-validation'));
  }
  const lags = figures.cameras.filter((camera) => camera.clock_lag !== null);
  const slow = lags.filter(({clock_lag: lag}) => lag.explained_px > 0.05);
  if (lags.length > 0 && slow.length === 0) {
    out.push(el('p', {}, 'All cameras started together: their errors do not follow the ' +
      `${target}’s movement.`));
  } else if (lags.length > 0) {
    out.push(el('h3', {}, 'Whether all started together'),
      el('p', {class: 'lead'}, `Errors that follow the ${target}’s movement show a camera that ` +
        `is late (positive) or early against the others. Since the ${target}’s place is found ` +
        'from all of them, the true figure is larger.'),
      table([
        {title: 'Camera', cell: (camera) => camera.name},
        {title: 'Late by', number: true, cell: ({clock_lag: lag}) =>
          `${fixed(lag.lag_ms, 2)} ± ${fixed(lag.sigma_ms, 2)} ms`},
        {title: 'Accounts for', number: true, cell: ({clock_lag: lag}) =>
          `${fixed(lag.explained_px, 2)} px`},
      ], lags, 'Lag of every camera'));
  }
  out.push(...clocksPart(figures));
  if (figures.warp_mm !== null) {
    const [x, y, twist] = figures.warp_mm;
    out.push(el('p', {}, `The board is bent: its edges rise by ${fixed(x, 2)} mm along x and ` +
      `${fixed(y, 2)} mm along y, and it is twisted by ${fixed(twist, 2)} mm. This was ` +
      'taken into account.'));
  }
  return out;
}

const PARAMETER_WORDS = {
  focal_x: 'Focal length x', focal_y: 'Focal length y', centre_x: 'Picture centre x',
  centre_y: 'Picture centre y', rotation_x: 'Rotation vector x',
  rotation_y: 'Rotation vector y', rotation_z: 'Rotation vector z', x: 'Place x',
  y: 'Place y', z: 'Place z', offset: 'Clock offset', drift: 'Clock drift',
  line_delay: 'Delay from row to row',
};
const UNIT_WORDS = {deg: '°', us: 'µs'};

function parametersSection(figures) {
  const names = [...new Set(figures.cameras.flatMap((camera) =>
    camera.parameters.map((parameter) => parameter.name)))];
  const units = new Map(figures.cameras.flatMap((camera) =>
    camera.parameters.map((parameter) => [parameter.name, parameter.unit])));
  /** Rounds a value to the second digit of its sigma. */
  const text = (value, sigma) => fixed(value, sigma > 0
    ? Math.min(Math.max(Math.ceil(1 - Math.log10(sigma)), 0), 9) : 4);
  const cell = (camera, name) => {
    const parameter = camera.parameters.find((p) => p.name === name);
    if (!parameter) return '';
    const {value, sigma} = parameter;
    return el('span', {}, text(value, sigma), el('span', {class: 'sigma'},
      sigma > 0 ? ` ± ${text(sigma, sigma)}` : ' (held)'));
  };
  const unit = (name) => (units.get(name) === '' ? ''
    : ` [${UNIT_WORDS[units.get(name)] ?? units.get(name)}]`);
  return [
    el('p', {class: 'lead'}, 'Every number that was found, with its standard deviation. ' +
      `These are ${fixed(figures.sigma_factor, 1)} times as large as independent corners ` +
      'with the stated errors of their detector would give.'),
    table([
      {title: 'Parameter', cell: (name) => `${PARAMETER_WORDS[name] ?? name}${unit(name)}`},
      ...figures.cameras.map((camera) => ({title: camera.name, number: true,
        cell: (name) => cell(camera, name)})),
    ], names, 'Parameters of every camera'),
  ];
}

const MAX_OUTLIER_ROWS = 15;

function outliersSection(figures) {
  const frames = figures.outlier_frames;
  if (frames.length === 0) {
    return [el('p', {class: 'lead'}, 'All sightings agree: none was left out.')];
  }
  const made = (rows) => table([
    {title: 'Camera', cell: (row) => row.camera},
    {title: 'Frame', number: true, cell: (row) =>
      (row.frame !== null ? String(row.frame)
        : shownTarget(figures) === 'wand' ? 'scenery' : 'floor')},
    {title: 'Left out', number: true, cell: (row) => `${row.left_out} of ${row.of}`},
    {title: 'Median error', number: true, cell: (row) => `${fixed(row.median_error_px, 1)} px`},
  ], rows, 'Frames with outliers');
  const rest = frames.slice(MAX_OUTLIER_ROWS);
  return [
    el('p', {class: 'lead'}, `${figures.outliers} of ${figures.sightings} sightings do not ` +
      'agree with the rest and were left out, in the frames below, the worst first. A hand, ' +
      'blur or a mirror explains single ones; a camera that fills the list was moved or is ' +
      'out of step.'),
    made(frames.slice(0, MAX_OUTLIER_ROWS)),
    rest.length === 0 ? null
      : el('details', {}, el('summary', {}, `${plural(rest.length, 'more', 'more')}`),
        made(rest)),
  ];
}
