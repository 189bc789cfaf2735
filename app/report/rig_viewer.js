// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Camera positions, their fields of view, and the positions of the board.

/** Returns three great circles of the ellipsoid of a covariance [mm^2], `scale` times too large:
 *  L u over unit circles u, with the covariance's Cholesky factor L. */
function sigmaCircles(covariance, scale) {
  const l = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  for (let i = 0; i < 3; ++i) {
    for (let k = 0; k <= i; ++k) {
      let rest = covariance[i][k];
      for (let j = 0; j < k; ++j) rest -= l[i][j] * l[k][j];
      if (i === k) l[i][i] = Math.sqrt(Math.max(rest, 0));
      else l[i][k] = l[k][k] > 1e-9 ? rest / l[k][k] : 0;
    }
  }
  const at = (u) => l.map((row) => scale / 1000 * dot(row, u));
  return [[0, 1], [1, 2], [2, 0]].map(([a, b]) => Array.from({length: 33}, (_, i) => {
    const u = [0, 0, 0];
    u[a] = Math.cos(2 * Math.PI * i / 32);
    u[b] = Math.sin(2 * Math.PI * i / 32);
    return at(u);
  }));
}

/** Returns the word for the calibration target. */
function shownTarget(figures) {
  return figures.target.startsWith('wand') ? 'wand' : 'board';
}

class RigStage {
  constructor(data) {
    this.cameras = data.figures.cameras;
    this.places = data.places;
    this.floorPlaces = data.floor_places;
    this.hasFloor = data.figures.has_floor;
    const points = [...this.places.flat(), ...this.floorPlaces.flat(),
      ...this.cameras.map((camera) => camera.centre_in_world_m)];
    // Without a known floor the grid is below everything.
    this.down = this.hasFloor ? 0
      : Math.min(...points.map((p) => p[1])) - 0.05 * data.figures.distance_m;
    this.points = points.map((p) => this.lifted(p));
    this.size = Math.max(data.figures.distance_m, 0.1);
    const sigma = Math.max(...this.cameras.map((camera) => Math.sqrt(Math.max(
      ...[0, 1, 2].map((i) => camera.centre_covariance_mm2[i][i])))), 1e-3);
    const room = 0.12 * this.size * 1000 / sigma;
    this.sigmaScale = room < 1 ? 1 : 10 ** Math.floor(Math.log10(room));
    this.capsules = new Capsules();
  }

  lifted(p) {
    return [p[0], p[1] - this.down, p[2]];
  }

  readTheme() {
    this.theme = {
      backdrop: rgb('stage'), ground: rgb('stage-floor'), grid: rgb('stage-grid'),
      sky: rgb('stage-sky'), bounce: rgb('stage-bounce'), line: rgb('stage-line'),
      shadow: parseFloat(cssColour('stage-shadow')), camera: rgb('subject'),
      sight: rgb('measured'), board: rgb('repaired'), floor: rgb('good'),
      doubt: rgb('inferred'),
    };
  }

  /** Returns a view of everything, from above and from the side with the fewest cameras. */
  view(aspect) {
    const [azimuth, height] = [0.6, 0.5];
    const right = [Math.cos(azimuth), 0, -Math.sin(azimuth)];
    const toward = [Math.sin(azimuth) * Math.cos(height), Math.sin(height),
      Math.cos(azimuth) * Math.cos(height)];
    const axes = [right, cross(toward, right), toward];
    const middle = axes.map((axis) => {
      const along = this.points.map((p) => dot(axis, p));
      return (Math.min(...along) + Math.max(...along)) / 2;
    });
    const slope = Math.tan(VIEW_ANGLE / 2);
    const rim = 0.12 * this.size;
    let distance = 0.6;
    for (const p of this.points) {
      const [x, y, z] = axes.map((axis, k) => dot(axis, p) - middle[k]);
      distance = Math.max(distance, z + (Math.abs(y) + rim) / slope,
        z + (Math.abs(x) + rim) / (slope * aspect));
    }
    const target = axes.reduce((sum, axis, k) => add(sum, scaled(axis, middle[k])),
      [0, 0, 0]);
    return {target, distance: 1.03 * distance, azimuth, height};
  }

