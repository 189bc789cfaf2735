// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Opens the page that fits what marey serves: a session, a recording, an edit, or a library.

import {el} from '../base/elements';
import {EditPage} from './edit_page';
import {Connection} from '../protocol/connection';
import type {Listener} from '../protocol/connection';
import {EDIT_TYPES} from '../protocol/edit_protocol';
import {LIBRARY_TYPES} from '../protocol/library_protocol';
import type {ServerWords} from '../protocol/protocol';
import {LibraryPage} from './library_page';
import {ViewPage} from './view_page';

type Page = ViewPage | EditPage | LibraryPage;
const PAGES = {view: ViewPage, edit: EditPage, library: LibraryPage};
type Kind = keyof typeof PAGES;

declare global {
  interface Window {
    /** For tests and measurements of the page. */
    mareyPage?: Page;
  }
}

/** Passes messages on to a page, which it makes at the first of them. */
class PageOpener implements Listener {
  private readonly connection = new Connection(this);
  private page: Page | null = null;
  private hasFailed = false;
  private readonly notice = document.getElementById('connecting');

  words(words: ServerWords): void {
    const kind = kindOf(words);
    if (!this.page && !this.hasFailed) this.open(kind ?? 'view');
    // Another marey answers at this address now.
    else if (this.page && kind && !(this.page instanceof PAGES[kind])) window.location.reload();
    this.page?.words(words);
  }

  binary(buffer: ArrayBuffer): void {
    this.page?.binary(buffer);
  }

  state(state: 'open' | 'lost'): void {
    if (this.page) this.page.state(state);
    else if (this.notice && state === 'lost') {
      this.notice.textContent = 'marey does not answer. Check that it is still running.';
    }
  }

  trouble(text: string): void {
    if (this.page) this.page.trouble(text);
    else if (this.notice) this.notice.textContent = text;
  }

  private open(kind: Kind): void {
    this.notice?.remove();
    try {
      this.page = new PAGES[kind](this.connection);
      window.mareyPage = this.page;
      this.page.state('open');
    } catch (problem) {
      this.hasFailed = true;
      document.body.append(el('p', {class: 'banner', role: 'alert'},
        'This page cannot be shown: ', problem instanceof Error ? problem.message :
          String(problem), '. It needs a browser with WebGL 2, which can be enabled in the ' +
            'settings of most browsers.'));
    }
  }
}

/** Returns the page that a message belongs to; null: any. */
function kindOf(words: ServerWords): Kind | null {
  if (LIBRARY_TYPES.includes(words.type)) return 'library';
  if (EDIT_TYPES.includes(words.type)) return 'edit';
  if (words.type === 'scene') return words.mode === 'edit' ? 'edit' : 'view';
  return null;
}

new PageOpener();
