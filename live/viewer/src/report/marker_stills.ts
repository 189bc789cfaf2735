// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The body with its markers at a few instants, from the front and from the side. Plain
// projection, millimetres.

import {el, svg} from '../base/elements';
import type {Attributes} from '../base/elements';
import {scaleColour} from '../base/theme';
import {fixed} from '../base/words';
import {SOURCES} from '../protocol/protocol';
import type {Vector} from '../protocol/protocol';
import {lead, mm, picture, scaleKey, SOURCE_DASH, sourceLegend} from './common';
import type {MarkersData, MarkerTrial, MarkerTrialFigures, Still} from './data';
import {frameWords} from './marker_fates';
import {pageLink} from './page_links';

const WORST_COLOUR_MM = 30;

/** Facing (fx, fz): the subject's left is (fz, -fx), to the right of a viewer who faces it. */
const VIEWS = [
  {words: 'front', way: ([fx, fz]: Still['facing']) => [fz, -fx]},
  {words: 'left side', way: ([fx, fz]: Still['facing']) => [-fx, -fz]},
];
type View = typeof VIEWS[number];
interface Size {across: number; up: number}

/** Returns the projection of a still: [across, up]. */
function projection(still: Still, view: View): (p: Vector) => [number, number] {
  const [wx, wz] = view.way(still.facing);
  return ([x, y, z]) => [x * wx + z * wz, y];
}

const extent = (values: readonly number[]): number => Math.max(...values) - Math.min(...values);

/** Returns one size for all stills of a trial, so that they can be compared. */
function stillSize(stills: readonly Still[]): Size {
  const up = Math.max(900, ...stills.map(({joints_mm}) => extent(joints_mm.map(([, y]) => y))));
  const across = Math.max(600, ...stills.flatMap((still) => VIEWS.map((view) =>
    extent(still.joints_mm.map((p) => projection(still, view)(p)[0])))));
  return {across: 1.12 * across, up: Math.max(1.16 * up, 0.5 * across)};
}

function stillView(still: Still, data: MarkersData, view: View, {across, up}: Size, left: number,
  titles: readonly string[]): SVGElement {
  const flat = projection(still, view);
  const joints = still.joints_mm.map(flat);
  const [xs, ys] = [joints.map(([x]) => x), joints.map(([, y]) => y)];
  const middle = (Math.min(...xs) + Math.max(...xs)) / 2;
  // The floor is in the picture if the body is near it.
  const lowest = Math.min(...ys);
  const isNear = lowest > -200 && Math.max(...ys) < 0.95 * up;
  const bottom = (isNear ? Math.min(0, lowest) : lowest) - 0.05 * up;
  const at = ([x, y]: readonly number[]): string[] =>
    [across / 2 + x - middle, up + bottom - y].map((v) => v.toFixed(0));
  const line = (a: readonly number[], b: readonly number[], attributes: Attributes): SVGElement => {
    const [[x1, y1], [x2, y2]] = [at(a), at(b)];
    return svg('line', {x1, y1, x2, y2, ...attributes});
  };
  const parts: SVGElement[] = [];
  if (bottom < 0 && bottom + up > 0) {
    parts.push(line([middle - across / 2, 0], [middle + across / 2, 0], {class: 'floor'}));
  }
  for (const [from, to, source] of data.bones) {
    const name = SOURCES[still.sources[source]];
    parts.push(line(joints[from], joints[to],
      {class: `bone source-${name}`, 'stroke-dasharray': SOURCE_DASH[name]}));
  }
  const radius = (2 * across + up) / 260;
  for (const [m, fate, place, onBody, off] of still.markers) {
    const [cx, cy] = at(flat(place));
    if (onBody) parts.push(line(flat(place), flat(onBody), {class: 'off'}));
    const words = `${titles[m]}: ${data.fates[fate]}` +
      (off === undefined ? ', not part of the body' : `, ${mm(off)} off`);
    const look = off === undefined ? {class: 'stranger'}
      : fate < 2 ? {class: 'worn', style: `fill: ${scaleColour(off / WORST_COLOUR_MM)}`}
        : {class: 'filled', style: `stroke: var(--fate-${data.fates[fate]})`};
    parts.push(svg('circle', {cx, cy, r: radius.toFixed(1), ...look}, svg('title', {}, words)));
  }
  const letters = 4.5 * radius;
  parts.push(svg('text', {x: across / 2, y: 1.3 * letters, 'font-size': letters}, view.words));
  // A picture of its own cuts distant points at its edge.
  return svg('svg', {x: left, y: 0, width: across, height: up, viewBox: `0 0 ${across} ${up}`},
    ...parts);
}

function stillCard(still: Still, data: MarkersData, trial: MarkerTrial,
  figure: MarkerTrialFigures, size: Size): HTMLElement {
  const titles = trial.markers.map(({label}) => label);
  const [furthest] = still.markers.filter(([, fate, , , off]) => fate < 2 && off !== undefined)
    .sort((a, b) => b[4]! - a[4]!);
  return el('figure', {class: still.is_worst ? 'still worst' : 'still'},
    picture([0, 0, Math.round(2 * size.across), Math.round(size.up)],
      'Skeleton and markers from the front and from the left', ...VIEWS.map((view, i) =>
        stillView(still, data, view, size, i * size.across, titles))),
    el('figcaption', {}, figure.trial && pageLink(figure.trial, still.frame + trial.first_frame,
      'On the page: '), `${frameWords(trial, still.frame, 1)}, ` +
      `${fixed(still.frame / figure.rate_hz, 2)} s · RMS ${mm(still.rms_mm)}` +
      (furthest ? `, furthest ${titles[furthest[0]]} ${mm(furthest[4]!, 0)}` : '') +
      (still.is_worst ? ' · the frame that fits worst' : '')));
}

export function stillsSection(data: MarkersData, trial: MarkerTrial,
  figure: MarkerTrialFigures): HTMLElement[] {
  const size = stillSize(trial.stills);
  return [
    lead('The skeleton and the markers at several instants of the trial, and at the instants ' +
      'with the largest distances of markers from the body. Thin lines connect a marker with ' +
      'its place on the body. Rings are filled markers; thin grey rings are markers that do not ' +
      'belong to the body. Point at a marker to read its name.'),
    scaleKey('off the body', `${WORST_COLOUR_MM} mm`),
    el('div', {class: 'row'}, sourceLegend(true)),
    // A lying subject makes wide pictures.
    el('div', {class: 'stills', style: `--least: ${size.across > 0.8 * size.up ? 28 : 17}rem`},
      ...trial.stills.map((still) => stillCard(still, data, trial, figure, size))),
  ];
}
