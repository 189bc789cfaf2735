// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The head of the page, and the tables.

/** Common names of joints; otherwise the name of the bone that starts there. */
function jointWords(bone) {
  const words = {UpperArm: 'shoulder', LowerArm: 'elbow', Hand: 'wrist', UpperLeg: 'hip',
    LowerLeg: 'knee', Foot: 'ankle', Toes: 'ball of the foot', Shoulder: 'collarbone'};
  const found = /^(left|right)([A-Z][A-Za-z]+)$/.exec(bone);
  return found && words[found[2]] ? `${found[1]} ${words[found[2]]}` : boneWords(bone);
}

function figureCard(title, value, unit, what) {
  return el('li', {class: 'verdict'}, el('span', {class: 'title'}, title),
    el('span', {class: 'value'}, value, el('span', {class: 'unit'}, ` ${unit}`)),
    el('span', {class: 'what'}, what));
}

function headCards({kind, figures, fates, trials}) {
  const counts = fates.map((_, i) =>
    trials.reduce((sum, trial) => sum + fateCounts(trial, fates)[i], 0));
  const of = (...names) => names.reduce((sum, n) => sum + counts[fates.indexOf(n)], 0);
  const all = Math.max(counts.reduce((sum, count) => sum + count, 0), 1);
  const filled = of('cluster', 'structure', 'spline');
  const faults = trials.flatMap((t) => t.markers.flatMap((m) => m.faults));
  const swapped = faults.filter((fault) => !isRemoved(fault)).length / 2;
  const cards = [];
  if (kind === 'fit') {
    const solved = figures.trials.reduce((sum, t) => sum + t.frames_solved, 0);
    const frames = figures.trials.reduce((sum, t) => sum + t.frames_with_markers, 0);
    const worst = figures.trials.filter((t) => t.rms_mm !== null)
      .reduce((a, b) => (a && a.rms_mm >= b.rms_mm ? a : b), null);
    cards.push(
      figureCard('Off the body', worst ? fixed(worst.rms_mm, 1) : '–', 'mm',
        'RMS distance of markers from their places on the body' +
        (figures.trials.length > 1 && worst ? `, worst in ${worst.trial}` : '')),
      figureCard('Solved', fixed(100 * solved / Math.max(frames, 1), 1), '%',
        `${solved} of ${plural(frames, 'frame', 'frames')} with markers`));
  }
  cards.push(
    figureCard('Filled', percent((filled + of('predicted')) / all), '',
      `${filled} samples from the other markers` + (kind === 'fit'
        ? `, ${of('predicted')} from the skeleton` : '')),
    figureCard('Left empty', percent(of('left-empty') / all), '',
      `${plural(of('left-empty'), 'sample', 'samples')} that cannot be known`),
    figureCard('Wrong', String(faults.length - swapped), 'runs',
      `of samples: ${faults.filter(isRemoved).length} taken out, ${swapped} swapped and ` +
      'put right'));
  return el('ul', {class: 'verdicts'}, ...cards);
}

function headSection(data) {
  const {kind, figures, trials} = data;
  const isFit = kind === 'fit';
  const about = [figures.label_set ? `labels: ${figures.label_set}`
    : 'labels of no set that is known', plural(figures.labels.length, 'label', 'labels')];
  if (isFit) {
    about.unshift(`${fixed(figures.stature_m, 3)} m tall`);
    about.push(plural(trials.length, 'trial', 'trials'));
    if (figures.fit_rms_mm !== undefined) {
      about.push(`markers ${fixed(figures.fit_rms_mm, 1)} mm from the body when fitted`);
    }
  } else {
    const [trial] = figures.trials;
    about.push(`${trial.frames} frames at ${Number(trial.rate_hz.toFixed(3))} Hz`);
  }
  const warnings = [...figures.warnings, ...trials.flatMap((trial, i) =>
    trial.notes.map((note) => `${figures.trials[i].file}: ${note}`))];
  return [
    el('h1', {}, isFit ? figures.subject : figures.trials[0].file),
    el('p', {class: 'about'}, about.join(' · ')),
    ...(isFit ? [pageWords()] : []),
    headCards(data),
    ...(warnings.length === 0 ? [] : [el('div', {class: 'warnings', role: 'note'},
      el('h2', {}, plural(warnings.length, 'note', 'notes')),
      el('ul', {}, ...warnings.map((text) => el('li', {}, text))))]),
  ];
}

/** Columns may have `key(row)`, the sort key for a click on the title: numbers in
 *  descending, words in ascending order. */
function sortableTable(columns, rows, caption, first) {
  const place = el('div', {});
  const show = (chosen, downward) => {
    const {key} = columns[chosen];
    const order = [...rows].sort((a, b) => {
      const [one, other] = [key(a), key(b)];
      const way = typeof one === 'string' ? one.localeCompare(other, 'en') : other - one;
      return downward ? way : -way;
    });
    const made = table(columns, order, caption);
    made.classList.add('bounded');
    made.querySelectorAll('thead th').forEach((head, i) => {
      if (!columns[i].key) return;
      const isChosen = i === chosen;
      const mark = isChosen ? (downward ? ' ▾' : ' ▴') : '';
      head.replaceChildren(el('button', {class: 'sort', 'aria-pressed': String(isChosen),
        onclick: () => show(i, isChosen ? !downward : true)}, `${columns[i].title}${mark}`));
    });
    place.replaceChildren(made);
  };
  show(first, true);
  return place;
}