  #lines(options) {
    const values = [];
    const line = (a, b, colour) => values.push(...a, ...colour, ...b, ...colour);
    const loop = (corners, colour) => corners.forEach((p, i) =>
      line(p, corners[(i + 1) % corners.length], colour));
    for (const camera of this.cameras) this.#frustum(camera, line, loop);
    if (options.places) {
      for (const corners of this.places) {
        if (corners.length > 1) loop(corners.map((p) => this.lifted(p)), this.theme.board);
      }
      for (const corners of this.floorPlaces) {
        const lifted = corners.map((p) => this.lifted(p));
        loop(lifted, this.theme.floor);
        if (lifted.length < 4) continue;
        line(lifted[0], lifted[2], this.theme.floor);
        line(lifted[1], lifted[3], this.theme.floor);
      }
    }
    if (options.doubt) {
      for (const camera of this.cameras) {
        const centre = this.lifted(camera.centre_in_world_m);
        for (const ring of sigmaCircles(camera.centre_covariance_mm2, this.sigmaScale)) {
          for (let i = 0; i + 1 < ring.length; ++i) {
            line(add(centre, ring[i]), add(centre, ring[i + 1]), this.theme.doubt);
          }
        }
      }
    }
    return new Float32Array(values);
  }

  #frustum(camera, line, loop) {
    const depth = 0.16 * this.size;
    const centre = this.lifted(camera.centre_in_world_m);
    const corner = (x, y) => add(centre, scaled(add(camera.forward_in_world, add(
      scaled(camera.right_in_world, (x - camera.centre_px[0]) / camera.focal_px[0]),
      scaled(camera.down_in_world, (y - camera.centre_px[1]) / camera.focal_px[1]))), depth));
    const [w, h] = [camera.width_px, camera.height_px];
    const corners = [corner(0, 0), corner(w, 0), corner(w, h), corner(0, h)];
    loop(corners, this.theme.sight);
    corners.forEach((p) => line(centre, p, this.theme.sight));
    // A mark on the picture's upper edge shows the camera's orientation.
    const top = corner(w / 2, -0.18 * h);
    line(corner(0.4 * w, 0), top, this.theme.sight);
    line(corner(0.6 * w, 0), top, this.theme.sight);
  }

  scene(orbit, aspect, options) {
    if (!this.theme) this.readTheme();
    this.capsules.clear();
    const girth = 0.011 * this.size;
    for (const camera of this.cameras) {
      const centre = this.lifted(camera.centre_in_world_m);
      const back = add(centre, scaled(camera.forward_in_world, -3 * girth));
      this.capsules.add(back, centre, 1.3 * girth, girth, this.theme.camera);
    }
    if (options.places) {
      for (const [p, ...rest] of this.places) {
        if (rest.length > 0) continue;
        this.capsules.add(this.lifted(p), this.lifted(p), girth / 2, girth / 2,
          this.theme.board);
      }
    }
    const eye = orbit.eye();
    const xs = this.points.map((p) => p[0]);
    const zs = this.points.map((p) => p[2]);
    const centre = [(Math.min(...xs) + Math.max(...xs)) / 2, 0,
      (Math.min(...zs) + Math.max(...zs)) / 2];
    const half = Math.max(...xs.map((x) => Math.abs(x - centre[0])),
      ...zs.map((z) => Math.abs(z - centre[2]))) + 0.5;
    return {
      capsules: this.capsules, eye, target: orbit.target, theme: this.theme,
      clipFromWorld: product(perspective(VIEW_ANGLE, aspect, 0.05, 80),
        lookAt(eye, orbit.target)),
      focal: 1 / Math.tan(VIEW_ANGLE / 2), lines: this.#lines(options),
      shadow: {centre, half},
    };
  }
}

