// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Settings of the view: drawn parts, view directions, colours.

import type {Shown} from '../scene/body_view';
import {button, checkbox, chooser, el, remember, remembered} from '../base/elements';
import {Section} from './panels';
import {SOURCES} from '../protocol/protocol';
import type {Stage} from '../scene/stage';
import type {Choice, Theme} from '../base/theme';

const LAYERS: [Exclude<keyof Shown, 'colouring'>, string, string][] = [
  ['skin', 'Skin', 'Show the skin of avatars, otherwise their bones'],
  ['bones', 'Bones', 'Show bones also for avatars with skin'],
  ['uncertainty', 'Uncertainty', 'A sphere of two sigma around every joint'],
  ['balance', 'Balance', 'Centre of mass, its plumb line, the support polygon and the zero ' +
    'moment point: green within the polygon, red outside'],
  ['cameras', 'Cameras', 'Positions and fields of view of the cameras'],
  ['handles', 'Handles', 'Constraints that can be dragged'],
  ['names', 'Names', 'Names of bodies, cameras and points'],
  ['follow', 'Follow', 'The view moves with the subject'],
];

const MEANINGS = {
  measured: 'cameras saw it in this frame',
  repaired: 'not seen; interpolated between sightings shortly before and after',
  inferred: 'without a tag, not seen for a long time, or a joint of a limb with a sigma ' +
    'above 15 mm',
};

/** Marks of the balance. */
const MARKS = [
  ['ball', 'centre of mass', 'Green above the support polygon, red outside of it'],
  ['ring', 'zero moment point', 'The place on the floor at which the push of the floor acts. ' +
    'Red outside of the support polygon: such a motion needs other supports. Not in flight'],
] as const;

export class ViewPanel {
  readonly section: Section;

  constructor(stage: Stage, theme: Theme, changed: () => void) {
    this.section = new Section('view', 'View', true);
    this.section.body.append(this.legend(), this.layers(stage, changed), views(stage),
      themeChoice(theme));
  }

  private legend(): HTMLElement {
    return el('ul', {class: 'legend', 'aria-label': 'Colours of segments, and marks'},
      ...SOURCES.map((source) => el('li', {title: MEANINGS[source]},
        el('span', {class: `swatch fill-${source}`, 'aria-hidden': 'true'}), ` ${source}`)),
      ...MARKS.map(([mark, name, title]) => el('li', {title},
        el('span', {class: `balance-mark balance-${mark}`, 'aria-hidden': 'true'}), ` ${name}`)));
  }

  private layers(stage: Stage, changed: () => void): HTMLElement {
    return el('div', {class: 'toggles', role: 'group', 'aria-label': 'Layers of the view'},
      ...LAYERS.map(([layer, label, title]) => {
        const kept = remembered(`layer.${layer}`);
        if (kept !== null) stage.shown[layer] = kept === 'on';
        return checkbox(label, stage.shown[layer], (on) => {
          stage.shown[layer] = on;
          remember(`layer.${layer}`, on ? 'on' : 'off');
          changed();
        }, {title});
      }));
  }
}

function views(stage: Stage): HTMLElement {
  const look = (label: string, key: string, pressed: () => void): HTMLElement =>
    button({title: `Key ${key}`, onclick: pressed}, label);
  return el('div', {class: 'row', role: 'group', 'aria-label': 'Look from'},
    look('Frame', 'F', () => stage.frameBodies()),
    look('Front', '1', () => stage.viewFrom('front')),
    look('Left', '2', () => stage.viewFrom('left')),
    look('Above', '3', () => stage.viewFrom('above')));
}

function themeChoice(theme: Theme): HTMLElement {
  const choice = chooser([['system', 'as the system'], ['light', 'light'], ['dark', 'dark']],
    theme.choice, (value) => theme.choose(value as Choice));
  theme.onChange(() => { choice.value = theme.choice; });
  return el('label', {class: 'row'}, 'Colours ', choice);
}
