// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Distributions of a library's figures, with their limits.

import {button, el, svg} from '../base/elements';
import {plural} from '../base/words';
import {fold, lead, picture} from './common';
import {histogram} from './library_data';
import type {Clip, FigureSummary} from './library_data';

const BARS = 40;
const [WIDTH, HEIGHT] = [240, 64];

/** Returns a number with at most three digits after the point. */
export function shortNumber(value: number): string {
  const size = Math.abs(value);
  const decimals = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;
  return String(Number(value.toFixed(decimals))).replace('-', '−');
}

/** Splits "slide_cm_s" into a name and its unit. */
const UNITS: readonly (readonly [string, string])[] = [['_cm_s', 'cm/s'], ['_m_s', 'm/s'],
  ['_mm', 'mm'], ['_deg', '°'], ['_s', 's'], ['_m', 'm'], ['_sigma', 'σ'],
  ['_share', ''], ['_ratio', ''], ['_count', ''], ['_frames', 'frames']];
export function figureWords(figure: string): {name: string; unit: string} {
  const found = UNITS.find(([ending]) => figure.endsWith(ending));
  const name = found && found[1] ? figure.slice(0, -found[0].length) : figure;
  return {name: name.replaceAll('_', ' '), unit: found ? found[1] : ''};
}

export function withFigureUnit(value: number, figure: string): string {
  const {unit} = figureWords(figure);
  return `${shortNumber(value)}${unit === '' || unit === '°' ? unit : `\u00a0${unit}`}`;
}

/** Bars grow with the logarithm of clips, so that a single clip is visible. */
function bars(counts: readonly number[], edges: (bar: number) => string): SVGElement[] {
  const scale = Math.log1p(Math.max(...counts, 1));
  const step = WIDTH / counts.length;
  return counts.map((count, i) => {
    const height = count === 0 ? 0 : Math.max(2, HEIGHT * Math.log1p(count) / scale);
    return svg('rect', {class: `bar ${edges(i)}`, x: i * step + 0.5, width: step - 1,
      y: HEIGHT - height, height});
  });
}

function chart(clips: readonly Clip[], summary: FigureSummary, column: number,
  choose: (column: number) => void): HTMLElement {
  const {figure, limits} = summary;
  const values = clips.map((clip) => clip.values[column])
    .filter((value): value is number => value !== null);
  const {counts, from, to, above} = histogram(values, limits, BARS);
  const all = [...counts, above];
  const at = (value: number): number => WIDTH * BARS * (value - from) / (to - from) / all.length;
  const level = (bar: number): string => {
    const middle = from + (to - from) * (bar + 0.5) / BARS;
    return !limits || middle <= limits[0] ? 'pass' : middle <= limits[1] ? 'warn' : 'fail';
  };
  const {name} = figureWords(figure);
  const words = `${plural(summary.clips, 'clip')}, median ${withFigureUnit(summary.median, figure)
  }, 95 % below ${withFigureUnit(summary.p95, figure)}, highest ${
    withFigureUnit(summary.worst.value, figure)} in ${summary.worst.name}`;
  return el('figure', {class: 'figure', title: words},
    el('figcaption', {},
      button({class: 'link', onclick: () => choose(column)}, name),
      el('span', {class: 'counts'},
        summary.failed > 0 && el('span', {class: 'count-fail'}, `${summary.failed} fail`),
        summary.warned > 0 && el('span', {class: 'count-warn'}, `${summary.warned} warn`))),
    picture([0, -2, WIDTH, HEIGHT + 3], words,
      ...bars(all, level),
      ...(limits ?? []).map((limit, i) => svg('line', {class: `limit ${i === 0 ? 'warn' : 'fail'}`,
        x1: at(limit), x2: at(limit), y1: -2, y2: HEIGHT})),
      svg('line', {class: 'base', x1: 0, x2: WIDTH, y1: HEIGHT + 0.5, y2: HEIGHT + 0.5})),
    el('div', {class: 'ends'}, el('span', {}, withFigureUnit(from, figure)),
      limits && el('span', {}, `limits ${shortNumber(limits[0])}, ${
        withFigureUnit(limits[1], figure)}`),
      el('span', {}, above > 0 ? `> ${withFigureUnit(to, figure)}`
        : withFigureUnit(to, figure))));
}

/** Figures with warnings or failures first; the others are folded. */
export function figureCharts(clips: readonly Clip[], figures: readonly FigureSummary[],
  choose: (column: number) => void): HTMLElement[] {
  const charts = (wanted: (figure: FigureSummary) => boolean): HTMLElement[] => figures
    .map((figure, i): [FigureSummary, number] => [figure, i])
    .filter(([figure]) => wanted(figure))
    .map(([figure, i]) => chart(clips, figure, i, choose));
  const hasTrouble = ({warned, failed}: FigureSummary): boolean => warned + failed > 0;
  const bad = charts(hasTrouble);
  const good = charts((figure) => !hasTrouble(figure));
  return [
    lead('The number of clips (height, logarithmic) by the value of each figure. Lines are ' +
      'the limits of warnings and failures; the last bar has all higher values. A click on ' +
      'a name sorts the clips by it.'),
    bad.length > 0 ? el('div', {class: 'figures'}, ...bad)
      : el('p', {}, 'No figure exceeds its limits.'),
    ...(good.length > 0 ? [fold(`${plural(good.length, 'figure')} without warnings`,
      el('div', {class: 'figures'}, ...good))] : []),
  ];
}
