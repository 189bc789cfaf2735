// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Parts that all reports share: sections, cards, tables, legends, links.

import {button, chooser, el, svg} from '../base/elements';
import type {Child} from '../base/elements';
import {scaleGradient} from '../base/theme';
import {fixed, plural} from '../base/words';
import {SOURCES} from '../protocol/protocol';
import type {Source} from '../protocol/protocol';

export const byId = (id: string): HTMLElement => document.getElementById(id)!;

/** Words of the address after #: `check` for tests, `lines` for drawing without WebGL. */
export const requested = location.hash.slice(1).split(',');

export function readData<T>(): T {
  return JSON.parse(byId('data').textContent!) as T;
}

/** Records on <html>, for tests, that the page is ready. */
export function reportStatus(state: Record<string, string> = {}): void {
  if (requested.includes('check')) Object.assign(document.documentElement.dataset, state,
    {status: 'ready'});
}

/** Links to the sections of the shell, which build.mjs lists. */
export function linkSections(version: string): void {
  byId('sections').replaceChildren(...[...document.querySelectorAll('main h2')].map((title) =>
    el('a', {href: `#${title.parentElement!.id}`}, title.textContent)));
  byId('version').textContent = `Written by marey ${version}.`;
}

/** Replaces all of a section but its title. */
export function fillSection(id: string, children: readonly Child[]): void {
  byId(id).replaceChildren(byId(id).firstElementChild!,
    ...children.filter((child) => !!child) as Node[]);
}

export function showHead(title: string, kind: string, about: Child, parts: readonly Child[]): void {
  document.title = `${title} – marey ${kind}`;
  byId('head').replaceChildren(el('h1', {}, title), el('p', {class: 'about'}, about),
    ...parts.filter((child) => !!child) as Node[]);
}

export function trialChooser(names: readonly string[], show: (trial: number) => void): void {
  byId('trial').replaceChildren(names.length < 2 ? el('span', {class: 'chosen'}, names[0])
    : el('label', {}, 'Trial ', chooser(names.map((name, i) => [i, name]), 0, (i) =>
      show(Number(i)))));
  show(0);
}

export const lead = (...text: Child[]): HTMLElement => el('p', {class: 'lead'}, ...text);
export const paragraph = (text: string): HTMLElement => el('p', {}, text);

export function fold(title: string, ...children: Child[]): HTMLElement {
  return el('details', {}, el('summary', {}, title), ...children);
}

export function notes(texts: readonly string[], word: string): HTMLElement | null {
  return texts.length === 0 ? null : el('div', {class: 'warnings', role: 'note'},
    el('h2', {}, plural(texts.length, word)),
    el('ul', {}, ...texts.map((text) => el('li', {}, text))));
}

// --- Cards ---

export type Grade = 'good' | 'fair' | 'look closer';
const GRADES: readonly Grade[] = ['good', 'fair', 'look closer'];

/** `limits`: the bounds of good and of fair values; descending if more is better. */
export function gradeOf([good, fair]: readonly number[], value: number | null): Grade {
  const reaches = (limit: number): boolean => (good < fair ? value! <= limit : value! >= limit);
  return value === null ? 'look closer' : reaches(good) ? 'good' : reaches(fair) ? 'fair'
    : 'look closer';
}

/** Returns the worst, because a good mean may hide a poor part. */
export function worstGrade(...grades: Grade[]): Grade {
  return GRADES[Math.max(...grades.map((grade) => GRADES.indexOf(grade)))];
}

/** A value without a grade has no colour. */
export function card(title: string, value: string, unit: string, what: string,
  grade: Grade | null = null, scale: string | null = null): HTMLElement {
  const mark = grade && el('span', {class: 'grade'}, el('span', {'aria-hidden': 'true'},
    `${'●◐○'[GRADES.indexOf(grade)]} `), grade);
  return el('li', {class: `verdict grade-${grade ? grade.replace(' ', '-') : 'none'}`, title: scale},
    el('span', {class: 'title'}, title),
    el('span', {class: 'value'}, value, el('span', {class: 'unit'}, ` ${unit}`)), mark,
    el('span', {class: 'what'}, what));
}

export const cards = (...all: HTMLElement[]): HTMLElement =>
  el('ul', {class: 'verdicts'}, ...all);

// --- Tables ---

/** Title, cell of a row, alignment, and the key by which a click on the title sorts. */
export type Column<R> = readonly [title: string, cell: (row: R) => Child,
  kind?: 'number' | '', key?: (row: R) => string | number];

export function table<R>(caption: string, rows: readonly R[], columns: readonly Column<R>[],
  look = ''): HTMLElement {
  return el('div', {class: `scroll ${look}`, tabindex: 0, role: 'region', 'aria-label': caption},
    el('table', {}, el('caption', {class: 'unseen'}, caption),
      el('thead', {}, el('tr', {}, ...columns.map(([title, , kind]) =>
        el('th', {class: kind, scope: 'col'}, title)))),
      el('tbody', {}, ...rows.map((row) => el('tr', {}, ...columns.map(([, cell, kind], i) =>
        el(i === 0 ? 'th' : 'td', {class: kind, scope: i === 0 && 'row'}, cell(row))))))));
}

