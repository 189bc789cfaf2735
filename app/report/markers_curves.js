// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Marker positions around gaps, before and after the repair; and distances of markers from
// the body over time.

const AXES = ['x', 'y', 'z'];
const NOMINAL = 100; // Height of a strip's picture before stretching.

/** Returns the path through the present points; a single one stays visible. */
function pathThrough(points) {
  let path = '';
  points.forEach((point, i) => {
    if (!point) return;
    const [x, y] = point.map((v) => v.toFixed(2));
    path += `${points[i - 1] ? 'L' : 'M'}${x} ${y}`;
    if (!points[i - 1] && !points[i + 1]) path += 'h0.01';
  });
  return path;
}

/** Returns runs of points for which `belongs` is true, each extended by one on both sides. */
function stretches(count, belongs) {
  const runs = [];
  for (let i = 0; i < count; ++i) {
    if (!belongs(i)) continue;
    const from = i;
    while (i + 1 < count && belongs(i + 1)) ++i;
    runs.push([from, i]);
  }
  return runs;
}

/** Returns the value range of the picture: kept samples with their uncertainty. Wrong
 *  samples may be metres away and are cut at the edge. */
function stripRange(curve, axis) {
  const values = [];
  curve.after_mm[axis].forEach((value, i) => {
    if (value === null) return;
    // An uncertainty of decimetres would flatten everything else.
    const doubt = Math.min(2 * (curve.sigma_mm[i] ?? 0), 300);
    values.push(value - doubt, value + doubt);
  });
  if (values.length === 0) values.push(...curve.read_mm[axis].filter((v) => v !== null));
  if (values.length === 0) values.push(0);
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const room = Math.max(0.08 * (high - low), 2);
  return [low - room, high + room];
}

function bandPath(curve, axis, [from, to], x, y) {
  const edge = (i, sign) => {
    const value = curve.after_mm[axis][i];
    return value === null ? null : `${x(i).toFixed(2)} ` +
      y(value + sign * 2 * (curve.sigma_mm[i] ?? 0)).toFixed(2);
  };
  const indices = [];
  for (let i = Math.max(from - 1, 0); i <= Math.min(to + 1, curve.at.length - 1); ++i) {
    if (curve.after_mm[axis][i] !== null) indices.push(i);
  }
  if (indices.length < 2) return null;
  return `M${indices.map((i) => edge(i, 1)).join('L')}L` +
    `${indices.reverse().map((i) => edge(i, -1)).join('L')}Z`;
}

function strip(curve, axis, fates) {
  const count = curve.at.length;
  const [start, end] = [curve.at[0], curve.at[count - 1] + 1];
  const [low, high] = stripRange(curve, axis);
  const x = (i) => curve.at[i] + 0.5 - start;
  const y = (value) => Math.min(Math.max(
    NOMINAL - NOMINAL * (value - low) / (high - low), 1), NOMINAL - 1);
  const read = curve.read_mm[axis];
  const after = curve.after_mm[axis];
  const point = (values, i) => (values[i] === null ? null : [x(i), y(values[i])]);
  const parts = [svg('rect', {class: 'gap', x: curve.first - start, y: 0,
    width: curve.frames, height: NOMINAL})];
  const wrong = (i) => curve.removed[i] === 1 || fates[curve.fates[i]] === 'swapped';
  fates.forEach((fate, k) => {
    for (const run of stretches(count, (i) => curve.fates[i] === k)) {
      if (curve.sigma_mm[run[0]] === null) continue;
      const band = bandPath(curve, axis, run, x, y);
      if (band) parts.push(svg('path', {d: band, class: 'band',
        style: `fill: var(--fate-${fate})`}));
    }
  });
  parts.push(svg('path', {class: 'before', d: pathThrough(
    read.map((_, i) => (wrong(i) ? point(read, i) : null)))}));
  fates.forEach((fate, k) => {
    for (const [from, to] of stretches(count, (i) => curve.fates[i] === k)) {
      // A fill is connected to the samples on both sides.
      const reach = k === 0 ? 0 : 1;
      const points = [];
      for (let i = Math.max(from - reach, 0); i <= Math.min(to + reach, count - 1); ++i) {
        points.push(point(after, i));
      }
      const d = pathThrough(points);
      if (d) parts.push(svg('path', {class: 'line', d, style: `stroke: ${
        k === 0 ? 'var(--measured)' : `var(--fate-${fate})`}`}));
    }
  });
  read.forEach((value, i) => {
    if (value === null || curve.removed[i] !== 1) return;
    // A short vertical line, because the stretched picture would distort a cross.
    parts.push(svg('line', {class: 'cross', x1: x(i), x2: x(i), y1: y(value) - 5,
      y2: y(value) + 5}));
  });
  return el('div', {class: 'strip'},
    el('div', {class: 'ends'}, el('span', {}, fixed(high, 0)), el('b', {}, AXES[axis]),
      el('span', {}, fixed(low, 0))),
    svg('svg', {viewBox: `0 0 ${end - start} ${NOMINAL}`, preserveAspectRatio: 'none',
      role: 'img', 'aria-label': `${AXES[axis]} over time, millimetres`}, ...parts));
}

