// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The menu that adds an operation.

import {button, el, setText} from '../base/elements';
import {OP_MENU} from './op_schema';
import type {OpSchema} from './op_schema';

export class AddMenu {
  readonly element: HTMLElement;
  readonly button: HTMLButtonElement;
  private readonly menu: HTMLElement;
  private readonly help = el('p', {class: 'hint', 'aria-live': 'polite'});
  private readonly items: [OpSchema, HTMLButtonElement][] = [];

  /** `add` receives the name of an operation. `whyNot` returns the reason if it cannot be
   *  added, `place` a sentence about the place at which it is inserted. */
  constructor(add: (name: string) => void, private readonly whyNot: (name: string) => string,
    private readonly place: () => string) {
    this.menu = el('div', {class: 'op-menu', hidden: true, onkeydown: (event: KeyboardEvent) =>
      this.key(event)}, ...OP_MENU.map(([title, ops]) => el('div', {class: 'op-menu-group',
      role: 'group', 'aria-label': title}, el('span', {class: 'op-menu-title'}, title),
    el('div', {class: 'row'}, ...ops.map((op) => this.item(op, add))))), this.help);
    this.button = button({class: 'primary', 'aria-expanded': 'false',
      onclick: () => this.set(this.menu.hidden !== false)}, 'Add operation');
    this.element = el('div', {class: 'op-add'}, this.button, this.menu);
  }

  private item(op: OpSchema, add: (name: string) => void): HTMLButtonElement {
    const tell = (): void => setText(this.help, this.whyNot(op.name) || `${op.help}.`);
    const made = button({'data-op': op.name, onmouseenter: tell, onfocus: tell, onclick: () => {
      if (made.getAttribute('aria-disabled') === 'true') return;
      this.set(false);
      add(op.name);
    }}, op.title);
    this.items.push([op, made]);
    return made;
  }

  private set(isOpen: boolean): void {
    this.menu.hidden = !isOpen;
    this.button.setAttribute('aria-expanded', String(isOpen));
    if (!isOpen) return;
    for (const [op, item] of this.items) {
      const why = this.whyNot(op.name);
      item.setAttribute('aria-disabled', String(why !== ''));
      item.title = why || op.help;
    }
    this.items[0][1].focus();
    setText(this.help, this.place());
  }

  private key(event: KeyboardEvent): void {
    const {key} = event;
    const step = key === 'ArrowDown' || key === 'ArrowRight' ? 1
      : key === 'ArrowUp' || key === 'ArrowLeft' ? -1 : 0;
    if (key === 'Escape') {
      this.set(false);
      this.button.focus();
    } else if (step !== 0) {
      const at = this.items.findIndex(([, item]) => item === document.activeElement);
      this.items[(at + step + this.items.length) % this.items.length][1].focus();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
