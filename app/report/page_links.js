// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Ways from a report to the page of `marey view`. A report is a file that needs no server:
// there it says what to call. Served by `marey view` it links to the moment itself.

/** `marey view` serves the report of its results under this name. */
const SERVED = location.protocol === 'http:' && location.pathname === '/report.html';

/** The page at a trial, at a frame as the recording numbers it; null: nobody serves it. */
function pageLink(trial, frame, words) {
  if (!SERVED) return null;
  const at = frame === null ? '' : `&frame=${frame}`;
  return el('a', {class: 'page-link', href: `/?trial=${encodeURIComponent(trial)}${at}`},
    words);
}

/** A place of the file system as a shell takes it. */
function shellWord(path) {
  return /^[\w@%+=:,./-]+$/.test(path) ? path : `'${path.replaceAll("'", "'\\''")}'`;
}

/** What to call for the page of these results; `pathname` and `protocol` of the report. */
function viewCommand({protocol, pathname}) {
  const parts = pathname.split('/');
  const folder = parts.slice(0, -1).map(decodeURIComponent).join('/') || '/';
  return `marey view ${protocol === 'file:' ? shellWord(folder) : 'RESULTS'}`;
}

/** Says how to see it move. */
function pageWords() {
  if (SERVED) {
    return el('p', {class: 'about'}, el('a', {class: 'page-link', href: '/'},
      'See it move on the page'));
  }
  const code = el('code', {class: 'command', title: 'Click to select it all', onclick: () =>
    getSelection().selectAllChildren(code)}, viewCommand(location));
  return el('p', {class: 'about'}, 'To see it move in a browser, and go from here to every ' +
    'moment: ', code);
}
