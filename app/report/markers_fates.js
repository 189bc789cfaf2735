// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Classification of every sample: one row per marker, time along x.

const FATE_MEANING = {
  'measured': 'as read from the file',
  'swapped': 'measured under another marker’s name; put right',
  'cluster': 'filled: carried along by the markers that it moves with most stiffly',
  'structure': 'filled: and by how this trial’s markers move together',
  'spline': 'filled: on its own path from before to after',
  'predicted': 'filled: from its place on the solved skeleton',
  'left-empty': 'not known',
};
const FAULT_MEANING = 'what was read there was wrong (ghost, jump, frozen, no number) and ' +
  'was taken out; filled or not, as the colour below says';
const FATE_ROW_PX = 14;
const REMOVED_PX = 4;

const percent = (share) => {
  const value = 100 * share;
  // 100 % is shown only for all, and 0 % only for none.
  if (value > 99.9 && share < 1) return '> 99.9\u00a0%';
  if (value < 0.1 && share > 0) return '< 0.1\u00a0%';
  return `${fixed(value, value === 0 || value === 100 ? 0 : 1)}\u00a0%`;
};

const isRemoved = ([, , fault]) => fault !== 'swapped';

/** Returns first and last frame in the recording's numbering. */
function frameWords(trial, first, frames) {
  const from = first + trial.first_frame;
  return frames === 1 ? `frame ${from}` : `frames ${from} – ${from + frames - 1}`;
}

/** Totals of all markers. */
function fateCounts(trial, fates) {
  return fates.map((_, i) => trial.markers.reduce((sum, m) => sum + m.counts[i], 0));
}

function fateLegend(trial, fates) {
  const counts = fateCounts(trial, fates);
  const all = counts.reduce((sum, count) => sum + count, 0);
  const swatch = (name) => el('span', {class: `swatch ${name}`,
    style: `background: var(--fate-${name})`});
  const wrong = trial.markers.flatMap((m) => m.faults).filter(isRemoved);
  const removed = wrong.reduce((sum, [, frames]) => sum + frames, 0);
  return el('ul', {class: 'legend fate-legend'},
    ...fates.map((fate, i) => (counts[i] === 0 ? null : el('li',
      {title: `${FATE_MEANING[fate]}: ${plural(counts[i], 'sample', 'samples')}`},
      swatch(fate), ' ', el('b', {}, fate), ` ${percent(counts[i] / Math.max(all, 1))}`))),
    removed === 0 ? null : el('li', {title: FAULT_MEANING}, swatch('removed'), ' ',
      el('b', {}, 'taken out'), ` ${plural(removed, 'sample', 'samples')}`));
}

function runWords(trial, figure, fates, [first, frames, fate, median, worst, carriers]) {
  const parts = [`${fates[fate]}, ${frameWords(trial, first, frames)} ` +
    `(${duration(frames / figure.rate_hz)})`];
  if (median !== undefined) {
    parts.push(`sigma ${fixed(median, 1)} mm` +
      (worst > median ? `, at most ${fixed(worst, 1)} mm` : ''));
  }
  if (carriers && carriers.length > 0) {
    parts.push(`by ${carriers.map((m) => trial.markers[m].label).join(', ')}`);
  }
  return parts.join('; ');
}

function faultWords(trial, [first, frames, fault, off, other]) {
  const whom = other === undefined ? '' : ` with ${trial.markers[other].label}`;
  return `${fault}${whom}, ${frameWords(trial, first, frames)}` +
    (off > 0 ? `, ${fixed(off, 0)} mm off` : '');
}

const covers = (frame) => ([first, frames]) => frame >= first && frame < first + frames;

function paintFates(context, width, rows, fates, frames) {
  const colours = fates.map((fate) => cssColour(`fate-${fate}`));
  const [quiet, removed] = [cssColour('quiet'), cssColour('fate-removed')];
  const cell = width / frames;
  rows.forEach(({marker}, i) => {
    const top = i * FATE_ROW_PX;
    const bar = (first, count, least, y, height) =>
      context.fillRect(first * cell, y, Math.max(count * cell, least), height);
    context.fillStyle = colours[0];
    context.fillRect(0, top, width, FATE_ROW_PX - 2);
    for (const [first, count, fate] of marker.runs) {
      context.fillStyle = colours[fate];
      bar(first, count, 1.5, top, FATE_ROW_PX - 2);
      if (fates[fate] !== 'left-empty') continue;
      context.fillStyle = quiet;
      bar(first, count, 1.5, top + FATE_ROW_PX / 2 - 1.5, 1);
    }
    context.fillStyle = removed;
    for (const [first, count] of marker.faults.filter(isRemoved)) {
      bar(first, count, 2, top, REMOVED_PX);
    }
  });
}

