// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Builds the page. app/report_html.cpp writes `data`.

const SECTIONS = [
  ['motion', 'Motion'], ['pictures', 'Pictures'], ['reprojection', 'Reprojection'],
  ['tags', 'Tags and gaps'], ['joints', 'Joint centres'], ['subject', 'Subject'],
  ['cameras', 'Cameras'], ['avatars', 'Avatars and files'], ['time', 'Time'],
];

function fillSection(name, children) {
  const [, title] = SECTIONS.find(([id]) => id === name);
  document.getElementById(name).replaceChildren(el('h2', {}, title), ...children);
}

function showTrial(data, viewer, chosen) {
  const {figures} = data;
  const trial = data.trials[chosen];
  const figure = figures.trials[chosen];
  const {player} = viewer;
  viewer.load(trial, figure, figures.calibration.cameras);
  fillSection('pictures', picturesSection(player, trial, figure));
  fillSection('reprojection', reprojectionSection(player, trial, figure));
  fillSection('tags', tagsSection(player, trial, figure));
  fillSection('joints', jointsSection(figure));
  fillSection('cameras', camerasSection(figures.calibration, trial,
    data.calibration_page));
  const link = pageLink(figure.name, null, 'on the page');
  document.getElementById('trial-about').replaceChildren(`${figure.frames_solved} of ` +
    `${plural(figure.frames, 'frame', 'frames')} solved, ${fixed(figure.rms_px, 2)} px, ` +
    `joints ± ${fixed(figure.joint_sigma_median_mm, 1)} mm `, ...(link ? [link] : []));
}

function trialChooser(trials, choose) {
  if (trials.length < 2) return el('span', {class: 'chosen'}, trials[0].name);
  const select = el('select', {onchange: () => choose(Number(select.value))},
    ...trials.map((trial, i) => el('option', {value: i}, trial.name)));
  return el('label', {}, 'Trial ', select);
}

function fillPage(data, options) {
  const {figures} = data;
  document.title = `${figures.session} – marey report`;
  document.getElementById('head').replaceChildren(...headSection(figures));
  if (figures.subject) {
    fillSection('subject', subjectSection(figures.subject, figures.subject.unplaced_tags));
  }
  fillSection('avatars', avatarsSection(figures.trials));
  fillSection('time', timingsSection(figures));
  document.getElementById('version').textContent =
    `Written by marey ${figures.marey_version}.`;
  document.getElementById('sections').replaceChildren(
    ...SECTIONS.map(([id, title]) => el('a', {href: `#${id}`}, title)));
  if (data.trials.length === 0) {
    fillSection('cameras', camerasSection(figures.calibration, null,
      data.calibration_page));
    for (const name of ['motion', 'pictures', 'reprojection', 'tags', 'joints']) {
      fillSection(name, [el('p', {}, 'No trial was solved.')]);
    }
    return null;
  }
  const viewer = new Viewer(new Player(), options);
  fillSection('motion', [viewer.root]);
  document.getElementById('trial').replaceChildren(
    trialChooser(figures.trials, (i) => showTrial(data, viewer, i)));
  showTrial(data, viewer, 0);
  return viewer;
}

/** Plays while the viewer is visible, unless reduced motion is set. */
function playWhenSeen(viewer) {
  if (matchMedia('(prefers-reduced-motion: reduce)').matches) return;
  let started = false;
  new IntersectionObserver(([entry]) => {
    if (!entry.isIntersecting) {
      started = started && viewer.player.playing;
      viewer.player.play(false);
      started = false;
    } else if (!started) {
      started = true;
      viewer.player.play(true);
    }
  }, {threshold: 0.15}).observe(viewer.canvas);
}

/** For tests: records on <html> that the page is ready and the state of the viewer. */
function tellStatus(viewer) {
  const state = document.documentElement.dataset;
  if (viewer) {
    viewer.draw();
    state.drawing = viewer.drawing instanceof ShadedDrawing ? 'shaded' : 'lines';
    state.colours = viewer.drawing.coloursDrawn();
  }
  state.status = 'ready';
}

function openPage() {
  const data = JSON.parse(document.getElementById('data').textContent);
  const wishes = location.hash.slice(1).split(',');
  const viewer = fillPage(data, {lines: wishes.includes('lines')});
  if (viewer) playWhenSeen(viewer);
  if (wishes.includes('check')) tellStatus(viewer);
}

openPage();
