// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Builds the page of a calibration. app/calibration_html.cpp writes `data`.

const SECTIONS = [
  ['layout', 'Where the cameras stand'], ['errors', 'Expected error'],
  ['pictures', 'What each camera saw'], ['together', 'Views in common'],
  ['checks', 'Checks'], ['parameters', 'Parameters'], ['outliers', 'Outliers'],
];

function fillSection(name, children) {
  const [, title] = SECTIONS.find(([id]) => id === name);
  document.getElementById(name).replaceChildren(el('h2', {}, title),
    ...children.filter((child) => child !== null));
}

function openPage() {
  const data = JSON.parse(document.getElementById('data').textContent);
  const wishes = location.hash.slice(1).split(',');
  const {figures} = data;
  document.title = `${figures.session} – marey calibration`;
  document.getElementById('head').replaceChildren(...headSection(figures));
  const viewer = new RigViewer(data, wishes.includes('lines'));
  fillSection('layout', layoutSection(figures, viewer));
  fillSection('errors', errorsSection(figures));
  fillSection('pictures', picturesSection(figures, data.cameras));
  fillSection('together', togetherSection(figures));
  fillSection('checks', checksSection(figures));
  fillSection('parameters', parametersSection(figures));
  fillSection('outliers', outliersSection(figures));
  document.getElementById('sections').replaceChildren(
    ...SECTIONS.map(([id, title]) => el('a', {href: `#${id}`}, title)));
  document.getElementById('version').textContent =
    `Written by marey ${figures.marey_version}.`;
  if (!wishes.includes('check')) return;
  // For tests, as page.js does.
  const state = document.documentElement.dataset;
  viewer.draw();
  state.drawing = viewer.drawing instanceof ShadedDrawing ? 'shaded' : 'lines';
  state.colours = viewer.drawing.coloursDrawn();
  state.status = 'ready';
}

openPage();
