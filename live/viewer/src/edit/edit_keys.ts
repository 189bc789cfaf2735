// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Keys of the edit page, besides those of its tools.

import type {KeyHelp} from '../panels/help';

export const EDIT_KEYS: KeyHelp[] = [
  [['ctrl Z', 'ctrl shift Z'], 'undo, redo'],
  [['I', 'O'], 'trim: start, end at the shown instant'],
  [['B'], 'brush a span: its start, then its end (or shift drag on the timeline)'],
  [['G'], 'the source as a ghost'],
  [['↑', '↓'], 'in the list of operations: the one above, below'],
  [['alt ↑', 'alt ↓', 'delete'], 'there: move, remove the operation'],
  [['escape'], 'end a drag without a change; close a form'],
];

/** Calls `undo` and `redo` at the usual keys. Text fields keep theirs. */
export function listenToUndo(undo: () => void, redo: () => void): void {
  document.addEventListener('keydown', (event) => {
    const isText = (event.target as HTMLElement).closest('input:not([type=checkbox]), textarea');
    if (!(event.ctrlKey || event.metaKey) || event.altKey || isText) return;
    const key = event.key.toLowerCase();
    if (key !== 'z' && key !== 'y') return;
    event.preventDefault();
    if (key === 'y' || event.shiftKey) redo();
    else undo();
  });
}
