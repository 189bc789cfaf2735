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
  ['skin', 'Skin', 'Avatars with their skin; otherwise their bones'],
  ['bones', 'Bones', 'Also of avatars with skin'],
  ['uncertainty', 'Uncertainty', 'A ball of two sigma around every joint'],
  ['balance', 'Balance', 'Centre of mass, its plumb line, the polygon that carries it'],
  ['cameras', 'Cameras', 'Their positions and fields of view'],
  ['handles', 'Handles', 'Constraints that can be dragged'],
  ['names', 'Names', 'Of bodies, cameras and points'],
  ['follow', 'Follow', 'The view moves with the subject'],
];

const MEANINGS = {
  measured: 'cameras saw it in this frame',
  repaired: 'out of sight for a while, filled in from before and after',
  inferred: 'no tag on it, out of sight for long, or a limb’s joint known to no better than 20 mm',
};

export class ViewPanel {
  readonly section: Section;

  constructor(stage: Stage, theme: Theme, changed: () => void) {
    this.section = new Section('view', 'View', true);
    this.section.body.append(this.legend(), this.layers(stage, changed), views(stage),
      themeChoice(theme));
  }

  private legend(): HTMLElement {
    return el('ul', {class: 'legend', 'aria-label': 'Colours of segments'},
      ...SOURCES.map((source) => el('li', {title: MEANINGS[source]},
        el('span', {class: `swatch fill-${source}`, 'aria-hidden': 'true'}), ` ${source}`)));
  }

  private layers(stage: Stage, changed: () => void): HTMLElement {
    return el('div', {class: 'toggles', role: 'group', 'aria-label': 'What is drawn'},
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
