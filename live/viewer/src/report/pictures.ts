// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Video frames with the solved skeleton and the detected tags.

import {button, checkbox, el, svg} from '../base/elements';
import {plural} from '../base/words';
import {SOURCES} from '../protocol/protocol';
import {byId, lead, paragraph, pointList, SOURCE_DASH, sourceLegend} from './common';
import type {Picture, TrialData, TrialFigures} from './data';
import {pageLink} from './page_links';
import type {Player} from './player';

function drawnOver({camera, frame, width_px, height_px, jpeg, tags, bones}: Picture): HTMLElement {
  const words = `Camera ${camera}, frame ${frame}, with the skeleton and ` +
    plural(tags.length, 'tag');
  const outlines = tags.map(({id, corners}) => {
    const [x, y] = [0, 1].map((k) => corners.reduce((sum, corner) => sum + corner[k], 0) /
      corners.length);
    return svg('g', {class: 'tag'}, svg('polygon', {points: pointList(corners, 1)}),
      svg('text', {x, y}, String(id)));
  });
  const lines = bones.flatMap(([x1, y1, x2, y2, source]) => [
    svg('line', {x1, y1, x2, y2, class: 'halo'}),
    svg('line', {x1, y1, x2, y2, class: `source-${SOURCES[source]}`,
      'stroke-dasharray': SOURCE_DASH[SOURCES[source]]})]);
  return el('div', {class: 'drawn', style: `aspect-ratio: ${width_px} / ${height_px}`},
    el('img', {src: `data:image/jpeg;base64,${jpeg}`, alt: words, loading: 'lazy',
      width: width_px, height: height_px}),
    // The centre of the first pixel is (0, 0): its corner is half a pixel away.
    svg('svg', {viewBox: `-0.5 -0.5 ${width_px} ${height_px}`, class: 'overlay',
      'aria-hidden': 'true'}, ...outlines, svg('g', {class: 'bones'}, ...lines)));
}

function enlarge(picture: Picture): void {
  const dialog = el('dialog', {class: 'large', onclose: () => dialog.remove(),
    onclick: () => dialog.close(), 'aria-label': 'The picture, enlarged'},
  drawnOver(picture), button({autofocus: true}, 'Close'));
  document.body.append(dialog);
  dialog.showModal();
}

export function picturesSection(player: Player, {pictures}: TrialData,
  {name, first_frame}: TrialFigures): HTMLElement[] {
  if (pictures.length === 0) return [paragraph('No frames were drawn.')];
  const all = el('div', {class: 'pictures'}, ...pictures.map((picture) => el('figure', {},
    button({class: 'enlarge', onclick: () => enlarge(picture), title: 'Enlarge'},
      drawnOver(picture)),
    el('figcaption', {}, `${picture.camera}, frame ${picture.frame} `,
      button({class: 'link', onclick: () => {
        player.show(picture.frame - first_frame);
        byId('motion').scrollIntoView();
      }}, 'show in the viewer'), ' ', pageLink(name, picture.frame, 'on the page')))));
  return [
    lead('The solved skeleton, drawn into the pictures of the cameras. Cameras, subject and ' +
      'motion are consistent if it lies on the body.'),
    el('div', {class: 'row'}, sourceLegend(true),
      checkbox('Draw over', true, (on) => { all.classList.toggle('bare', !on); },
        {class: 'toggle'})),
    all,
  ];
}
