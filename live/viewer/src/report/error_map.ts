// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The floor from above, in the colours of the expected error.

import {el, setText, svg} from '../base/elements';
import {scaleColour} from '../base/theme';
import {fixed} from '../base/words';
import {lead, mm, multiples, picture, pointList, scaleKey} from './common';
import type {ErrorMap, MapHeight, ReportCamera, RigFigures} from './data';
import {shownTarget} from './rig_viewer';

/** Rounds up to 1, 2, 5, 10, 20... */
export function roundAbove(value: number): number {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-9)));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= value * 0.9999)!;
}

/** Returns the error at the top of the scale. Most places have less. The scale is limited,
 *  because the error grows without bound at the edges. [mm] */
function mapScale({heights}: ErrorMap): number {
  const usual = Math.max(...heights.map((height) => height.median_error_mm ?? 0));
  const most = Math.max(...heights.map((height) => height.p95_error_mm ?? 0));
  return roundAbove(Math.max(1e-3, Math.min(3 * usual, most)));
}

/** Returns the URL of a picture with one pixel per place. */
function mapPicture(rows: MapHeight['error_mm'], top: number): string {
  const canvas = el('canvas', {width: rows[0].length, height: rows.length});
  const context = canvas.getContext('2d')!;
  rows.forEach((row, z) => row.forEach((error, x) => {
    if (error === null) return;
    context.fillStyle = scaleColour(error / top);
    context.fillRect(x, z, 1, 1);
  }));
  return canvas.toDataURL();
}

/** Returns the direction of a pixel column on the floor; null for straight down. */
function headingOf(camera: ReportCamera, x_px: number): [number, number] | null {
  const share = (x_px - camera.centre_px[0]) / camera.focal_px[0];
  const [x, z] = [0, 2].map((k) => camera.forward_in_world[k] + share * camera.right_in_world[k]);
  const length = Math.hypot(x, z);
  return length < 1e-6 ? null : [x / length, z / length];
}

/** Edges of the map and of the picture around it. */
interface Frame {
  x: number; z: number; width: number; depth: number;
  left: number; right: number; top: number; bottom: number;
}

function mapFrame({error_map: map, cameras}: RigFigures): Frame {
  const rows = map.heights[0].error_mm;
  const [x, z] = [map.x_from_m - map.step_m / 2, map.z_from_m - map.step_m / 2];
  const [width, depth] = [map.step_m * rows[0].length, map.step_m * rows.length];
  const rim = 0.13 * Math.max(width, depth);
  const [xs, zs] = [0, 2].map((k) => cameras.map((camera) => camera.centre_in_world_m[k]));
  return {x, z, width, depth,
    left: Math.min(x, ...xs.map((v) => v - rim)), right: Math.max(x + width, ...xs.map((v) => v + rim)),
    top: Math.min(z, ...zs.map((v) => v - rim)), bottom: Math.max(z + depth, ...zs.map((v) => v + rim))};
}

function mapCamera(camera: ReportCamera, size: number, frame: Frame): SVGElement[] {
  const [x, , z] = camera.centre_in_world_m;
  const reach = 2 * (frame.right - frame.left + frame.bottom - frame.top);
  const [left, ahead, right] = [0, camera.centre_px[0], camera.width_px].map((x_px) =>
    headingOf(camera, x_px));
  const cone = [left, right].map((way) => [x + reach * (way?.[0] ?? 0), z + reach * (way?.[1] ?? 0)]);
  const [wx, wz] = ahead ?? [0, 1];
  const body = [[-0.5, 0], [0.6, 0.6], [0.6, -0.6]].map(([u, v]) =>
    [x + size * (u * wx - v * wz), z + size * (u * wz + v * wx)]);
  // Letters are about 0.6 of their height wide; the name is kept inside.
  const half = 0.34 * size * (camera.name.length + 1);
  return [
    ...(left && right ? [svg('polygon', {class: 'cone', points: pointList([[x, z], ...cone])})] : []),
    svg('polygon', {class: 'body', points: pointList(body)}),
    svg('text', {x: Math.min(Math.max(x, frame.left + half), frame.right - half),
      y: Math.min(Math.max(z + (wz > 0 ? -0.9 : 1.6) * size, frame.top + size),
        frame.bottom - 0.3 * size), 'font-size': size, 'stroke-width': 0.15 * size}, camera.name),
  ];
}

