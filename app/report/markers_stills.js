// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The body with its markers at a few instants, from the front and from the side. Plain
// projection, millimetres.

const WORST_COLOUR_MM = 30;
const residualColour = (mm) => cssRgb(doubtColour(mm / WORST_COLOUR_MM));

/** Returns places of a still as [across, up]; `way` is the direction on the floor that
 *  points to the right. */
const onto = ([wx, wz]) => ([x, y, z]) => [x * wx + z * wz, y];

/** Facing (fx, fz): the subject's left is (fz, -fx), to the right of a viewer who faces it. */
const VIEWS = [
  {words: 'front', way: ([fx, fz]) => [fz, -fx]},
  {words: 'left side', way: ([fx, fz]) => [-fx, -fz]},
];

/** Returns one size for all stills of a trial, so that they can be compared. */
function stillSize(stills) {
  let [across, up] = [600, 900];
  for (const still of stills) {
    const heights = still.joints_mm.map(([, y]) => y);
    up = Math.max(up, Math.max(...heights) - Math.min(...heights));
    for (const {way} of VIEWS) {
      const xs = still.joints_mm.map((p) => onto(way(still.facing))(p)[0]);
      across = Math.max(across, Math.max(...xs) - Math.min(...xs));
    }
  }
  up = Math.max(1.16 * up, 0.5 * across);
  return {across: 1.12 * across, up};
}

function stillView(still, data, view, size, left, titles) {
  // In a nested picture, so that distant points are cut at its edge.
  const flat = onto(view.way(still.facing));
  const joints = still.joints_mm.map(flat);
  const xs = joints.map(([x]) => x);
  const ys = joints.map(([, y]) => y);
  const middle = (Math.min(...xs) + Math.max(...xs)) / 2;
  // The floor is in the picture if the body is near it.
  const lowest = Math.min(...ys);
  const near = lowest > -200 && Math.max(...ys) < 0.95 * size.up;
  const bottom = (near ? Math.min(0, lowest) : lowest) - 0.05 * size.up;
  const at = ([x, y]) => [size.across / 2 + x - middle, size.up + bottom - y];
  const line = (a, b, attributes) => {
    const [[x1, y1], [x2, y2]] = [at(a), at(b)];
    return svg('line', {x1: x1.toFixed(0), y1: y1.toFixed(0), x2: x2.toFixed(0),
      y2: y2.toFixed(0), ...attributes});
  };
  const parts = [];
  if (bottom < 0 && bottom + size.up > 0) {
    parts.push(line([middle - size.across / 2, 0], [middle + size.across / 2, 0],
      {class: 'floor'}));
  }
  for (const [from, to, source] of data.bones) {
    const name = SOURCES[still.sources[source]];
    parts.push(line(joints[from], joints[to],
      {class: `bone source-${name}`, 'stroke-dasharray': SOURCE_DASH[name]}));
  }
  const radius = (2 * size.across + size.up) / 260;
  for (const [m, fate, place, onBody, off] of still.markers) {
    const p = flat(place);
    const [cx, cy] = at(p).map((v) => v.toFixed(0));
    const isRead = fate < 2;
    if (onBody) parts.push(line(p, flat(onBody), {class: 'off'}));
    const words = `${titles[m]}: ${data.fates[fate]}` +
      (off === undefined ? ', not one of the body’s' : `, ${fixed(off, 1)} mm off`);
    const look = off === undefined ? {class: 'stranger'}
      : isRead ? {class: 'worn', style: `fill: ${residualColour(off)}`}
        : {class: 'filled', style: `stroke: var(--fate-${data.fates[fate]})`};
    parts.push(svg('circle', {cx, cy, r: radius.toFixed(1), ...look},
      svg('title', {}, words)));
  }
  const letters = 4.5 * radius;
  parts.push(svg('text', {x: size.across / 2, y: 1.3 * letters, 'font-size': letters},
    view.words));
  return svg('svg', {x: left, y: 0, width: size.across, height: size.up,
    viewBox: `0 0 ${size.across} ${size.up}`}, ...parts);
}

function stillCard(still, data, trial, figure, size) {
  const titles = trial.markers.map((marker) => marker.label);
  const furthest = still.markers.filter(([, fate, , , off]) => fate < 2 && off !== undefined)
    .sort((a, b) => b[4] - a[4])[0];
  const [wide, high] = [2 * size.across, size.up].map(Math.round);
  const parts = VIEWS.map((view, i) =>
    stillView(still, data, view, size, i * size.across, titles));
  return el('figure', {class: still.is_worst ? 'still worst' : 'still'},
    svg('svg', {viewBox: `0 0 ${wide} ${high}`, role: 'img',
      'aria-label': 'Skeleton and markers from the front and from the left'}, ...parts),
    el('figcaption', {}, figure.trial ? pageLink(figure.trial,
      still.frame + trial.first_frame, 'On the page: ') : null,
    `${frameWords(trial, still.frame, 1)}, ` +
      `${fixed(still.frame / figure.rate_hz, 2)} s · RMS ` +
      `${fixed(still.rms_mm, 1)} mm` +
      (furthest ? `, furthest ${titles[furthest[0]]} ${fixed(furthest[4], 0)} mm` : '') +
      (still.is_worst ? ' · the frame that fits worst' : '')));
}

function stillsSection(data, trial, figure) {
  const size = stillSize(trial.stills);
  const ramp = Array.from({length: 6}, (_, i) => residualColour(WORST_COLOUR_MM * i / 5));
  return [
    el('p', {class: 'lead'}, 'The skeleton and the markers at instants spread over the ' +
      'trial, and where markers are furthest from the body. Thin lines lead from a marker ' +
      'to its place on the body; rings are markers that were filled, thin grey rings those ' +
      'that do not belong to the body. Point at a marker to read its name.'),
    el('p', {class: 'key'}, el('span', {}, 'off the body'), el('span', {}, '0'),
      el('span', {class: 'ramp', style: `background: linear-gradient(to right, ${
        ramp.join(', ')})`}), el('span', {}, `${WORST_COLOUR_MM} mm and more`)),
    el('div', {class: 'row'}, sourceLegend(true)),
    // A lying subject makes wide pictures.
    el('div', {class: 'stills', style: `--least: ${size.across > 0.8 * size.up ? 28 : 17}rem`},
      ...trial.stills.map((still) => stillCard(still, data, trial, figure, size))),
  ];
}
