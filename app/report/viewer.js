// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The viewer: a canvas with the moving bodies and its controls.

const SPEEDS = [0.1, 0.25, 0.5, 1, 2];
const KEYS = [
  ['space', 'play, pause'], ['← →', 'one frame'], ['shift ← →', 'one second'],
  ['↑ ↓ + −', 'zoom'], ['home', 'first frame'], ['drag', 'turn'],
  ['shift drag', 'move'], ['two fingers', 'zoom, move'], ['double click', 'first view'],
];

class Viewer {
  constructor(player, options = {}) {
    this.player = player;
    this.options = {colouring: 'source', cameras: false, follow: false};
    this.#makeCanvas(options.lines);
    this.orbit = new Orbit(this.canvas, () => this.redraw());
    this.#makeControls();
    this.root = el('div', {class: 'viewer'},
      el('div', {class: 'stage'}, this.canvas, this.labels, this.legend),
      this.scrub, this.controls, this.help);
    new ResizeObserver(() => this.#resize()).observe(this.canvas);
    onThemeChange(() => {
      this.stage?.readTheme();
      this.redraw();
    });
  }

  #makeCanvas(linesOnly) {
    this.canvas = el('canvas', {tabindex: 0, role: 'img', 'aria-label':
      'The motion in three dimensions. Space plays, arrow keys step.',
    onkeydown: (event) => this.#key(event)});
    this.labels = el('div', {class: 'labels', 'aria-hidden': 'true'});
    this.legend = el('div', {class: 'stage-legend'});
    this.drawing = (linesOnly ? null : ShadedDrawing.on(this.canvas)) ??
      new LineDrawing(this.canvas);
    this.canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault(); // Otherwise it is never restored.
      this.drawing = null;
    });
    this.canvas.addEventListener('webglcontextrestored', () => {
      this.drawing = ShadedDrawing.on(this.canvas);
      this.redraw();
    });
  }

