// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The floor from above, in the colours of the expected error.

/** Rounds up to 1, 2, 5, 10, 20... */
function roundAbove(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-9)));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= value * 0.9999);
}

/** Returns the error at the top of the scale. Most places have less. The scale is limited,
 *  because the error grows without bound at the edges. [mm] */
function mapScale(map) {
  const usual = map.heights.map((height) => height.median_error_mm ?? 0);
  const most = map.heights.map((height) => height.p95_error_mm ?? 0);
  return roundAbove(Math.max(1e-3, Math.min(3 * Math.max(...usual), Math.max(...most))));
}

function mapKey(top) {
  const stops = [0, 0.2, 0.4, 0.6, 0.8, 1].map((s) => cssRgb(doubtColour(s))).join(', ');
  return el('p', {class: 'key'},
    el('span', {}, 'Expected error of a point'),
    el('span', {class: 'ramp'},
      el('i', {style: `background: linear-gradient(to right, ${stops})`}),
      el('span', {}, ...[0, 0.5, 1].map((share) => el('b', {},
        `${Number((share * top).toPrecision(3))}${share === 1 ? ' mm and more' : ''}`)))),
    el('span', {class: 'swatch', style: 'background: var(--seen-none)'}),
    el('span', {}, 'not seen by two cameras'));
}

/** Returns the URL of a picture with one pixel per place. */
function mapPicture(rows, top) {
  const canvas = el('canvas', {width: rows[0].length, height: rows.length});
  const context = canvas.getContext('2d');
  rows.forEach((row, z) => row.forEach((error, x) => {
    if (error === null) return;
    context.fillStyle = cssRgb(doubtColour(error / top));
    context.fillRect(x, z, 1, 1);
  }));
  return canvas.toDataURL();
}

/** Returns the direction of a pixel column on the floor; null for straight down. */
function headingOf(camera, x) {
  const way = add(camera.forward_in_world, scaled(camera.right_in_world,
    (x - camera.centre_px[0]) / camera.focal_px[0]));
  const length = Math.hypot(way[0], way[2]);
  return length < 1e-6 ? null : [way[0] / length, way[2] / length];
}

function mapCamera(camera, size, reach, frame) {
  const at = [camera.centre_in_world_m[0], camera.centre_in_world_m[2]];
  const along = (way, length) => [at[0] + length * way[0], at[1] + length * way[1]];
  const points = (list) => list.map((p) => p.map((v) => v.toFixed(3)).join(',')).join(' ');
  const [left, ahead, right] = [0, camera.centre_px[0], camera.width_px].map((x) =>
    headingOf(camera, x));
  const shapes = [];
  if (left && right) {
    shapes.push(svg('polygon', {class: 'cone',
      points: points([at, along(left, reach), along(right, reach)])}));
  }
  const way = ahead ?? [0, 1];
  const aside = [-way[1], way[0]];
  const corner = (u, v) => [at[0] + size * (u * way[0] + v * aside[0]),
    at[1] + size * (u * way[1] + v * aside[1])];
  shapes.push(svg('polygon', {class: 'body',
    points: points([corner(-0.5, 0), corner(0.6, 0.6), corner(0.6, -0.6)])}));
  // Letters are about 0.6 of their height wide; the name is kept inside.
  const half = 0.34 * size * (camera.name.length + 1);
  const x = Math.min(Math.max(at[0], frame.left + half), frame.right - half);
  const y = Math.min(Math.max(at[1] + (way[1] > 0 ? -0.9 : 1.6) * size,
    frame.top + size), frame.bottom - 0.3 * size);
  shapes.push(svg('text', {x, y, 'font-size': size, 'stroke-width': 0.15 * size}, camera.name));
  return shapes;
}

function mapFrame(figures) {
  const map = figures.error_map;
  const rows = map.heights[0].error_mm;
  const half = map.step_m / 2;
  const box = {x0: map.x_from_m - half, x1: map.x_from_m + map.step_m * rows[0].length - half,
    z0: map.z_from_m - half, z1: map.z_from_m + map.step_m * rows.length - half};
  const extent = Math.max(box.x1 - box.x0, box.z1 - box.z0);
  const rim = 0.13 * extent;
  const places = figures.cameras.map((camera) => camera.centre_in_world_m);
  return {...box, extent,
    left: Math.min(box.x0, ...places.map((p) => p[0] - rim)),
    right: Math.max(box.x1, ...places.map((p) => p[0] + rim)),
    top: Math.min(box.z0, ...places.map((p) => p[2] - rim)),
    bottom: Math.max(box.z1, ...places.map((p) => p[2] + rim))};
}

