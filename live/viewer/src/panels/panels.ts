// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Panels next to the stage: foldable sections that store their state.

import {el, remember, remembered, setText} from '../base/elements';

export class Section {
  readonly body = el('div', {class: 'section-body'});
  readonly element: HTMLDetailsElement;
  private readonly hint = el('span', {class: 'hint'});

  constructor(readonly name: string, title: string, open: boolean, toggled?: () => void) {
    const kept = remembered(`panel.${name}`);
    this.element = el('details', {class: `section section-${name}`,
      open: kept === null ? open : kept === 'open',
      ontoggle: () => {
        remember(`panel.${name}`, this.element.open ? 'open' : 'folded');
        toggled?.();
      }}, el('summary', {}, title, this.hint), this.body);
  }

  get open(): boolean {
    return this.element.open && !this.element.hidden;
  }

  set hidden(hidden: boolean) {
    this.element.hidden = hidden;
  }

  /** Opens the section and scrolls to its beginning, and to as much of the rest as fits. */
  reveal(): void {
    this.element.open = true;
    this.element.scrollIntoView({block: 'start'});
  }

  /** Sets a short summary that is also visible when folded. */
  tell(words: string): void {
    setText(this.hint, words);
  }
}

const NARROW = '(max-width: 48rem), (max-height: 30rem)';

/** Shows or hides all panels; on a phone they cover the stage and start hidden. */
export class Panels {
  private readonly narrow = window.matchMedia(NARROW);
  readonly button: HTMLButtonElement;

  constructor(private readonly element: HTMLElement, private readonly changed: () => void) {
    this.button = el('button', {type: 'button', 'aria-controls': 'panels',
      onclick: () => this.set(!this.shown)}, 'Panels');
    this.set(!this.narrow.matches && remembered('panels') !== 'hidden', false);
    this.narrow.addEventListener('change', () => {
      this.set(!this.narrow.matches && remembered('panels') !== 'hidden', false);
    });
  }

  add(...sections: Section[]): void {
    this.element.append(...sections.map((section) => section.element));
  }

  get shown(): boolean {
    return !document.body.classList.contains('without-panels');
  }

  set(shown: boolean, keep = true): void {
    document.body.classList.toggle('without-panels', !shown);
    this.button.setAttribute('aria-expanded', String(shown));
    if (keep && !this.narrow.matches) remember('panels', shown ? 'shown' : 'hidden');
    this.changed();
  }
}