function curveCard(curve, trial, figure, fates) {
  const {label} = trial.markers[curve.marker];
  const within = (i) => curve.at[i] >= curve.first &&
    curve.at[i] < curve.first + curve.frames;
  const inside = curve.at.map((_, i) => i).filter(within);
  const sigmas = inside.map((i) => curve.sigma_mm[i]).filter((s) => s !== null);
  const words = [...new Set(inside.map((i) => fates[curve.fates[i]]))];
  const wrong = inside.some((i) => curve.removed[i] === 1);
  const about = [frameWords(trial, curve.first, curve.frames),
    duration(curve.frames / figure.rate_hz), ...(wrong ? ['wrong samples taken out'] : []),
    words.join(', '),
    ...(sigmas.length > 0 ? [`sigma up to ${fixed(Math.max(...sigmas), 1)} mm`] : [])];
  const time = (frame) => `${fixed(frame / figure.rate_hz, 2)} s`;
  return el('article', {class: 'curve'},
    el('h3', {}, label), el('p', {class: 'about'}, about.join(' · ')),
    ...AXES.map((_, axis) => strip(curve, axis, fates)),
    el('div', {class: 'times'}, el('span', {}, time(curve.at[0])),
      el('span', {}, time(curve.at[curve.at.length - 1]))));
}

function curvesSection(trial, figure, fates) {
  if (trial.curves.length === 0) return [el('p', {}, 'There was nothing to repair.')];
  const line = (style, words) => el('li', {}, svg('svg', {width: 28, height: 10,
    viewBox: '0 0 28 10', 'aria-hidden': 'true'}, svg('line',
    {x1: 1, x2: 27, y1: 5, y2: 5, 'stroke-width': 2.5, ...style})), ` ${words}`);
  const used = fates.filter((fate, k) => k > 0 && fate !== 'left-empty' &&
    trial.curves.some((curve) => curve.fates.includes(k)));
  const isAnyWrong = trial.curves.some((curve) => curve.removed.includes(1) ||
    curve.fates.includes(fates.indexOf('swapped')));
  return [
    el('p', {class: 'lead'}, 'The longest and the least sure fills, and the wrong samples ' +
      'that were furthest off, one of each marker: millimetres in the world, y up. Pale is ' +
      'the band of two sigma, grey the frames in question; what was wrong and lies beyond ' +
      'the picture is drawn on its edge.'),
    el('ul', {class: 'legend'}, line({style: 'stroke: var(--measured)'}, 'measured'),
      ...used.map((fate) => line({style: `stroke: var(--fate-${fate})`}, fate)),
      isAnyWrong ? line({style: 'stroke: var(--quiet)', 'stroke-dasharray': '3 2'},
        'as read, and wrong; ticks where taken out') : null),
    el('div', {class: 'curves'},
      ...trial.curves.map((curve) => curveCard(curve, trial, figure, fates))),
  ];
}

/** Draws the RMS distance from the body over time. */
function residualGraph(player, trial, figure) {
  const {step, rms_mm: rms, worst_mm: worst} = trial.residuals;
  const level = figure.rms_mm;
  const highest = Math.max(level, ...worst.map((value) => value ?? 0)) * 1.1 || 1;
  const marks = axisMarks(highest);
  const y = (value) => NOMINAL - NOMINAL * value / highest;
  const points = (values) => values.map((value, i) => (value === null ? null
    : [Math.min((i + 0.5) * step, player.frames), y(value)]));
  const picture = svg('svg', {viewBox: `0 0 ${player.frames} ${NOMINAL}`,
    preserveAspectRatio: 'none', class: 'lines', role: 'img',
    'aria-label': 'Distance of markers from the body over time'},
  ...marks.map((mark) => svg('line', {x1: 0, x2: player.frames, y1: y(mark), y2: y(mark),
    class: 'grid'})),
  svg('line', {x1: 0, x2: player.frames, y1: y(level), y2: y(level), class: 'level'}),
  step > 1 ? svg('path', {d: pathThrough(points(worst)), class: 'line',
    style: 'stroke: var(--repaired); stroke-width: 1px'}) : null,
  svg('path', {d: pathThrough(points(rms)), class: 'line'}));
  const readout = (frame) => {
    const i = Math.floor(frame / step);
    const words = frameWords(trial, i * step, Math.min(step, player.frames - i * step));
    if (rms[i] === null) return `${words}: no marker measured`;
    return `${words}: ${fixed(rms[i], 1)} mm` +
      (step > 1 ? `, worst frame ${fixed(worst[i], 1)} mm` : '');
  };
  const close = (mark) => Math.abs(y(mark) - y(level)) < 7;
  return el('div', {class: 'graph'},
    el('div', {class: 'gutter tall'}, ...marks.filter((mark) => !close(mark)).map((mark) =>
      el('span', {style: `top: ${y(mark)}%`}, `${Number(mark.toPrecision(3))} mm`)),
    el('span', {class: 'level', style: `top: ${y(level)}%`}, `all ${fixed(level, 1)} mm`)),
    overFrames(player, picture, readout),
    el('div', {class: 'gutter'}), frameAxis(player, trial.first_frame));
}