class RigViewer {
  constructor(data, linesOnly) {
    this.stage = new RigStage(data);
    const target = shownTarget(data.figures);
    this.options = {places: true, doubt: true};
    this.canvas = el('canvas', {tabindex: 0, role: 'img', 'aria-label':
      `Cameras and the ${target} in three dimensions. Drag turns, plus and minus zoom.`,
    onkeydown: (event) => this.#key(event)});
    this.labels = el('div', {class: 'labels', 'aria-hidden': 'true'},
      ...this.stage.cameras.map((camera) => el('span', {}, camera.name)));
    this.drawing = (linesOnly ? null : ShadedDrawing.on(this.canvas)) ??
      new LineDrawing(this.canvas);
    this.orbit = new Orbit(this.canvas, () => this.redraw());
    const toggle = (option, label) => {
      const box = el('input', {type: 'checkbox', checked: true, onchange: () => {
        this.options[option] = box.checked;
        this.redraw();
      }});
      return el('label', {class: 'toggle'}, box, ` ${label}`);
    };
    this.root = el('div', {class: 'viewer rig'},
      el('div', {class: 'stage'}, this.canvas, this.labels),
      el('div', {class: 'controls'},
        toggle('places', target === 'wand' ? 'Wand' : 'Board'),
        toggle('doubt', 'Uncertainty'),
        el('button', {type: 'button', onclick: () => this.#frame()}, 'Reset view'),
        el('span', {class: 'clock'}, 'Drag turns, shift drag moves, the wheel zooms ' +
          'once the picture was clicked.')));
    new ResizeObserver(() => this.#resize()).observe(this.canvas);
    onThemeChange(() => {
      this.stage.readTheme();
      this.redraw();
    });
  }

  #aspect() {
    return this.canvas.clientWidth / Math.max(this.canvas.clientHeight, 1);
  }

  #frame() {
    this.orbit.frame(this.stage.view(this.#aspect()));
  }

  #resize() {
    const density = Math.min(devicePixelRatio || 1, 2);
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * density));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * density));
    if (this.orbit.touched) this.redraw();
    else this.#frame();
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.waiting = false;
    const scene = this.stage.scene(this.orbit, this.#aspect(), this.options);
    this.drawing.draw(scene);
    this.stage.cameras.forEach((camera, i) => {
      const node = this.labels.children[i];
      const above = add(this.stage.lifted(camera.centre_in_world_m),
        [0, 0.04 * this.stage.size, 0]);
      const at = projected(scene.clipFromWorld, above, this.canvas.clientWidth,
        this.canvas.clientHeight);
      node.hidden = !at;
      if (at) node.style.transform = `translate(${at.x}px, ${at.y}px) translate(-50%, -100%)`;
    });
  }

  #key(event) {
    const actions = {
      ArrowLeft: () => this.orbit.turn(-12, 0), ArrowRight: () => this.orbit.turn(12, 0),
      ArrowUp: () => this.orbit.turn(0, 12), ArrowDown: () => this.orbit.turn(0, -12),
      '+': () => this.orbit.zoom(0.9), '-': () => this.orbit.zoom(1 / 0.9),
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
  }
}

function layoutSection(figures, viewer) {
  const floor = figures.board_on_floor
    ? ' The green one, crossed out, is the board on the floor.'
    : figures.has_floor ? ' The grid is the floor.'
      : ' Nothing showed the floor: the grid is only a help to the eye.';
  const {sigmaScale: scale} = viewer.stage;
  return [
    el('p', {class: 'lead'}, 'Check that every camera stands and looks as in the room. ' +
      `Orange outlines are where the ${shownTarget(figures)} ` +
      `was.${floor} Rings around a camera are the uncertainty of its place (one sigma), ` +
      (scale > 1 ? `drawn ${scale} times too large.` : 'as large as it is.')),
    viewer.root,
  ];
}