/** Numbers are sorted in descending, words in ascending order. */
export function sortableTable<R>(caption: string, rows: readonly R[],
  columns: readonly Column<R>[], first: number): HTMLElement {
  const place = el('div');
  const show = (chosen: number, downward: boolean): void => {
    const key = columns[chosen][3]!;
    const order = [...rows].sort((a, b) => {
      const [one, other] = [key(a), key(b)];
      const way = typeof one === 'string' ? one.localeCompare(String(other), 'en')
        : Number(other) - one;
      return downward ? way : -way;
    });
    const made = table(caption, order, columns, 'bounded');
    made.querySelectorAll('thead th').forEach((head, i) => {
      if (!columns[i][3]) return;
      const mark = i !== chosen ? '' : downward ? ' ▾' : ' ▴';
      head.replaceChildren(button({class: 'sort', 'aria-pressed': String(i === chosen),
        onclick: () => show(i, i !== chosen || !downward)}, `${columns[i][0]}${mark}`));
    });
    place.replaceChildren(made);
  };
  show(first, true);
  return place;
}

/** A value as a bar, a higher one as a whisker, on a common scale. */
export function bar(value: number, whisker: number | null, highest: number): HTMLElement {
  const width = (part: number): string => `width: ${Math.min(100, 100 * part / highest)}%`;
  return el('div', {class: 'uncertainty', 'aria-hidden': 'true'},
    whisker !== null && el('span', {class: 'whisker', style: width(whisker)}),
    el('span', {class: 'median', style: width(value)}));
}

/** Returns a number with its unit; a dash if nothing was measured. */
export const withUnit = (value: number | null | undefined, decimals: number, unit: string): string =>
  (value === null || value === undefined ? '–' : `${fixed(value, decimals)} ${unit}`);
export const px = (value: number | null, decimals = 2): string => withUnit(value, decimals, 'px');
export const mm = (value: number | null, decimals = 1): string => withUnit(value, decimals, 'mm');

// --- Legends ---

const MEANING: Record<Source, string> = {
  measured: 'seen by a camera at that instant',
  repaired: 'not seen; interpolated between sightings shortly before and after',
  inferred: 'not seen for a long time; estimated from its neighbours',
};
/** Dashes repeat the meaning of the colours, for colour-blind readers. */
export const SOURCE_DASH: Record<Source, string | null> = {measured: null, repaired: '7 4',
  inferred: '2 4'};

/** A legend of lines; `attributes` are those of the line. */
export function lineLegend(entries: readonly {words: string; title?: string;
  attributes: Record<string, string | number | null>}[]): HTMLElement {
  return el('ul', {class: 'legend'}, ...entries.map(({words, title, attributes}) =>
    el('li', {title}, svg('svg', {viewBox: '0 0 28 10', width: 28, height: 10,
      'aria-hidden': 'true'}, svg('line', {x1: 1, y1: 5, x2: 27, y2: 5, ...attributes})),
    ` ${words}`)));
}

export function sourceLegend(withDash: boolean, sources: readonly Source[] = SOURCES): HTMLElement {
  return lineLegend(sources.map((source) => ({words: source, title: MEANING[source],
    attributes: {class: `source-${source}`, 'stroke-width': withDash ? 4 : 8,
      'stroke-dasharray': withDash ? SOURCE_DASH[source] : null}})));
}

/** The colour scale of errors and uncertainties, from 0 to `end`. */
export function scaleKey(title: string, end: string, ...more: Child[]): HTMLElement {
  return el('p', {class: 'key'}, el('span', {}, title), ' 0 ',
    el('span', {class: 'scale', style: `background: ${scaleGradient()}`}), ` ${end} and more`,
    ...more);
}

export function chip(kind: string, words: string): HTMLElement {
  return el('span', {class: `chip chip-${kind}`}, words);
}

/** A picture in coordinates of its own, with a text for screen readers. */
export function picture(box: readonly number[], words: string, ...children: Child[]):
  SVGSVGElement {
  return svg('svg', {viewBox: box.join(' '), role: 'img', 'aria-label': words}, ...children);
}

/** Returns the points attribute of a polygon. */
export const pointList = (points: readonly (readonly number[])[], decimals = 3): string =>
  points.map((p) => p.map((v) => v.toFixed(decimals)).join(',')).join(' ');

/** Returns the places of multiples of `step` between two values. */
export function multiples(from: number, to: number, step = 1): number[] {
  const first = Math.ceil(from / step);
  return Array.from({length: Math.max(0, Math.floor(to / step) - first + 1)},
    (_, i) => step * (first + i));
}
