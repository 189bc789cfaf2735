// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Video frames with the solved skeleton and the detected tags.

function tagOutline(tag) {
  const middle = [0, 1].map((k) =>
    tag.corners.reduce((sum, corner) => sum + corner[k], 0) / tag.corners.length);
  return svg('g', {class: 'tag'},
    svg('polygon', {points: tag.corners.map((corner) => corner.join(',')).join(' ')}),
    svg('text', {x: middle[0], y: middle[1]}, String(tag.id)));
}

function boneLine([x1, y1, x2, y2, source]) {
  const line = {x1, y1, x2, y2};
  return [svg('line', {...line, class: 'halo'}),
    svg('line', {...line, class: `source-${SOURCES[source]}`,
      'stroke-dasharray': SOURCE_DASH[SOURCES[source]]})];
}

function overlay(picture) {
  // The centre of the first pixel is (0, 0): its corner is half a pixel away.
  return svg('svg', {viewBox: `-0.5 -0.5 ${picture.width_px} ${picture.height_px}`,
    class: 'overlay', 'aria-hidden': 'true'},
  ...picture.tags.map(tagOutline),
  svg('g', {class: 'bones'}, ...picture.bones.flatMap(boneLine)));
}

function drawnOver(picture) {
  const words = `Camera ${picture.camera}, frame ${picture.frame}, with the skeleton and ` +
    plural(picture.tags.length, 'tag', 'tags');
  return el('div', {class: 'drawn', style:
    `aspect-ratio: ${picture.width_px} / ${picture.height_px}`},
  el('img', {src: `data:image/jpeg;base64,${picture.jpeg}`, alt: words, loading: 'lazy',
    width: picture.width_px, height: picture.height_px}), overlay(picture));
}

function enlarge(picture) {
  const dialog = el('dialog', {class: 'large', onclose: () => dialog.remove(),
    onclick: () => dialog.close(), 'aria-label': 'The picture, enlarged'},
  drawnOver(picture),
  el('button', {type: 'button', autofocus: true}, 'Close'));
  document.body.append(dialog);
  dialog.showModal();
}

function picturesSection(player, trial, figures) {
  if (trial.pictures.length === 0) return [el('p', {}, 'No frames were drawn.')];
  const pictures = el('div', {class: 'pictures'}, ...trial.pictures.map((picture) =>
    el('figure', {},
      el('button', {type: 'button', class: 'enlarge', onclick: () => enlarge(picture),
        title: 'Enlarge'}, drawnOver(picture)),
      el('figcaption', {}, `${picture.camera}, frame ${picture.frame} `,
        el('button', {type: 'button', class: 'link', onclick: () => {
          player.play(false);
          player.seek(picture.frame - figures.first_frame);
          document.getElementById('motion').scrollIntoView();
        }}, 'show in the viewer'), ' ',
        pageLink(figures.name, picture.frame, 'on the page')))));
  const box = el('input', {type: 'checkbox', checked: true, onchange: () => {
    pictures.classList.toggle('bare', !box.checked);
  }});
  return [
    el('p', {class: 'lead'}, 'The solved skeleton, seen through the calibrated cameras: ' +
      'where it lies on the body, cameras, subject and motion agree.'),
    el('div', {class: 'row'}, sourceLegend(true),
      el('label', {class: 'toggle'}, box, ' Draw over')),
    pictures,
  ];
}
