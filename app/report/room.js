// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The cameras: figures and positions.

/** One view of the room along an axis. `flat` takes a world point to the paper [m]. */
function roomView(title, flat, cameras, way, grounded) {
  const depth = 0.7; // [m] of the pyramids
  const shapes = cameras.map((camera) => {
    const edge = (sx, sy) => add(camera.centre_in_world_m, scaled(add(
      camera.forward_in_world, add(
        scaled(camera.right_in_world, sx * camera.width_px / 2 / camera.focal_px[0]),
        scaled(camera.down_in_world, sy * camera.height_px / 2 / camera.focal_px[1]))),
    depth));
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => flat(edge(x, y)));
    return {name: camera.name, at: flat(camera.centre_in_world_m), corners};
  });
  const path = way.map(flat);
  const points = [[0, 0], ...path, ...shapes.flatMap((s) => [s.at, ...s.corners])];
  const range = (k) => [Math.min(...points.map((p) => p[k])) - 0.5,
    Math.max(...points.map((p) => p[k])) + 0.5];
  const [[x0, x1], [y0, y1]] = [range(0), range(1)];
  const size = Math.max(x1 - x0, 1);
  const text = size / 26;
  const list = (corners) => corners.map((p) => p.map((v) => v.toFixed(3)).join(',')).join(' ');
  const metre = (from, to) => Array.from({length: Math.max(0, Math.floor(to) -
    Math.ceil(from) + 1)}, (_, i) => Math.ceil(from) + i);
  return el('figure', {class: 'room'},
    svg('svg', {viewBox: `${x0} ${y0} ${x1 - x0} ${y1 - y0}`, role: 'img',
      'aria-label': `${title}: ${cameras.map((camera) => camera.name).join(', ')}`},
    ...metre(x0, x1).map((x) => svg('line', {x1: x, x2: x, y1: y0, y2: y1, class: 'grid'})),
    ...metre(y0, y1).map((y) => svg('line', {x1: x0, x2: x1, y1: y, y2: y, class: 'grid'})),
    grounded ? svg('line', {x1: x0, x2: x1, y1: 0, y2: 0, class: 'floor'}) : null,
    svg('polyline', {points: list(path), class: 'way'}),
    svg('path', {d: 'M-0.12 0H0.12M0-0.12V0.12', class: 'origin'}),
    ...shapes.flatMap((s) => [
      ...s.corners.map((corner, i) => svg('polygon', {class: 'sight',
        points: list([s.at, corner, s.corners[(i + 1) % 4]])})),
      svg('circle', {cx: s.at[0], cy: s.at[1], r: text / 3.2, class: 'camera'}),
      svg('text', {x: s.at[0], y: s.at[1] - text * 0.7, 'font-size': text,
        class: 'name'}, s.name)])),
    el('figcaption', {}, title));
}

function camerasSection(calibration, trial, hasPage) {
  const {cameras} = calibration;
  const [subject] = trial ? trial.bodies.map((body) => new Body(body)) : [];
  const way = subject && subject.frames > 0
    ? Array.from({length: subject.frames}, (_, frame) => subject.recorded(frame, 0)) : [];
  return [
    el('p', {class: 'lead'}, `The board lies ${fixed(calibration.rms_px, 2)} px from where ` +
      'the cameras expect it. Coverage is the share of the picture in which it was shown: ' +
      'lenses are known only there. ',
      // `marey view` serves no file other than its own report.
      hasPage && !SERVED ? el('a', {href: './calibration.html'}, 'More in the calibration’s own page')
        : null),
    table([
      {title: 'Camera', cell: (camera) => camera.name},
      {title: 'Picture', number: true, cell: (c) => `${c.width_px} × ${c.height_px}`},
      {title: 'Focal length', number: true, cell: (camera) =>
        `${fixed(camera.focal_px[0], 1)} ± ${fixed(camera.focal_sigma_px, 1)} px`},
      {title: 'RMS', number: true, cell: (camera) => `${fixed(camera.rms_px, 2)} px`},
      {title: '95 %', number: true, cell: (camera) => `${fixed(camera.p95_px, 2)} px`},
      {title: 'Place', number: true, cell: (camera) =>
        `± ${fixed(camera.centre_sigma_mm, 1)} mm`},
      {title: 'Coverage', number: true, cell: (c) => `${fixed(c.coverage_percent, 0)} %`},
      {title: 'Views', number: true, cell: (camera) => String(camera.views)},
    ], cameras, 'Calibration of every camera'),
    el('div', {class: 'rooms'},
      roomView('From above, in metre squares; the line is the way of the hips',
        (p) => [p[0], p[2]], cameras, way, false),
      roomView('From the front; the floor is the thick line',
        (p) => [p[0], -p[1]], cameras, way, true)),
  ];
}
