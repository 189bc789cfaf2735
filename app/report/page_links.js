// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Links from a report to the page of `marey view`. A report opened as a file needs no server
// and shows the command to run. Served by `marey view`, it links to the instant.

/** `marey view` serves the report of its results under this name. */
const SERVED = location.protocol === 'http:' && location.pathname === '/report.html';

/** Returns a link to a trial and a frame (the recording's number); null if not served. */
function pageLink(trial, frame, words) {
  if (!SERVED) return null;
  const at = frame === null ? '' : `&frame=${frame}`;
  return el('a', {class: 'page-link', href: `/?trial=${encodeURIComponent(trial)}${at}`},
    words);
}

/** Quotes a path for a shell. */
function shellWord(path) {
  return /^[\w@%+=:,./-]+$/.test(path) ? path : `'${path.replaceAll("'", "'\\''")}'`;
}

/** Returns the command that shows these results; `pathname` and `protocol` of the report. */
function viewCommand({protocol, pathname}) {
  const parts = pathname.split('/');
  const folder = parts.slice(0, -1).map(decodeURIComponent).join('/') || '/';
  return `marey view ${protocol === 'file:' ? shellWord(folder) : 'RESULTS'}`;
}

/** Returns the text that explains how to see the motion. */
function pageWords() {
  if (SERVED) {
    return el('p', {class: 'about'}, el('a', {class: 'page-link', href: '/'},
      'View the motion on the page'));
  }
  const code = el('code', {class: 'command', title: 'Click to select it all', onclick: () =>
    getSelection().selectAllChildren(code)}, viewCommand(location));
  return el('p', {class: 'about'}, 'To view the motion in a browser, with links from here to every ' +
    'frame: ', code);
}