function fateGraph(player, trial, figure, fates, rows) {
  const height = Math.max(rows.length * FATE_ROW_PX, 1);
  const canvas = paintedCanvas(height,
    (context, width) => paintFates(context, width, rows, fates, player.frames),
    {role: 'img', 'aria-label': 'Rows are markers, columns are frames, colours say what ' +
      'each sample is'});
  const readout = (frame, event) => {
    const y = event.clientY - canvas.getBoundingClientRect().top;
    const row = rows[Math.floor(y / FATE_ROW_PX)];
    if (!row) return '';
    canvas.parentElement.style.setProperty('--note-top',
      `${Math.floor(y / FATE_ROW_PX) * FATE_ROW_PX}px`);
    const {marker} = row;
    const run = marker.runs.find(covers(frame));
    const words = run ? [runWords(trial, figure, fates, run)]
      : [`measured, frame ${frame + trial.first_frame}`];
    words.push(...marker.faults.filter(covers(frame)).map((f) => faultWords(trial, f)));
    return `${marker.label}: ${words.join('; read: ')}`;
  };
  const labels = rows.flatMap(({marker}, i) => {
    const top = `top: ${i * FATE_ROW_PX}px`;
    const all = marker.counts.reduce((sum, count) => sum + count, 0);
    const measured = marker.counts[0] + marker.counts[1];
    return [el('span', {style: top, class: 'name', title: marker.label}, marker.label),
      el('span', {style: top, title: 'measured'}, percent(measured / Math.max(all, 1)))];
  });
  return el('div', {class: 'graph fates'},
    el('div', {class: 'gutter', style: `height: ${height}px`}, ...labels),
    overFrames(player, canvas, readout),
    el('div', {class: 'gutter'}), frameAxis(player, trial.first_frame));
}

const MAX_ROWS = 300;

function repairTable(trial, figure, fates) {
  const rows = trial.markers.flatMap((marker) => [
    ...marker.runs.filter(([, , fate]) => fates[fate] !== 'swapped')
      .map((run) => ({marker, run, what: fates[run[2]]})),
    ...marker.faults.map((run) => ({marker, run, what: run[2], isFault: true}))]);
  rows.sort((a, b) => b.run[1] - a.run[1]);
  const sigma = ({run, isFault}, i) =>
    (isFault || run[i] === undefined ? '' : `${fixed(run[i], 1)} mm`);
  const names = ({run: [, , , off, worst, carriers], isFault}) => (isFault
    ? (worst === undefined ? '' : `with ${trial.markers[worst].label}, `) +
      (off > 0 ? `${fixed(off, 0)} mm off` : '')
    : (carriers ?? []).map((m) => trial.markers[m].label).join(', '));
  const made = table([
    {title: 'Marker', cell: (row) => row.marker.label},
    {title: 'Frames', number: true, cell: ({run: [first, frames]}) =>
      frameWords(trial, first, frames).replace(/^frames? /, '')},
    {title: 'Length', number: true, cell: ({run}) => `${fixed(run[1] / figure.rate_hz, 3)} s`},
    {title: 'What', cell: (row) => el('span', {class: 'chip', style:
      `border-color: var(--fate-${row.isFault && row.what !== 'swapped'
        ? 'removed' : row.what})`}, row.what)},
    {title: 'Sigma', number: true, cell: (row) => sigma(row, 3)},
    {title: 'at most', number: true, cell: (row) => sigma(row, 4)},
    {title: 'By, or how wrong', cell: names},
  ], rows.slice(0, MAX_ROWS), 'Gaps and wrong samples, the longest first');
  made.classList.add('bounded');
  const more = rows.length - MAX_ROWS;
  return el('details', {}, el('summary', {},
    `${plural(rows.length, 'gap or run', 'gaps and runs')} of wrong samples as a table`),
  made, more > 0 ? el('p', {class: 'about'}, `${more} shorter ones are not listed here.`)
    : null);
}

function samplesSection(player, trial, figure, fates) {
  const rows = trial.markers.map((marker) => ({marker}));
  const touched = rows.filter(({marker}) => marker.runs.length + marker.faults.length > 0);
  if (touched.length === 0) {
    return [el('p', {}, `${plural(rows.length, 'marker', 'markers')}, all there in every ` +
      'frame; nothing was wrong with them.')];
  }
  const place = el('div', {});
  const show = (some) => place.replaceChildren(
    fateGraph(player, trial, figure, fates, some ? touched : rows));
  show(false);
  const chooser = touched.length === rows.length ? null
    : el('label', {class: 'switch'}, el('input', {type: 'checkbox',
      onchange: (event) => show(event.target.checked)}),
    ` only the ${plural(touched.length, 'marker', 'markers')} of which something was ` +
      'repaired');
  return [
    el('p', {class: 'lead'}, 'Every row is a marker, with the share that was measured; ' +
      'every column a frame. Point at it to read what was done.'),
    fateLegend(trial, fates), chooser, place,
    repairTable(trial, figure, fates),
  ];
}
