// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Marker positions around gaps, before and after the repair, drawn by uPlot.

import uPlot from 'uplot';
import {el} from '../base/elements';
import type {Theme} from '../base/theme';
import {duration, fixed} from '../base/words';
import {lonePoints, plainPlot} from '../timeline/graph';
import {lead, lineLegend, mm, paragraph} from './common';
import type {Fate, MarkerCurve, MarkerTrial, MarkerTrialFigures} from './data';
import {frameWords} from './marker_fates';

const AXES = ['x', 'y', 'z'];
const STRIP_PX = 74;
/** An uncertainty of decimetres would flatten everything else. */
const WIDEST_BAND_MM = 300;

type Values = (number | null)[];

/** Returns the value range of the picture: kept samples with their uncertainty. Wrong samples
 *  may be metres away and are cut at the edge. */
function stripRange({after_mm, read_mm, sigma_mm}: MarkerCurve, axis: number): [number, number] {
  const kept = after_mm[axis].flatMap((value, i) => {
    const uncertainty = Math.min(2 * (sigma_mm[i] ?? 0), WIDEST_BAND_MM);
    return value === null ? [] : [value - uncertainty, value + uncertainty];
  });
  const known = (values: Values): number[] => values.filter((value) => value !== null);
  const values = kept.length > 0 ? kept : known(read_mm[axis]);
  const [low, high] = values.length > 0 ? [Math.min(...values), Math.max(...values)] : [0, 0];
  const room = Math.max(0.08 * (high - low), 2);
  return [low - room, high + room];
}

/** Samples of one fate. A fill is connected to the samples on both sides. */
function samplesOf({fates, after_mm}: MarkerCurve, axis: number, fate: number): Values {
  const reach = fate === 0 ? 0 : 1;
  return after_mm[axis].map((value, i) => (fates.slice(Math.max(i - reach, 0), i + reach + 1)
    .includes(fate) ? value : null));
}

function strip(curve: MarkerCurve, axis: number, fates: readonly Fate[], theme: Theme):
  {element: HTMLElement; plot: uPlot} {
  const range = stripRange(curve, axis);
  const cut = (values: Values): Values => values.map((value) =>
    (value === null ? null : Math.min(Math.max(value, range[0]), range[1])));
  const read = cut(curve.read_mm[axis]);
  const isWrong = (i: number): boolean => curve.removed[i] === 1 ||
    fates[curve.fates[i]] === 'swapped';
  const data: Values[] = [];
  const series: uPlot.Series[] = [{}];
  const bands: uPlot.Band[] = [];
  const colour = (name: string) => (): string => theme.colour(name);
  const add = (values: Values, look: uPlot.Series): void => {
    data.push(values);
    series.push({spanGaps: false, points: {size: 3, filter: lonePoints}, ...look});
  };
  fates.forEach((fate, k) => {
    if (fate === 'left-empty') return;
    const values = samplesOf(curve, axis, k);
    const name = k === 0 ? 'measured' : `fate-${fate}`;
    const edge = (sign: number): Values => cut(values.map((value, i) =>
      (value === null ? null : value + sign * 2 * (curve.sigma_mm[i] ?? 0))));
    add(edge(1), {width: 0, points: {show: false}});
    add(edge(-1), {width: 0, points: {show: false}});
    bands.push({series: [series.length - 2, series.length - 1], fill: () =>
      `color-mix(in srgb, ${theme.colour(`fate-${fate}`)} 35%, transparent)`});
    add(values, {width: 1.7, stroke: colour(name)});
  });
  add(read.map((value, i) => (isWrong(i) ? value : null)),
    {width: 1.2, dash: [3, 2], stroke: colour('quiet')});
  add(read.map((value, i) => (curve.removed[i] === 1 ? value : null)),
    {width: 0, points: {show: true, size: 5, fill: colour('fate-removed')}});
  const place = el('div', {class: 'picture', role: 'img',
    'aria-label': `${AXES[axis]} over time, millimetres`});
  const plot = new uPlot({...plainPlot(STRIP_PX), padding: [0, 0, 0, 0], series, bands,
    axes: [{show: false}, {show: false}],
    scales: {x: {time: false, range: [curve.at[0] - 0.5, curve.at[curve.at.length - 1] + 0.5]},
      y: {range}},
    hooks: {drawClear: [(u) => {
      const left = u.valToPos(curve.first - 0.5, 'x', true);
      u.ctx.fillStyle = theme.colour('seen-none');
      u.ctx.fillRect(left, u.bbox.top, u.valToPos(curve.first + curve.frames - 0.5, 'x', true) -
        left, u.bbox.height);
    }]}}, [curve.at, ...data], place);
  return {plot, element: el('div', {class: 'strip'}, el('div', {class: 'ends'},
    el('span', {}, fixed(range[1], 0)), el('b', {}, AXES[axis]),
    el('span', {}, fixed(range[0], 0))), place)};
}

