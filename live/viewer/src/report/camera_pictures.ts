// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Views of the board or wand per camera: coverage, residuals, and tilt.

import {el, svg} from '../base/elements';
import {fixed, plural} from '../base/words';
import {lead, picture, px, withUnit} from './common';
import type {CalibratedCamera, RigData, SeenCorners} from './data';
import {roundAbove} from './error_map';
import {shownTarget} from './rig_viewer';

const WIDEST_TILT = 75; // [deg] at the rim

function coveragePicture(camera: CalibratedCamera): HTMLElement {
  const {coverage_columns: columns, coverage_corners: cells, width_px, height_px} = camera;
  const [width, height] = [width_px / columns, height_px * columns / cells.length];
  const most = Math.log1p(Math.max(...cells, 1));
  const words = `${fixed(camera.coverage_percent, 0)} % of the picture was covered`;
  return el('figure', {class: 'coverage'}, picture([0, 0, width_px, height_px], words,
    ...cells.map((count, i) => svg('rect', {x: (i % columns) * width,
      y: Math.floor(i / columns) * height, width, height, class: count === 0 && 'empty',
      'fill-opacity': count > 0 && (0.2 + 0.8 * Math.log1p(count) / most).toFixed(2),
    }, svg('title', {}, plural(count, 'corner')))),
    svg('line', {x1: width_px / 2, x2: width_px / 2, y1: 0, y2: height_px}),
    svg('line', {x1: 0, x2: width_px, y1: height_px / 2, y2: height_px / 2})),
  el('figcaption', {}, `Coverage: ${words}; a stronger colour means more often.`));
}

/** Returns the scale of drawn errors: most arrows are a few hundredths of the width. */
function arrowScale({width_px}: CalibratedCamera, arrows: SeenCorners['arrows']): number {
  const lengths = arrows.map(([, , ex, ey]) => Math.hypot(ex, ey)).sort((a, b) => a - b);
  const long = lengths[Math.floor(0.9 * (lengths.length - 1))] || 1;
  const scale = 0.035 * width_px / long;
  return scale <= 1 ? 1 : roundAbove(scale / 2);
}

function residualPicture(camera: CalibratedCamera, {arrows, strays}: SeenCorners): HTMLElement {
  const {width_px, height_px} = camera;
  const scale = arrowScale(camera, arrows.length > 0 ? arrows : strays);
  const dot = width_px / 260;
  const arrow = ([x, y, ex, ey]: number[], kind: string): SVGElement => {
    const s = Math.min(scale, 0.08 * width_px / (Math.hypot(ex, ey) || 1));
    return svg('line', {class: kind, x1: x, y1: y, x2: (x + s * ex).toFixed(1),
      y2: (y + s * ey).toFixed(1)});
  };
  const words = `Residuals × ${scale}: observed minus expected`;
  return el('figure', {class: 'residuals'}, picture([0, 0, width_px, height_px],
    `${words}, ${plural(strays.length, 'outlier')}`,
    // Outliers are drawn below, so that they do not hide inliers.
    ...strays.map((stray) => svg('g', {},
      svg('circle', {class: 'stray', cx: stray[0], cy: stray[1], r: 2 * dot}),
      arrow(stray, 'stray'),
      svg('title', {}, `left out: ${px(Math.hypot(stray[2], stray[3]), 1)}`))),
    ...arrows.flatMap((seen) => [
      svg('circle', {class: 'tail', cx: seen[0], cy: seen[1], r: dot / 1.6}),
      arrow(seen, 'arrow')])),
  el('figcaption', {}, `${words}.`, ...(strays.length === 0 ? []
    : [' ', el('span', {class: 'stray'}, '○ left out'), ', arrows shortened'])));
}

function tiltPicture({tilts}: SeenCorners): HTMLElement | null {
  if (tilts.length === 0) return null;
  const radius = (tilt: number): number => 50 * Math.min(tilt, WIDEST_TILT) / WIDEST_TILT;
  return el('figure', {class: 'tilts'}, picture([-54, -54, 108, 108],
    `Tilt of the board in ${plural(tilts.length, 'view')}`,
    ...[30, 45, 60, 75].map((tilt) => svg('circle', {class: 'ring', r: radius(tilt)})),
    svg('circle', {class: 'flat', r: radius(15)}),
    ...tilts.map(([tilt, azimuth, distance]) => {
      const angle = azimuth * Math.PI / 180;
      return svg('circle', {class: 'view', r: 1.6, cx: (radius(tilt) * Math.cos(angle)).toFixed(1),
        cy: (radius(tilt) * Math.sin(angle)).toFixed(1)},
      svg('title', {}, `${fixed(tilt, 0)}°, ${fixed(distance, 1)} m away`));
    }),
    ...[30, 60].map((tilt) => svg('text', {x: 0, y: -radius(tilt) + 2}, `${tilt}°`))),
  el('figcaption', {}, 'Tilt of the board and its direction. Views near the centre contribute ' +
    'little to the lens parameters.'));
}

function seenWords(camera: CalibratedCamera): string {
  const parts = [plural(camera.views, 'view'), px(camera.inlier_rms_px),
    `lens ${camera.lens}, focal length ± ${px(camera.focal_sigma_px, 1)}`,
    camera.centre_sigma_mm > 0 ? `place ± ${withUnit(camera.centre_sigma_mm, 1, 'mm')}`
      : 'its position is the origin'];
  if (camera.outlier_corners > 0) {
    const share = 100 * camera.outlier_corners / camera.corners;
    parts.push(`${fixed(share, share < 1 ? 1 : 0)} % of the corners left out`);
  }
  return parts.join(' · ');
}

export function picturesSection({figures, cameras}: RigData): HTMLElement[] {
  const target = shownTarget(figures);
  return [
    lead('In a good calibration, coverage reaches the edges of the picture, arrows are short ' +
      `and point in random directions, and the ${target} was ` +
      `${target === 'wand' ? 'turned' : 'tilted'} in all directions. Neighbouring arrows with ` +
      'the same direction show an error of the lens model.'),
    ...figures.cameras.map((camera, i) => el('article', {class: 'seen'},
      el('h3', {}, camera.name), el('p', {class: 'about'}, seenWords(camera)),
      el('div', {class: 'seen-figures'}, coveragePicture(camera),
        residualPicture(camera, cameras[i]), tiltPicture(cameras[i])))),
  ];
}
