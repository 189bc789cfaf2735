// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The cameras: figures and positions.

import {el, svg} from '../base/elements';
import {fixed} from '../base/words';
import {frustumCorners} from '../scene/rig_view';
import {lead, multiples, picture, pointList, px, table} from './common';
import type {CalibrationFigures, ReportCamera, TrialData} from './data';
import {SERVED} from './page_links';
import {RecordedBody} from './recorded_body';
import {cameraWords} from './report_cameras';

const PYRAMID_M = 0.7;
type Flat = (p: readonly number[]) => [number, number];

/** One view of the room along an axis. `flat` takes a world point to the paper [m]. */
function roomView(title: string, flat: Flat, cameras: readonly ReportCamera[],
  way: readonly number[][], grounded: boolean): HTMLElement {
  const shapes = cameras.map((camera) => ({name: camera.name, at: flat(camera.centre_in_world_m),
    corners: frustumCorners(cameraWords(camera), PYRAMID_M).map(flat)}));
  const path = way.map(flat);
  const points = [[0, 0], ...path, ...shapes.flatMap(({at, corners}) => [at, ...corners])];
  const [[x0, x1], [y0, y1]] = [0, 1].map((k) => [Math.min(...points.map((p) => p[k])) - 0.5,
    Math.max(...points.map((p) => p[k])) + 0.5]);
  const text = Math.max(x1 - x0, 1) / 26;
  const line = (x: number[], y: number[], kind: string): SVGElement =>
    svg('line', {x1: x[0], x2: x[1], y1: y[0], y2: y[1], class: kind});
  return el('figure', {class: 'room'},
    picture([x0, y0, x1 - x0, y1 - y0], `${title}: ${cameras.map(({name}) => name).join(', ')}`,
      ...multiples(x0, x1).map((x) => line([x, x], [y0, y1], 'grid')),
      ...multiples(y0, y1).map((y) => line([x0, x1], [y, y], 'grid')),
      grounded && line([x0, x1], [0, 0], 'floor'),
      svg('polyline', {points: pointList(path), class: 'way'}),
      svg('path', {d: 'M-0.12 0H0.12M0-0.12V0.12', class: 'origin'}),
      ...shapes.flatMap(({name, at: [x, y], corners}) => [
        ...corners.map((corner, i) => svg('polygon', {class: 'sight',
          points: pointList([[x, y], corner, corners[(i + 1) % 4]])})),
        svg('circle', {cx: x, cy: y, r: text / 3.2, class: 'camera'}),
        svg('text', {x, y: y - text * 0.7, 'font-size': text, class: 'name'}, name)])),
    el('figcaption', {}, title));
}

export function camerasSection({cameras, rms_px}: CalibrationFigures, trial: TrialData | null,
  hasPage: boolean): HTMLElement[] {
  const [subject] = trial ? trial.bodies.map((body) => new RecordedBody(body, true)) : [];
  const way = Array.from({length: subject?.frames ?? 0}, (_, frame) => subject.recorded(frame, 0));
  return [
    lead(`The RMS distance of the board from its expected place is ${px(rms_px)}. Coverage is ` +
      'the share of the picture in which the board was seen; the lens is calibrated only there. ',
    // `marey view` serves no file other than its own report.
    hasPage && !SERVED && el('a', {href: './calibration.html'},
      'Details in the calibration report')),
    table('Calibration of every camera', cameras, [
      ['Camera', ({name}) => name],
      ['Picture', (c) => `${c.width_px} × ${c.height_px}`, 'number'],
      ['Focal length', (c) => `${fixed(c.focal_px[0], 1)} ± ${px(c.focal_sigma_px, 1)}`, 'number'],
      ['RMS', (c) => px(c.rms_px), 'number'],
      ['95 %', (c) => px(c.p95_px), 'number'],
      ['Place', (c) => `± ${fixed(c.centre_sigma_mm, 1)} mm`, 'number'],
      ['Coverage', (c) => `${fixed(c.coverage_percent, 0)} %`, 'number'],
      ['Views', (c) => String(c.views), 'number'],
    ]),
    el('div', {class: 'rooms'},
      roomView('From above, in metre squares; the line is the path of the hips',
        (p) => [p[0], p[2]], cameras, way, false),
      roomView('From the front; the thick line is the floor',
        (p) => [p[0], -p[1]], cameras, way, true)),
  ];
}