function residualsSection(player, data, trial, figure) {
  if (!trial.residuals) {
    return [el('p', {}, 'This trial was not solved: it shows too few of the body’s markers.')];
  }
  const segments = new Map(data.figures.labels.map((l) => [l.label, l.segment ?? '']));
  const widest = Math.max(...figure.by_marker.map((marker) => marker.worst_mm), 1);
  const bar = (marker) => el('div', {class: 'doubt', 'aria-hidden': 'true'},
    el('span', {class: 'median', style: `width: ${100 * marker.rms_mm / widest}%`}),
    el('span', {class: 'whisker', style: `width: ${100 * marker.worst_mm / widest}%`}));
  return [
    el('p', {class: 'lead'}, 'How far measured markers are from where the solved body has ' +
      'them: the RMS of each frame, and below of each marker, with a whisker to its worst ' +
      'frame.'),
    residualGraph(player, trial, figure),
    sortableTable([
      {title: 'Marker', cell: (m) => m.marker, key: (m) => m.marker},
      {title: 'Segment', cell: (m) => boneWords(segments.get(m.marker) ?? ''),
        key: (m) => segments.get(m.marker) ?? ''},
      {title: 'Distance', cell: bar},
      {title: 'RMS', number: true, cell: (m) => `${fixed(m.rms_mm, 1)} mm`,
        key: (m) => m.rms_mm},
      {title: 'Worst', number: true, cell: (m) => `${fixed(m.worst_mm, 1)} mm`,
        key: (m) => m.worst_mm},
      {title: 'Frames', number: true, cell: (m) => String(m.frames), key: (m) => m.frames},
    ], figure.by_marker, 'Distance of every marker from the body', 3),
  ];
}

const ORIGIN_MEANING = {
  movement: 'how markers on both sides moved about it',
  landmarks: 'where it lies from landmarks near it',
  proportions: 'an average body of this size',
  given: 'the subject that was given',
};

function jointsSection({figures, lengths}) {
  const evidence = new Map(figures.joints.map((joint) => [joint.joint, joint]));
  const rows = lengths.map((length) => ({...length,
    ...(evidence.get(length.joint) ?? {origin: 'given', range_deg: null})}));
  const origins = [...new Set(rows.map((row) => row.origin))];
  return [
    el('p', {class: 'lead'}, 'What each joint centre was found from, how sure its place in ' +
      'the segment before it is (sigma per coordinate), through what angle it was turned ' +
      'in all trials, and how far it is from the joint before it.'),
    el('ul', {class: 'legend'}, ...origins.map((origin) => el('li', {}, el('span',
      {class: `chip origin-${origin}`}, `${origin}: ${ORIGIN_MEANING[origin] ?? ''}`)))),
    table([
      {title: 'Joint', cell: (row) => jointWords(row.joint)},
      {title: 'Found from', cell: (row) =>
        el('span', {class: `chip origin-${row.origin}`}, row.origin)},
      {title: 'Sigma', number: true, cell: (row) => `${fixed(row.sigma_mm, 1)} mm`},
      {title: 'Range', number: true, cell: (row) =>
        (row.range_deg === null ? '' : `${fixed(row.range_deg, 0)}°`)},
      {title: 'Length', number: true, cell: (row) => `${fixed(row.length_mm / 10, 1)} cm`},
      {title: 'from', cell: (row) => jointWords(row.from)},
    ], rows, 'What joint centres were found from'),
  ];
}

const USE_MEANING = {
  named: 'used as what it is called',
  found: 'its name says nothing; placed where it moves',
  moved: 'moves with another segment than it is called after',
  given: 'as in the subject that was given',
  'left-out': 'not used',
};

function labelsSection({kind, figures, trials}) {
  const isFit = kind === 'fit';
  const all = figures.trials.reduce((sum, trial) => sum + trial.frames, 0);
  const landmark = (label) => (label.landmark ? label.landmark.replaceAll('_', ' ') : '–');
  const millimetres = (value) => (value === undefined ? '' : `${fixed(value, 1)} mm`);
  const columns = [
    {title: 'Label', cell: (label) => label.label, key: (label) => label.label},
    {title: 'Taken for', cell: landmark, key: landmark},
    {title: 'Seen', number: true, cell: (label) => percent(label.samples / Math.max(all, 1)),
      key: (label) => label.samples},
  ];
  if (isFit) {
    columns.splice(2, 0,
      {title: 'Became', key: (label) => label.use, cell: (label) => el('span',
        {class: `use-${label.use}`, title: USE_MEANING[label.use]},
        label.why ? `${label.use}: it ${label.why}` : label.use)},
      {title: 'Segment', cell: (label) => boneWords(label.segment ?? ''),
        key: (label) => label.segment ?? ''},
      {title: 'Place', number: true, cell: (label) =>
        (label.sigma_mm === undefined ? '' : `± ${fixed(label.sigma_mm, 1)} mm`),
      key: (label) => label.sigma_mm ?? -1},
      {title: 'Strays', number: true, cell: (label) => millimetres(label.stray_mm),
        key: (label) => label.stray_mm ?? -1});
  }
  const prefix = figures.prefix ? `, all behind “${figures.prefix}”` : '';
  const set = figures.label_set ? `The labels are ${figures.label_set}${prefix}. `
    : 'The labels are of no set that is known. ';
  return [
    el('p', {class: 'lead'}, set + (isFit
      ? 'What each was taken for and what became of it; how sure its place on the segment ' +
        'is, and how far it strays from there with skin and noise. Seen is the share of ' +
        `the frames of ${trials.length > 1 ? 'all trials' : 'the trial'}.`
      : 'What each seems to say.')),
    sortableTable(columns, figures.labels, 'Labels', 0),
  ];
}
