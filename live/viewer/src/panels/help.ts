// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// List of keys and gestures.

import {el} from '../base/elements';

/** Keys or gestures, and their effect. */
export type KeyHelp = readonly [readonly string[], string];

const KEYS: KeyHelp[] = [
  [['space'], 'play, pause'], [['←', '→'], 'one frame back, forward'],
  [['shift ←', 'shift →'], 'one second back, forward'],
  [['home', 'end'], 'first, last frame (live: now)'], [['L'], 'loop'],
  [['F'], 'fit all bodies into the view'],
  [['1', '2', '3'], 'view from the front, their left, above'],
  [['+', '−'], 'nearer, farther'], [['drag'], 'turn; on a handle: move it'],
  [['shift drag'], 'pan; on a handle: up and down'],
  [['wheel', 'two fingers'], 'zoom; on the timeline: zoom in time'],
  [['double click'], 'reset the view; on the timeline: show all'],
  [['D'], 'segments, contacts, graphs'], [['P'], 'panels'],
  [['?'], 'this help'],
];

export class Help {
  readonly button = el('button', {type: 'button', class: 'icon', title: 'Keys and gestures (?)',
    'aria-label': 'Keys and gestures', onclick: () => this.toggle()}, '?');
  private readonly dialog: HTMLDialogElement;

  /** `more`: keys of this page. */
  constructor(more: readonly KeyHelp[] = []) {
    this.dialog = el('dialog', {class: 'help', 'aria-labelledby': 'help-title'},
      el('h2', {id: 'help-title', tabindex: -1, autofocus: true}, 'Keys and gestures'),
      el('dl', {}, ...[...KEYS, ...more].flatMap(([keys, what]) =>
        [el('dt', {}, ...keys.flatMap((key) => [el('kbd', {}, key), ' '])),
          el('dd', {}, what)])),
      el('form', {method: 'dialog'}, el('button', {class: 'primary'}, 'Close')));
    document.body.append(this.dialog);
    this.dialog.addEventListener('click', (event) => {
      // A click outside the box, on the backdrop.
      if (event.target === this.dialog) this.dialog.close();
    });
  }

  toggle(): void {
    if (this.dialog.open) this.dialog.close();
    else this.dialog.showModal();
  }
}

/** Runs the action of a key that is pressed in `place`, unless a control needs the key. */
export function listenToKeys(actions: Record<string, (event: KeyboardEvent) => void>,
  place: Document | HTMLElement = document): void {
  place.addEventListener('keydown', (any) => {
    const event = any as KeyboardEvent;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target as HTMLElement;
    if (target.closest('select, input:not([type=checkbox]), dialog[open]')) {
      if (!(event.key === '?' && target.closest('dialog'))) return;
    }
    // Space presses the focused control.
    if (event.key === ' ' && target.closest('button, summary, input')) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = actions[key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}

/** Removes the focus from a control pressed with the mouse, so that keys go to the scene
 *  again. Keyboard navigation keeps its focus. */
export function giveFocusBack(): void {
  let byPointer = false;
  document.addEventListener('pointerdown', () => { byPointer = true; }, true);
  document.addEventListener('keydown', () => { byPointer = false; }, true);
  for (const kind of ['click', 'change']) {
    document.addEventListener(kind, ({target}) => {
      const control = (target as HTMLElement).closest<HTMLElement>(
        kind === 'click' ? 'button, summary, input' : 'select');
      if (byPointer && control && !control.closest('dialog')) control.blur();
    });
  }
}
