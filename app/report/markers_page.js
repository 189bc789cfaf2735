// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Builds the page of labelled markers. app/marker_report.cpp writes `data`.

const SECTIONS = [
  ['samples', 'Samples'], ['residuals', 'Distance from the body'],
  ['curves', 'Before and after'], ['stills', 'Stills'], ['joints', 'Joint centres'],
  ['labels', 'Labels'],
];
/** Sections for a file that was only repaired. */
const REPAIR_SECTIONS = ['samples', 'curves', 'labels'];

function fillSection(name, children) {
  const [, title] = SECTIONS.find(([id]) => id === name);
  document.getElementById(name).replaceChildren(el('h2', {}, title),
    ...children.filter((child) => child !== null));
}

function showTrial(data, player, chosen) {
  const trial = data.trials[chosen];
  const figure = data.figures.trials[chosen];
  player.load(figure.frames, figure.rate_hz);
  fillSection('samples', samplesSection(player, trial, figure, data.fates));
  fillSection('curves', curvesSection(trial, figure, data.fates));
  const about = [plural(figure.frames, 'frame', 'frames'),
    `${Number(figure.rate_hz.toFixed(3))} Hz`];
  if (data.kind === 'fit') {
    fillSection('residuals', residualsSection(player, data, trial, figure));
    fillSection('stills', trial.stills.length > 0 ? stillsSection(data, trial, figure)
      : [el('p', {}, 'This trial was not solved.')]);
    about.push(figure.rms_mm === null ? 'not solved' : `RMS ${fixed(figure.rms_mm, 1)} mm`);
  }
  const link = figure.trial && figure.rms_mm !== null
    ? pageLink(figure.trial, null, 'on the page') : null;
  document.getElementById('trial-about').replaceChildren(`${about.join(', ')} `,
    ...(link ? [link] : []));
}

function trialChooser(data, player) {
  const names = data.figures.trials.map((trial) => trial.trial ?? trial.file);
  if (names.length < 2) return el('span', {class: 'chosen'}, names[0]);
  const select = el('select', {onchange: () => showTrial(data, player, Number(select.value))},
    ...names.map((name, i) => el('option', {value: i}, name)));
  return el('label', {}, 'Trial ', select);
}

function openPage() {
  const data = JSON.parse(document.getElementById('data').textContent);
  const isFit = data.kind === 'fit';
  const sections = SECTIONS.filter(([id]) => isFit || REPAIR_SECTIONS.includes(id));
  for (const [id] of SECTIONS) {
    if (!sections.some(([kept]) => kept === id)) document.getElementById(id).remove();
  }
  document.title = isFit ? `${data.figures.subject} – marey fit`
    : `${data.figures.trials[0].file} – marey repair`;
  document.getElementById('head').replaceChildren(...headSection(data));
  const player = new Player();
  document.getElementById('trial').replaceChildren(trialChooser(data, player));
  showTrial(data, player, 0);
  if (isFit) fillSection('joints', jointsSection(data));
  fillSection('labels', labelsSection(data));
  document.getElementById('sections').replaceChildren(
    ...sections.map(([id, title]) => el('a', {href: `#${id}`}, title)));
  document.getElementById('version').textContent = `Written by marey ${data.marey_version}.`;
  if (!location.hash.slice(1).split(',').includes('check')) return;
  // For tests, as page.js does.
  document.documentElement.dataset.status = 'ready';
}

openPage();
