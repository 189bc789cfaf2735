// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Views of the board or wand per camera: coverage, residuals, and tilt.

function coveragePicture(camera) {
  const columns = camera.coverage_columns;
  const cells = camera.coverage_corners;
  const rows = cells.length / columns;
  const [w, h] = [camera.width_px / columns, camera.height_px / rows];
  const most = Math.log1p(Math.max(...cells, 1));
  const words = `${fixed(camera.coverage_percent, 0)} % of the picture was shown`;
  return el('figure', {class: 'coverage'},
    svg('svg', {viewBox: `0 0 ${camera.width_px} ${camera.height_px}`, role: 'img',
      'aria-label': words},
    ...cells.map((count, i) => svg('rect', {x: (i % columns) * w,
      y: Math.floor(i / columns) * h, width: w, height: h,
      class: count === 0 ? 'empty' : null,
      'fill-opacity': count === 0 ? null : (0.2 + 0.8 * Math.log1p(count) / most).toFixed(2),
    }, svg('title', {}, plural(count, 'corner', 'corners')))),
    svg('line', {x1: camera.width_px / 2, x2: camera.width_px / 2, y1: 0,
      y2: camera.height_px}),
    svg('line', {x1: 0, x2: camera.width_px, y1: camera.height_px / 2,
      y2: camera.height_px / 2})),
    el('figcaption', {}, `Coverage: ${words}; a fuller colour is more often.`));
}

/** Returns the scale of drawn errors: most arrows are a few hundredths of the width. */
function arrowScale(camera, arrows) {
  const lengths = arrows.map(([, , ex, ey]) => Math.hypot(ex, ey)).sort((a, b) => a - b);
  const long = lengths[Math.floor(0.9 * (lengths.length - 1))] || 1;
  const scale = 0.035 * camera.width_px / long;
  return scale <= 1 ? 1 : roundAbove(scale / 2);
}

function residualPicture(camera, page) {
  const scale = arrowScale(camera, page.arrows.length > 0 ? page.arrows : page.strays);
  const longest = 0.08 * camera.width_px;
  const dot = camera.width_px / 260;
  const end = ([x, y, ex, ey]) => {
    const s = Math.min(scale, longest / (Math.hypot(ex, ey) || 1));
    return {x1: x, y1: y, x2: (x + s * ex).toFixed(1), y2: (y + s * ey).toFixed(1)};
  };
  const strays = page.strays.map((arrow) => svg('g', {},
    svg('circle', {class: 'stray', cx: arrow[0], cy: arrow[1], r: 2 * dot}),
    svg('line', {class: 'stray', ...end(arrow)}),
    svg('title', {}, `left out: ${fixed(Math.hypot(arrow[2], arrow[3]), 1)} px`)));
  const words = `Residuals × ${scale}: seen less expected`;
  return el('figure', {class: 'residuals'},
    svg('svg', {viewBox: `0 0 ${camera.width_px} ${camera.height_px}`, role: 'img',
      'aria-label': `${words}, ${plural(strays.length, 'outlier', 'outliers')}`},
    // Outliers are drawn below, so that they do not hide inliers.
    ...strays,
    ...page.arrows.flatMap((arrow) => [
      svg('circle', {class: 'tail', cx: arrow[0], cy: arrow[1], r: dot / 1.6}),
      svg('line', {class: 'arrow', ...end(arrow)})])),
    el('figcaption', {}, `${words}.`, ...(strays.length === 0 ? []
      : [' ', el('span', {class: 'stray'}, '○ left out'), ', arrows cut short'])));
}

const WIDEST_TILT = 75; // [deg] at the rim

function tiltPicture(page) {
  const radius = (tilt) => 50 * Math.min(tilt, WIDEST_TILT) / WIDEST_TILT;
  return el('figure', {class: 'tilts'},
    svg('svg', {viewBox: '-54 -54 108 108', role: 'img',
      'aria-label': `Tilt of the board in ${plural(page.tilts.length, 'view', 'views')}`},
    ...[30, 45, 60, 75].map((tilt) => svg('circle', {class: 'ring', r: radius(tilt)})),
    svg('circle', {class: 'flat', r: radius(15)}),
    ...page.tilts.map(([tilt, azimuth, distance]) => {
      const angle = azimuth * Math.PI / 180;
      return svg('circle', {class: 'view', r: 1.6, cx: (radius(tilt) *
        Math.cos(angle)).toFixed(1), cy: (radius(tilt) * Math.sin(angle)).toFixed(1)},
      svg('title', {}, `${fixed(tilt, 0)}°, ${fixed(distance, 1)} m away`));
    }),
    ...[30, 60].map((tilt) => svg('text', {x: 0, y: -radius(tilt) + 2}, `${tilt}°`))),
    el('figcaption', {}, 'Tilt of the board and its direction. Views near the centre add ' +
      'little about a lens.'));
}

function seenWords(camera) {
  const parts = [`${plural(camera.views, 'view', 'views')}`,
    `${fixed(camera.inlier_rms_px, 2)} px`,
    `lens ${camera.lens}, focal length ± ${fixed(camera.focal_sigma_px, 1)} px`,
    camera.centre_sigma_mm > 0 ? `place ± ${fixed(camera.centre_sigma_mm, 1)} mm`
      : 'its place is the origin'];
  if (camera.outlier_corners > 0) {
    const share = 100 * camera.outlier_corners / camera.corners;
    parts.push(`${fixed(share, share < 1 ? 1 : 0)} % of the corners left out`);
  }
  return parts.join(' · ');
}

function picturesSection(figures, cameras) {
  return [
    el('p', {class: 'lead'}, 'Good is a picture filled to its edges, arrows that are short ' +
      `and point anywhere, and a ${shownTarget(figures)} that was ` +
      `${shownTarget(figures) === 'wand' ? 'turned' : 'tilted'} to all sides. Arrows that ` +
      'agree with their neighbours show what the lens model misses.'),
    ...figures.cameras.map((camera, i) => el('article', {class: 'seen'},
      el('h3', {}, camera.name), el('p', {class: 'about'}, seenWords(camera)),
      el('div', {class: 'seen-figures'}, coveragePicture(camera),
        residualPicture(camera, cameras[i]),
        cameras[i].tilts.length > 0 ? tiltPicture(cameras[i]) : null))),
  ];
}