function curveCard(curve: MarkerCurve, trial: MarkerTrial, figure: MarkerTrialFigures,
  fates: readonly Fate[], theme: Theme): HTMLElement {
  const inside = [...curve.at.keys()].filter((i) => curve.at[i] >= curve.first &&
    curve.at[i] < curve.first + curve.frames);
  const sigmas = inside.map((i) => curve.sigma_mm[i]).filter((sigma) => sigma !== null);
  const about = [frameWords(trial, curve.first, curve.frames),
    duration(curve.frames / figure.rate_hz),
    ...(inside.some((i) => curve.removed[i] === 1) ? ['wrong samples removed'] : []),
    [...new Set(inside.map((i) => fates[curve.fates[i]]))].join(', '),
    ...(sigmas.length > 0 ? [`sigma up to ${mm(Math.max(...sigmas))}`] : [])];
  const time = (frame: number): HTMLElement =>
    el('span', {}, `${fixed(frame / figure.rate_hz, 2)} s`);
  const strips = AXES.map((_, axis) => strip(curve, axis, fates, theme));
  const card = el('article', {class: 'curve'}, el('h3', {}, trial.markers[curve.marker].label),
    el('p', {class: 'about'}, about.join(' · ')), ...strips.map(({element}) => element),
    el('div', {class: 'times'}, time(curve.at[0]), time(curve.at[curve.at.length - 1])));
  new ResizeObserver(() => {
    for (const {plot} of strips) {
      plot.setSize({width: plot.root.parentElement!.clientWidth, height: STRIP_PX});
    }
  }).observe(card);
  theme.onChange(() => strips.forEach(({plot}) => plot.redraw()));
  return card;
}

export function curvesSection({curves, ...trial}: MarkerTrial, figure: MarkerTrialFigures,
  fates: readonly Fate[], theme: Theme): HTMLElement[] {
  if (curves.length === 0) return [paragraph('There was nothing to repair.')];
  const used = fates.filter((fate, k) => k > 0 && fate !== 'left-empty' &&
    curves.some((curve) => curve.fates.includes(k)));
  const isAnyWrong = curves.some((curve) => curve.removed.includes(1) ||
    curve.fates.includes(fates.indexOf('swapped')));
  const entry = (words: string, colour: string, dash: string | null = null) => ({words,
    attributes: {style: `stroke: var(--${colour})`, 'stroke-width': 2.5,
      'stroke-dasharray': dash}});
  return [
    lead('The longest and the least certain fills, and the wrong samples with the largest ' +
      'errors, one per marker: in world coordinates, millimetres, y up. The pale band is two ' +
      'sigma; grey marks the frames of the gap or fault. Wrong samples outside the plot are ' +
      'drawn on its edge.'),
    lineLegend([entry('measured', 'measured'), ...used.map((fate) => entry(fate, `fate-${fate}`)),
      ...(isAnyWrong
        ? [entry('as read, and wrong; dots are removed samples', 'quiet', '3 2')] : [])]),
    el('div', {class: 'curves'}, ...curves.map((curve) =>
      curveCard(curve, {curves, ...trial}, figure, fates, theme))),
  ];
}