function errorMap(figures, height, top) {
  const map = figures.error_map;
  const frame = mapFrame(figures);
  const {left, right, top: upper, bottom} = frame;
  const size = (right - left) / 24;
  const metre = frame.extent > 2 ? 1 : 0.1;
  const marks = (from, to) => Array.from({length: Math.max(0, Math.floor(to / metre) -
    Math.ceil(from / metre) + 1)}, (_, i) => metre * (Math.ceil(from / metre) + i));
  const [mx, , mz] = figures.middle_in_world_m;
  const cross = `M${mx - size / 2} ${mz}h${size}M${mx} ${mz - size / 2}v${size}`;
  const words = `At ${height.height} height, ${fixed(height.height_m, 2)} m: half of the ` +
    `places better than ${fixed(height.median_error_mm, 1)} mm, ` +
    `${fixed(height.seen_percent, 0)} % seen by two`;
  const picture = svg('svg', {viewBox: `${left} ${upper} ${right - left} ${bottom - upper}`,
    role: 'img', 'aria-label': words},
  svg('rect', {class: 'blind', x: frame.x0, y: frame.z0, width: frame.x1 - frame.x0,
    height: frame.z1 - frame.z0}),
  svg('image', {x: frame.x0, y: frame.z0, width: frame.x1 - frame.x0,
    height: frame.z1 - frame.z0, preserveAspectRatio: 'none',
    href: mapPicture(height.error_mm, top)}),
  ...marks(left, right).map((x) => svg('line', {class: 'metre', x1: x, x2: x, y1: upper,
    y2: bottom, 'stroke-opacity': 0.35})),
  ...marks(upper, bottom).map((z) => svg('line', {class: 'metre', x1: left, x2: right,
    y1: z, y2: z, 'stroke-opacity': 0.35})),
  ...figures.cameras.flatMap((camera) =>
    mapCamera(camera, size, 2 * (right - left + bottom - upper), frame)),
  svg('path', {d: cross, class: 'middle halo'}), svg('path', {d: cross, class: 'middle'}));
  const note = el('div', {class: 'note', role: 'status'});
  picture.addEventListener('pointermove', (event) => {
    const seen = picture.getBoundingClientRect();
    const x = left + (event.clientX - seen.left) / seen.width * (right - left);
    const z = upper + (event.clientY - seen.top) / seen.height * (bottom - upper);
    const row = height.error_mm[Math.round((z - map.z_from_m) / map.step_m)];
    const error = row?.[Math.round((x - map.x_from_m) / map.step_m)];
    note.textContent = error === undefined ? '' : `x ${fixed(x, 1)}, z ${fixed(z, 1)} m: ` +
      (error === null ? 'not seen by two' : `${fixed(error, 1)} mm`);
  });
  picture.addEventListener('pointerleave', () => { note.textContent = ''; });
  return el('figure', {class: 'map'}, el('div', {class: 'frame'}, picture, note),
    el('figcaption', {}, words));
}

function errorsSection(figures) {
  const map = figures.error_map;
  const top = mapScale(map);
  const ground = figures.has_floor
    ? 'Heights are above the floor: where ankles, hips and shoulders are.'
    : 'As nothing showed the floor the world has no ground: heights are those at which ' +
      `the ${shownTarget(figures)} was held, from the first camera’s.`;
  return [
    el('p', {class: 'lead'}, 'How far a point would be from the truth (root mean square) ' +
      'if every camera that sees it found it as well as it found the ' +
      `${shownTarget(figures)}. Cameras’ own ` +
      `uncertainties are included, occlusion by bodies is not. ${ground}`),
    mapKey(top),
    el('div', {class: 'maps'}, ...map.heights.map((height) =>
      errorMap(figures, height, top))),
    el('p', {class: 'about'}, `From above, squares of ${map.heights[0].error_mm.length *
      map.step_m > 2 ? 'a metre' : 'ten centimetres'}, x to the right, z down; the cross ` +
      'is the middle of the verdict, dashed lines are what cameras take in. ' +
      'Point at a place for its figure.'),
  ];
}
