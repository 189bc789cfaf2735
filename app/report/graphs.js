// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Graphs over the frames of a trial. All have the same gutter on the left, so that a
// frame is at the same x in each, and a playhead that the viewer moves.

/** Adds frame navigation to `content`: a click or drag goes to a frame; `readout(frame)`
 *  returns its text. */
function overFrames(player, content, readout) {
  const playhead = el('div', {class: 'playhead'});
  const note = el('div', {class: 'note', role: 'status'});
  const plot = el('div', {class: 'plot'}, content, playhead, note);
  const frameAt = (event) => {
    const box = plot.getBoundingClientRect();
    const share = (event.clientX - box.left) / box.width;
    return Math.min(Math.max(Math.floor(share * player.frames), 0), player.frames - 1);
  };
  const go = (event) => {
    player.play(false);
    player.seek(frameAt(event));
  };
  plot.addEventListener('pointerdown', go);
  plot.addEventListener('pointermove', (event) => {
    if (event.buttons === 1) go(event);
    const frame = frameAt(event);
    note.textContent = readout(frame, event);
    const share = (frame + 0.5) / player.frames;
    note.style.left = `${100 * share}%`;
    note.classList.toggle('leftward', share > 0.6);
  });
  plot.addEventListener('pointerleave', () => { note.textContent = ''; });
  const show = () => {
    playhead.style.left = `${100 * (Math.round(player.time) + 0.5) / player.frames}%`;
  };
  player.listen(show);
  show();
  return plot;
}

/** Returns round marks for an axis up to `highest`: 3 to 6 of them. */
function axisMarks(highest) {
  const raw = Math.max(highest, 1e-9) / 4;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= raw);
  const marks = [];
  for (let i = 0; i * step <= highest * 1.0001; ++i) marks.push(i * step);
  return marks;
}

function frameAxis(player, firstFrame) {
  const seconds = axisMarks((player.frames - 1) / player.rate);
  return el('div', {class: 'axis'}, ...seconds.map((s) => {
    const share = (s * player.rate + 0.5) / player.frames;
    return el('span', {style: `left: ${100 * share}%`}, `${Number(s.toFixed(3))} s`);
  }), el('span', {class: 'unseen'}, `from frame ${firstFrame}`));
}

/** Draws values over frames as a line. A value of 0 means none and is not drawn. */
function lineGraph(player, values, {unit, level, levelName, firstFrame, name}) {
  const highest = Math.max(level, ...values) * 1.1 || 1;
  const marks = axisMarks(highest);
  const y = (value) => 100 - 100 * value / highest;
  let path = '';
  values.forEach((value, i) => {
    if (value <= 0) return;
    path += `${values[i - 1] > 0 ? 'L' : 'M'}${i + 0.5} ${y(value).toFixed(2)}`;
    // A single frame between two without a value stays visible.
    if (!(values[i - 1] > 0) && !(values[i + 1] > 0)) path += 'h0.01';
  });
  const picture = svg('svg', {viewBox: `0 0 ${player.frames} 100`,
    preserveAspectRatio: 'none', class: 'lines', role: 'img', 'aria-label': name},
  ...marks.map((mark) => svg('line', {x1: 0, x2: player.frames, y1: y(mark), y2: y(mark),
    class: 'grid'})),
  svg('line', {x1: 0, x2: player.frames, y1: y(level), y2: y(level), class: 'level'}),
  svg('path', {d: path, class: 'line'}));
  const readout = (frame) => (values[frame] > 0
    ? `frame ${frame + firstFrame}: ${fixed(values[frame], 2)} ${unit}`
    : `frame ${frame + firstFrame}: no tag seen`);
  return el('div', {class: 'graph'},
    el('div', {class: 'gutter tall'}, ...marks.map((mark) =>
      el('span', {style: `top: ${y(mark)}%`}, `${Number(mark.toPrecision(3))} ${unit}`)),
    el('span', {class: 'level', style: `top: ${y(level)}%`}, levelName)),
    overFrames(player, picture, readout),
    el('div', {class: 'gutter'}), frameAxis(player, firstFrame));
}

/** A canvas that is repainted when its size or the colours change. */
function paintedCanvas(height, paint, attributes) {
  const canvas = el('canvas', {style: `height: ${height}px`, ...attributes});
  const draw = () => {
    const density = devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * density));
    canvas.height = Math.max(1, Math.round(height * density));
    const context = canvas.getContext('2d');
    context.scale(canvas.width / Math.max(canvas.clientWidth, 1), density);
    paint(context, canvas.clientWidth);
  };
  new ResizeObserver(draw).observe(canvas);
  onThemeChange(() => { if (canvas.isConnected) draw(); });
  return canvas;
}
