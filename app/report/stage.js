// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The scene: the bodies of one trial and its cameras.

const DOUBT_SCALE_M = 0.03; // Sigma at the far end of the colour scale.
const FOLLOW_BEYOND_M = 1.5; // A subject that travels farther is followed.

class Stage {
  constructor(trial, cameras) {
    this.bodies = trial.bodies.map((body) => new Body(body));
    standAbreast(this.bodies);
    this.figures = this.bodies.map((body) => new Figure(body));
    this.cameras = cameras;
    this.capsules = new Capsules();
    this.theme = null;
    this.shadowHalf = this.#shadowHalf();
  }

  get frames() {
    return Math.max(0, ...this.bodies.map((body) => body.frames));
  }

  get travels() {
    const {low, high} = this.#ranges([[1, 0, 0], [0, 0, 1]], false, true);
    return Math.max(high[0] - low[0], high[1] - low[1]) > FOLLOW_BEYOND_M;
  }

  /** Visits sampled places of the bodies (or of the subject's root only), relative to the
   *  subject's place if it is followed. */
  #visit(followed, rootOnly, then) {
    const step = Math.max(1, Math.floor(this.frames / 60));
    for (let frame = 0; frame < this.frames; frame += step) {
      const root = followed ? this.standsAt(frame) : [0, 0, 0];
      for (const body of rootOnly ? this.bodies.slice(0, 1) : this.bodies) {
        if (frame >= body.frames) continue;
        body.show(frame);
        const count = rootOnly ? 1 : body.parents.length;
        for (let i = 0; i < count; ++i) then(subtract(body.at(i), root));
      }
    }
  }

  #ranges(axes, followed, rootOnly = false) {
    const low = axes.map(() => Infinity);
    const high = axes.map(() => -Infinity);
    this.#visit(followed, rootOnly, (p) => axes.forEach((axis, k) => {
      const value = dot(axis, p);
      low[k] = Math.min(low[k], value);
      high[k] = Math.max(high[k], value);
    }));
    return {low, high};
  }

  #shadowHalf() {
    if (this.frames === 0) return 1;
    const {low, high} = this.#ranges([[1, 0, 0], [0, 0, 1]], true);
    return Math.max(high[0], high[1], -low[0], -low[1]) + 0.9;
  }

  /** Returns the subject's root on the floor, interpolated between frames. */
  standsAt(time) {
    const [subject] = this.bodies;
    const last = subject.frames - 1;
    const frame = Math.min(Math.max(time, 0), last);
    const a = subject.recorded(Math.floor(frame), 0);
    const b = subject.recorded(Math.min(Math.floor(frame) + 1, last), 0);
    const p = mix(a, b, frame - Math.floor(frame));
    return [p[0], 0, p[2]];
  }

  /** Returns the mean heading of the subject: angle about Y from +Z. [rad] */
  heading() {
    const [subject] = this.bodies;
    let sum = [0, 0, 0];
    const step = Math.max(1, Math.floor(subject.frames / 30));
    for (let frame = 0; frame < subject.frames; frame += step) {
      subject.show(frame);
      sum = add(sum, subject.turned(0, [0, 0, 1]));
    }
    return Math.atan2(sum[0], sum[2]);
  }

  /** Returns the view for Orbit.frame() that contains the whole motion in a picture of this
   *  aspect. */
  view(followed, withCameras, aspect) {
    const [azimuth, height] = [this.heading() + 0.55, 0.2];
    const right = [Math.cos(azimuth), 0, -Math.sin(azimuth)];
    const toward = [Math.sin(azimuth) * Math.cos(height), Math.sin(height),
      Math.cos(azimuth) * Math.cos(height)];
    const axes = [right, cross(toward, right), toward];
    const {low, high} = this.#ranges(axes, followed);
    const start = followed ? this.standsAt(0) : [0, 0, 0];
    const cameras = withCameras
      ? this.cameras.map((camera) => subtract(camera.centre_in_world_m, start)) : [];
    const middle = axes.map((axis, k) => {
      const along = cameras.map((p) => dot(axis, p));
      return (Math.min(low[k], ...along) + Math.max(high[k], ...along)) / 2;
    });
    // Far enough for every point, with a margin for the body around the joints.
    const flesh = 0.2; // [m]
    const slope = Math.tan(VIEW_ANGLE / 2);
    let distance = 1;
    const include = (p) => {
      const [x, y, z] = axes.map((axis, k) => dot(axis, p) - middle[k]);
      distance = Math.max(distance, z + (Math.abs(y) + flesh) / slope,
        z + (Math.abs(x) + flesh) / (slope * aspect));
    };
    this.#visit(followed, false, include);
    cameras.forEach(include);
    const target = axes.reduce((sum, axis, k) => add(sum, scaled(axis, middle[k])), start);
    return {target, distance: 1.04 * distance, azimuth, height};
  }

  readTheme() {
    this.theme = {
      backdrop: rgb('stage'), ground: rgb('stage-floor'), grid: rgb('stage-grid'),
      sky: rgb('stage-sky'), bounce: rgb('stage-bounce'), line: rgb('stage-line'),
      shadow: parseFloat(cssColour('stage-shadow')),
      subject: rgb('subject'), avatar: rgb('avatar'),
      sources: SOURCES.map((source) => rgb(source)),
    };
  }

  #paint(index, colouring) {
    const body = this.bodies[index];
    const {theme} = this;
    if (index > 0) return () => theme.avatar;
    if (colouring === 'source' && body.source) {
      return (joint) => theme.sources[body.sourceNow(joint)];
    }
    if (colouring === 'doubt' && body.sigma) {
      return (joint) => doubtColour(body.sigmaNow(joint) / DOUBT_SCALE_M);
    }
    return () => theme.subject;
  }

  /** Returns the scene at `time` [frames] for draw(). */
  scene(time, orbit, aspect, {colouring, cameras}) {
    if (!this.theme) this.readTheme();
    this.capsules.clear();
    this.bodies.forEach((body, i) => {
      if (body.frames === 0) return;
      body.show(time);
      this.figures[i].build(this.capsules, this.#paint(i, colouring));
    });
    const eye = orbit.eye();
    return {
      capsules: this.capsules, eye, target: orbit.target, theme: this.theme,
      clipFromWorld: product(perspective(VIEW_ANGLE, aspect, 0.05, 80),
        lookAt(eye, orbit.target)),
      focal: 1 / Math.tan(VIEW_ANGLE / 2),
      lines: cameras ? this.#frusta() : new Float32Array(0),
      shadow: {centre: this.frames > 0 ? this.standsAt(time) : [0, 0, 0],
        half: this.shadowHalf},
    };
  }

  #frusta() {
    const depth = 0.35; // [m]
    const values = [];
    for (const camera of this.cameras) {
      const corner = (x, y) => add(camera.centre_in_world_m, add(
        scaled(camera.forward_in_world, depth), add(
          scaled(camera.right_in_world,
            depth * (x - camera.centre_px[0]) / camera.focal_px[0]),
          scaled(camera.down_in_world,
            depth * (y - camera.centre_px[1]) / camera.focal_px[1]))));
      const [w, h] = [camera.width_px, camera.height_px];
      const corners = [corner(0, 0), corner(w, 0), corner(w, h), corner(0, h)];
      corners.forEach((p, i) => {
        for (const end of [p, corners[(i + 1) % 4], p, camera.centre_in_world_m]) {
          values.push(...end, ...this.theme.line);
        }
      });
    }
    return new Float32Array(values);
  }

  /** Returns the names and their places for the last scene. */
  labels(withCameras) {
    const labels = this.frames === 0 ? [] : this.bodies.map((body, k) => {
      let top = -Infinity;
      for (let i = 1; i < body.points.length; i += 3) top = Math.max(top, body.points[i]);
      // The head's joint is at the base of the skull; not every body has the top of the head.
      if (!body.tips.has(body.places.get('head'))) top += 0.13 * this.figures[k].stature;
      const [x, , z] = body.at(0);
      return {text: body.name, at: [x, top + 0.04, z]};
    });
    if (!withCameras) return labels;
    return labels.concat(this.cameras.map((camera) =>
      ({text: camera.name, at: add(camera.centre_in_world_m, [0, 0.12, 0])})));
  }
}