  #makeControls() {
    const {player} = this;
    this.button = el('button', {type: 'button', class: 'play',
      onclick: () => player.play(!player.playing)});
    this.range = el('input', {type: 'range', min: 0, step: 1, 'aria-label': 'Frame',
      oninput: () => {
        player.play(false);
        player.seek(Number(this.range.value));
      },
      onkeydown: (event) => { if (event.key === ' ') this.#key(event); }});
    this.gaps = el('canvas', {class: 'gaps', 'aria-hidden': 'true'});
    this.scrub = el('div', {class: 'scrub'}, this.button,
      el('div', {class: 'track'}, this.range, this.gaps));
    this.clock = el('output', {class: 'clock'});
    const choice = (label, select) => el('label', {}, `${label} `, select);
    this.speed = el('select', {onchange: () => { player.speed = Number(this.speed.value); }},
      ...SPEEDS.map((speed) => el('option', {value: speed, selected: speed === 1},
        `${speed} ×`)));
    this.colouring = el('select', {onchange: () => {
      this.options.colouring = this.colouring.value;
      this.#showLegend();
      this.redraw();
    }},
    el('option', {value: 'source'}, 'source'), el('option', {value: 'doubt'}, 'doubt'),
    el('option', {value: 'plain'}, 'none'));
    this.controls = el('div', {class: 'controls'}, this.clock, choice('Speed', this.speed),
      choice('Colour by', this.colouring), this.#toggle('cameras', 'Cameras'),
      this.#toggle('follow', 'Follow'),
      el('button', {type: 'button', onclick: () => this.#frame()}, 'Reset view'));
    this.help = el('details', {class: 'keys'}, el('summary', {}, 'Keys and gestures'),
      el('p', {}, ...KEYS.flatMap(([key, what]) => [el('kbd', {}, key), ` ${what}  `]),
        el('span', {}, 'The wheel zooms once the picture was clicked.')));
  }

  #toggle(option, label) {
    const box = el('input', {type: 'checkbox', onchange: () => {
      this.options[option] = box.checked;
      this.#frame();
    }});
    this[`${option}Box`] = box;
    return el('label', {class: 'toggle'}, box, ` ${label}`);
  }

  /** Shows another trial, given its page data and figures. */
  load(trial, figures, cameras) {
    this.stage = new Stage(trial, cameras);
    this.figures = figures;
    this.options.follow = this.stage.frames > 0 && this.stage.travels;
    this.followBox.checked = this.options.follow;
    this.labels.replaceChildren();
    this.range.max = Math.max(this.stage.frames - 1, 0);
    this.player.load(this.stage.frames, figures.rate_hz);
    this.player.listen(() => this.#onTime());
    this.#showLegend();
    this.#resize();
    this.#frame();
    this.#onTime();
  }

  #frame() {
    if (!this.stage || this.stage.frames === 0) return;
    const {follow, cameras} = this.options;
    this.orbit.frame(this.stage.view(follow, cameras, this.#aspect()));
    this.stood = this.stage.standsAt(0);
    this.#follow();
    this.redraw();
  }

  /** Moves the eye with the subject. */
  #follow() {
    if (!this.options.follow || !this.stood || this.stage.frames === 0) return;
    const stands = this.stage.standsAt(this.player.time);
    const moved = subtract(stands, this.stood);
    this.orbit.target = add(this.orbit.target, moved);
    this.orbit.home.target = add(this.orbit.home.target, moved);
    this.stood = stands;
  }

  #aspect() {
    return this.canvas.clientWidth / Math.max(this.canvas.clientHeight, 1);
  }

  #resize() {
    const density = Math.min(devicePixelRatio || 1, 2);
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * density));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * density));
    this.#drawGaps();
    if (this.orbit.touched) this.redraw();
    else this.#frame();
  }

  #onTime() {
    const {player} = this;
    this.#follow();
    this.range.value = Math.round(player.time);
    const frame = Math.round(player.time) + (this.figures?.first_frame ?? 0);
    this.clock.textContent =
      `${fixed(player.time / player.rate, 2)} s · frame ${frame}`;
    this.button.textContent = player.playing ? '❚❚' : '▶';
    this.button.setAttribute('aria-label', player.playing ? 'Pause' : 'Play');
    this.redraw();
  }

  /** Draws at most once per screen refresh. */
  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.waiting = false;
    if (!this.stage || !this.drawing) return;
    const scene =
      this.stage.scene(this.player.time, this.orbit, this.#aspect(), this.options);
    this.drawing.draw(scene);
    this.#placeLabels(scene);
  }

  #placeLabels(scene) {
    const labels = this.stage.labels(this.options.cameras);
    while (this.labels.childElementCount > labels.length) this.labels.lastChild.remove();
    labels.forEach((label, i) => {
      const node = this.labels.children[i] ?? this.labels.appendChild(el('span'));
      if (node.textContent !== label.text) node.textContent = label.text;
      const at = projected(scene.clipFromWorld, label.at, this.canvas.clientWidth,
        this.canvas.clientHeight);
      node.hidden = !at;
      if (at) node.style.transform = `translate(${at.x}px, ${at.y}px) translate(-50%, -100%)`;
    });
  }

  #showLegend() {
    const {colouring} = this.options;
    const scale = () => el('p', {class: 'legend'}, 'sigma 0 ',
      el('span', {class: 'scale', style: `background: linear-gradient(to right, ${
        [0, 0.2, 0.4, 0.6, 0.8, 1].map((s) => cssRgb(doubtColour(s))).join(', ')})`}),
      ` ${1000 * DOUBT_SCALE_M} mm and more`);
    this.legend.replaceChildren(
      ...(colouring === 'source' ? [sourceLegend(false)] : []),
      ...(colouring === 'doubt' ? [scale()] : []));
  }

  /** Draws the number of unseen segments per frame, under the scrub bar. */
  #drawGaps() {
    if (!this.figures) return;
    const {gaps, first_frame: first} = this.figures;
    const {frames} = this.player;
    const canvas = this.gaps;
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * (devicePixelRatio || 1)));
    canvas.height = 8;
    const context = canvas.getContext('2d');
    // Inferred is drawn over repaired, because it is worse.
    for (const source of ['repaired', 'inferred']) {
      context.fillStyle = cssColour(source);
      for (const gap of gaps.filter((g) => g.bridged_as === source)) {
        const x = (gap.first_frame - first) / frames * canvas.width;
        const width = (gap.last_frame - gap.first_frame + 1) / frames * canvas.width;
        context.fillRect(x, source === 'repaired' ? 0 : 4, Math.max(width, 1), 4);
      }
    }
  }

  #key(event) {
    const {player} = this;
    const stride = event.shiftKey ? Math.round(player.rate) : 1;
    const actions = {
      ' ': () => player.play(!player.playing),
      ArrowLeft: () => player.step(-stride), ArrowRight: () => player.step(stride),
      Home: () => player.seek(0), End: () => player.seek(player.frames - 1),
      ArrowUp: () => this.orbit.zoom(0.9), ArrowDown: () => this.orbit.zoom(1 / 0.9),
      '+': () => this.orbit.zoom(0.9), '-': () => this.orbit.zoom(1 / 0.9),
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
  }
}