function errorMap(figures: RigFigures, height: MapHeight, top: number): HTMLElement {
  const {error_map: map, middle_in_world_m: [mx, , mz], cameras} = figures;
  const frame = mapFrame(figures);
  const {x, z, width, depth, left, right, top: upper, bottom} = frame;
  const size = (right - left) / 24;
  const metre = Math.max(width, depth) > 2 ? 1 : 0.1;
  const cross = `M${mx - size / 2} ${mz}h${size}M${mx} ${mz - size / 2}v${size}`;
  const words = `At ${height.height} height, ${fixed(height.height_m, 2)} m: median error ` +
    `${mm(height.median_error_mm)}, ${fixed(height.seen_percent, 0)} % seen by two cameras`;
  const grid = (x1: number, x2: number, y1: number, y2: number): SVGElement =>
    svg('line', {class: 'metre', x1, x2, y1, y2, 'stroke-opacity': 0.35});
  const shown = picture([left, upper, right - left, bottom - upper], words,
    svg('rect', {class: 'blind', x, y: z, width, height: depth}),
    svg('image', {x, y: z, width, height: depth, preserveAspectRatio: 'none',
      href: mapPicture(height.error_mm, top)}),
    ...multiples(left, right, metre).map((at) => grid(at, at, upper, bottom)),
    ...multiples(upper, bottom, metre).map((at) => grid(left, right, at, at)),
    ...cameras.flatMap((camera) => mapCamera(camera, size, frame)),
    svg('path', {d: cross, class: 'middle halo'}), svg('path', {d: cross, class: 'middle'}));
  const note = el('output', {class: 'note'});
  shown.addEventListener('pointermove', (event) => {
    const seen = shown.getBoundingClientRect();
    const at_x = left + (event.clientX - seen.left) / seen.width * (right - left);
    const at_z = upper + (event.clientY - seen.top) / seen.height * (bottom - upper);
    const error = height.error_mm[Math.round((at_z - map.z_from_m) / map.step_m)]
      ?.[Math.round((at_x - map.x_from_m) / map.step_m)];
    setText(note, error === undefined ? '' : `x ${fixed(at_x, 1)}, z ${fixed(at_z, 1)} m: ` +
      (error === null ? 'not seen by two' : mm(error)));
  });
  shown.addEventListener('pointerleave', () => setText(note, ''));
  return el('figure', {class: 'map'}, el('div', {class: 'frame'}, shown, note),
    el('figcaption', {}, words));
}

export function errorsSection(figures: RigFigures): HTMLElement[] {
  const {error_map: map} = figures;
  const top = mapScale(map);
  const target = shownTarget(figures);
  const ground = figures.has_floor
    ? 'Heights are those of ankles, hips and shoulders above the floor.'
    : `The floor was not detected, so heights are those of the ${target}, relative to the first ` +
      'camera.';
  return [
    lead('The expected error of a measured point (root mean square) if every camera that sees ' +
      `it detects it as accurately as the ${target}. The uncertainty of the cameras is ` +
      `included, occlusion by bodies is not. ${ground}`),
    scaleKey('Expected error of a point', `${Number(top.toPrecision(3))} mm`,
      el('span', {class: 'swatch', style: 'background: var(--seen-none)'}),
      'not seen by two cameras'),
    el('div', {class: 'maps'}, ...map.heights.map((height) => errorMap(figures, height, top))),
    el('p', {class: 'about'}, 'From above, squares of ' +
      `${map.heights[0].error_mm.length * map.step_m > 2 ? 'a metre' : 'ten centimetres'}, x to ` +
      'the right, z down; the cross is the middle of the volume, dashed lines are the cameras’ ' +
      'fields of view. Point at a place to read its value.'),
  ];
}
