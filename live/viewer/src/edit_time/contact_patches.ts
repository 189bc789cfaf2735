// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Changes of contacts by hand, as edits of a contacts operation. All times are those of the
// shown motion. Knows no elements of the page.

import type {Change} from '../edit/edit_document';
import {insertIndex} from '../edit/edit_view';
import type {ShownView} from './op_times';
import {changeOf, lastOp, rounded} from './op_times';
import type {Foot, FootPart, OpKeys, OpValue} from '../protocol/edit_protocol';

/** marey moves the edge that is nearest to `from_s` within this time. [s] */
const EDGE_REACH_S = 0.1;

type ContactEdit = {
  do: 'set' | 'clear' | 'move_start' | 'move_end'; foot: Foot; part: FootPart; from_s: number;
  to_s: number;
};

export interface ContactEdge {
  foot: Foot; part: FootPart; edge: 'start' | 'end';
  /** The other edge of the contact. */
  other_s: number;
}

/** Changes the edits of the contacts operation before, or of a new one. */
function changedEdits(view: ShownView, make: (edits: ContactEdit[], rate_hz: number) =>
  ContactEdit[]): Change {
  return changeOf(view, ({ops, until, output: {rate_hz}}) => {
    const index = lastOp(ops, until, 'contacts');
    const op = ops[index] as typeof ops[number] | undefined;
    const old = (op?.keys.edits ?? []) as OpValue as ContactEdit[];
    const edits = make([...old], rate_hz);
    if (JSON.stringify(edits) === JSON.stringify(old)) return null;
    if (!op) return [{insert: insertIndex(ops, until), op: {do: 'contacts@1', edits}}];
    const {edits: _, ...rest} = op.keys;
    if (edits.length === 0 && rest.detect !== true) return [{remove: index}];
    return [{replace: index, op: (edits.length > 0 ? {...op.keys, edits} : rest) as OpKeys}];
  });
}

function edit(kind: ContactEdit['do'], foot: Foot, part: FootPart, from_s: number, to_s: number):
  ContactEdit {
  return {do: kind, foot, part, from_s: rounded(Math.max(from_s, 0)),
    to_s: rounded(Math.max(to_s, 0))};
}

/** Moves an edge of a contact from `from_s`, where it is shown, to `to_s`. An edge that was
 *  moved before keeps its original time, so a contact that it had reached appears again. Beyond
 *  the other edge, the contact is cleared. */
export function moveContactEdge(view: ShownView, contact: ContactEdge, from_s: number,
  to_s: number): Change {
  const {foot, part, edge, other_s} = contact;
  const kind = edge === 'start' ? 'move_start' : 'move_end';
  return changedEdits(view, (edits, rate_hz) => {
    const before = lastMoveTo(edits, contact, from_s, rate_hz);
    const origin_s = before < 0 ? from_s : edits[before].from_s;
    const half_s = 0.5 / rate_hz;
    if (edge === 'start' ? to_s > other_s + half_s : to_s < other_s - half_s) {
      const all = [from_s, other_s];
      return [...edits, edit('clear', foot, part, Math.min(...all), Math.max(...all))];
    }
    const made = edit(kind, foot, part, origin_s, to_s);
    const isBack = Math.abs(made.to_s - made.from_s) < 1e-9;
    if (before < 0) return isBack ? edits : [...edits, made];
    if (disturbs(edits.slice(before + 1), made, edits[before].to_s, rate_hz)) {
      return [...edits, edit(kind, foot, part, from_s, to_s)];
    }
    return isBack ? edits.filter((_, i) => i !== before)
      : edits.map((one, i) => (i === before ? made : one));
  });
}

/** Index of the last edit that moved this edge to a time. -1: none. */
function lastMoveTo(edits: readonly ContactEdit[], {foot, part, edge}: ContactEdge, to_s: number,
  rate_hz: number): number {
  return edits.findLastIndex((one) => one.do === `move_${edge}` && one.foot === foot &&
    one.part === part && Math.abs(one.to_s - to_s) <= 0.5 / rate_hz);
}

/** True if one of the edits that follow depends on where a moved edge is. */
function disturbs(later: readonly ContactEdit[], made: ContactEdit, old_s: number,
  rate_hz: number): boolean {
  const times = [made.from_s, made.to_s, old_s];
  const [low_s, high_s] = [Math.min(...times), Math.max(...times)];
  return later.some((one) => {
    if (one.foot !== made.foot || one.part !== made.part) return false;
    // marey does not look for this edge when it moves the opposite ones.
    const isOpposite = one.do.startsWith('move_') && one.do !== made.do;
    // Contacts in adjacent frames are one contact.
    const reach_s = 1.5 / rate_hz + (isOpposite ? 0 : EDGE_REACH_S);
    return Math.min(one.from_s, one.to_s) <= high_s + reach_s &&
      Math.max(one.from_s, one.to_s) >= low_s - reach_s;
  });
}

function brushed(view: ShownView, kind: 'set' | 'clear', foot: Foot, part: FootPart,
  from_s: number, to_s: number): Change {
  return changedEdits(view, (edits) => {
    const made = edit(kind, foot, part, from_s, to_s);
    // The last edits have no effect if this one covers them.
    const kept = [...edits];
    for (let i = kept.length - 1; i >= 0; --i) {
      const one = kept[i];
      if (one.foot !== foot || one.part !== part) continue;
      if (!['set', 'clear'].includes(one.do) || one.from_s < made.from_s ||
        one.to_s > made.to_s) break;
      kept.splice(i, 1);
    }
    return [...kept, made];
  });
}

/** The part bears in this span. */
export function setContact(view: ShownView, foot: Foot, part: FootPart, from_s: number,
  to_s: number): Change {
  return brushed(view, 'set', foot, part, from_s, to_s);
}

/** The part does not bear in this span. */
export function clearContact(view: ShownView, foot: Foot, part: FootPart, from_s: number,
  to_s: number): Change {
  return brushed(view, 'clear', foot, part, from_s, to_s);
}
