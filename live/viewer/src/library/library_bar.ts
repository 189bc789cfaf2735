// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The bar at the top of the page of a library: name, state, notices.

import {button, el, setText} from '../base/elements';
import type {Theme} from '../base/theme';
import {plural} from '../base/words';
import type {LibraryWords} from '../protocol/library_protocol';

const NOTICE_MS = 9000;

export class LibraryBar {
  private readonly title = el('h1', {}, 'marey');
  private readonly pill = el('span', {class: 'pill', role: 'status', 'aria-live': 'polite'});
  private readonly figures = el('span', {class: 'figures'});
  private readonly banner = el('p', {class: 'banner', role: 'alert', hidden: true});
  private readonly notice = el('p', {class: 'notice', role: 'alert', hidden: true});
  private connected = true;
  private isOutdated = false;
  private hasList = true;
  private timer = 0;

  /** `reload` loads the list of the newest build. */
  constructor(element: HTMLElement, stage: HTMLElement, theme: Theme,
    private readonly reload: () => void, buttons: HTMLElement[]) {
    const themeButton = button({class: 'icon theme', title: 'Dark or light colours',
      'aria-label': 'Dark or light colours',
      onclick: () => theme.choose(theme.dark ? 'light' : 'dark')}, '◐');
    element.append(this.title, this.pill, this.figures, el('span', {class: 'spring'}),
      themeButton, ...buttons);
    stage.append(this.banner, this.notice);
    this.tell();
  }

  setLibrary(library: LibraryWords): void {
    this.hasList = library.trouble === '';
    setText(this.title, library.name);
    this.title.title = library.folder;
    document.title = `${library.name} – marey`;
    setText(this.figures, [plural(library.clips, 'clip'),
      library.failed > 0 ? `${plural(library.failed, 'source')} failed` : '']
      .filter((words) => words).join(' · '));
    this.figures.title = library.failed > 0 ? `The reasons are in ${library.folder}/failed` : '';
    this.tell();
  }

  setConnected(connected: boolean): void {
    this.connected = connected;
    this.tell();
  }

  /** The library was built again since the list was loaded. */
  setOutdated(isOutdated: boolean): void {
    this.isOutdated = isOutdated;
    this.tell();
  }

  /** Shows a text over the scene for some seconds. */
  notify(text: string): void {
    setText(this.notice, text);
    this.notice.hidden = false;
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => { this.notice.hidden = true; }, NOTICE_MS);
  }

  private tell(): void {
    const [state, words] = !this.connected ? ['offline', 'not connected']
      : this.isOutdated ? ['behind', 'built again']
        : this.hasList ? ['tracked', 'up to date'] : ['stopped', 'no list'];
    setText(this.pill, words);
    this.pill.className = `pill pill-${state}`;
    this.banner.hidden = this.connected && !this.isOutdated;
    if (!this.connected) {
      this.banner.replaceChildren('The connection to marey is lost. Check that it is still ' +
        'running. The page reconnects when it is.');
    } else if (this.isOutdated) {
      this.banner.replaceChildren('The library was built again. ', button({class: 'primary reload',
        onclick: () => this.reload()}, 'Load the new list'));
    }
  }
}
