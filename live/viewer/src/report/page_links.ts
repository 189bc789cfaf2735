// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Links from a report to files and to the page of `marey view`. A report opened as a file needs
// no server and shows the command to run. Served by `marey view`, it links to the instant.

import {el} from '../base/elements';

/** `marey view` serves the report of its results under this name. */
export const SERVED = location.protocol === 'http:' && location.pathname === '/report.html';

/** Returns a link to a trial and a frame (the recording's number); null if not served. */
export function pageLink(trial: string, frame: number | null, words: string): HTMLElement | null {
  if (!SERVED) return null;
  const at = frame === null ? '' : `&frame=${frame}`;
  return el('a', {class: 'page-link', href: `/?trial=${encodeURIComponent(trial)}${at}`}, words);
}

/** Returns the text that explains how to see the motion. */
export function pageWords(): HTMLElement {
  if (SERVED) {
    return el('p', {class: 'about'}, el('a', {class: 'page-link', href: '/'},
      'View the motion on the page'));
  }
  const code = el('code', {class: 'command', title: 'Click to select it all',
    onclick: () => getSelection()!.selectAllChildren(code)}, viewCommand());
  return el('p', {class: 'about'}, 'To view the motion in a browser, with links from here to ' +
    'every frame: ', code);
}

function viewCommand(): string {
  if (location.protocol !== 'file:') return 'marey view RESULTS';
  const folder = location.pathname.split('/').slice(0, -1).map(decodeURIComponent).join('/') || '/';
  const quoted = /^[\w@%+=:,./-]+$/.test(folder) ? folder
    : `'${folder.replaceAll("'", "'\\''")}'`;
  return `marey view ${quoted}`;
}

/** Returns a link to a file next to the report, with any name. Under `marey view`, which
 *  serves no files, returns the name only. */
export function fileLink(path: string): HTMLElement {
  const parts = path.split('/');
  const name = parts[parts.length - 1];
  if (location.protocol === 'http:') return el('span', {class: 'file'}, name);
  return el('a', {href: `./${parts.map(encodeURIComponent).join('/')}`, class: 'file'}, name);
}
