// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Colours come from report.css, so that light and dark are defined in one place.

const SOURCES = ['measured', 'repaired', 'inferred'];
const SOURCE_MEANING = {
  measured: 'seen by a camera at that instant',
  repaired: 'not seen; bridged between sightings shortly before and after',
  inferred: 'not seen for long; follows from its neighbours',
};
/** Dashes repeat the meaning of the colours, for colour-blind readers. */
const SOURCE_DASH = {measured: null, repaired: '7 4', inferred: '2 4'};

const cssColour = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** Returns a colour of report.css, written there as #rrggbb, as three numbers 0..1. */
function rgb(name) {
  const hex = cssColour(name);
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
}

// Cividis (Nunez, Anderton, Renslow 2018), which looks the same to colour-blind readers.
const CIVIDIS = [
  [0.0, 0.135, 0.305], [0.2, 0.27, 0.43], [0.42, 0.42, 0.445], [0.65, 0.6, 0.47],
  [0.87, 0.78, 0.37], [1.0, 0.92, 0.27],
];

/** `share`: place on the scale, 0 is certain, 1 is uncertain. */
function doubtColour(share) {
  const place = Math.min(Math.max(share, 0), 1) * (CIVIDIS.length - 1);
  const i = Math.min(Math.floor(place), CIVIDIS.length - 2);
  return CIVIDIS[i].map((low, k) => low + (place - i) * (CIVIDIS[i + 1][k] - low));
}

const cssRgb = (colour) =>
  `rgb(${colour.map((part) => Math.round(255 * part)).join(' ')})`;

function onThemeChange(then) {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', then);
}

function sourceLegend(withDash, sources = SOURCES) {
  return el('ul', {class: 'legend'}, ...sources.map((source) => {
    const line = svg('svg', {viewBox: '0 0 28 10', width: 28, height: 10,
      'aria-hidden': 'true'},
    svg('line', {x1: 1, y1: 5, x2: 27, y2: 5, class: `source-${source}`,
      'stroke-width': withDash ? 4 : 8,
      'stroke-dasharray': withDash ? SOURCE_DASH[source] : null}));
    return el('li', {title: SOURCE_MEANING[source]}, line, ` ${source}`);
  }));
}
