// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Operations and rows of lists as they are added: valid at once, with values of the shown motion.

import type {OpKeys, OutputWords, RevisionWords} from '../protocol/edit_protocol';
import {NEW_OBJECT} from './op_rules';
import type {RowsField} from './op_fields';
import {instantOf, rounded} from './op_values';
import type {Keys} from './op_values';

/** Facts about the shown motion and the recipe, from which new keys get their values. */
export interface Shown {
  /** Duration of the shown motion, and the shown instant. [s] */
  duration_s: number;
  now_s: number;
  rate_hz: number;
  /** Names of its annotations and contact events, with numbers. */
  names: string[];
  sources: string[];
  avatars: string[];
}

/** Rounds to milliseconds, but not beyond the end. */
function within(time_s: number, duration_s: number): number {
  const time = rounded(Math.max(time_s, 0), 3);
  return time <= duration_s ? time : Math.floor(duration_s * 1000) / 1000;
}

/** Returns names as in recipes: "left.strike", "left.strike[1]". The output's contacts give
 *  the events if its annotations do not. */
function namesOf(output: OutputWords | null): string[] {
  if (!output) return [];
  const texts = output.annotations.map(({text}) => text);
  for (const foot of ['left', 'right'] as const) {
    const spans = output.contacts.filter((one) => one.foot === foot).flatMap((one) => one.spans)
      .sort(([a], [b]) => a - b);
    const stances: [number, number][] = [];
    for (const [first, last] of spans) {
      const open = stances.at(-1);
      if (open && first <= open[1] + 1) open[1] = Math.max(open[1], last);
      else stances.push([first, last]);
    }
    const strike = `${foot}.strike`;
    const toe_off = `${foot}.toe_off`;
    const isKnown = [strike, toe_off].map((name) => texts.includes(name));
    for (const [first, last] of stances) {
      if (!isKnown[0] && first > 0) texts.push(strike);
      if (!isKnown[1] && last < output.frames - 1) texts.push(toe_off);
    }
  }
  const counts = new Map<string, number>();
  return texts.map((text) => {
    const count = counts.get(text) ?? 0;
    counts.set(text, count + 1);
    return count === 0 ? text : `${text}[${count}]`;
  });
}

/** `time`: the shown instant. [frames] */
export function shownOf(output: OutputWords | null, time: number,
  revision: Pick<RevisionWords, 'sources' | 'avatars'> | null): Shown {
  const rate_hz = output?.rate_hz || 1;
  const duration_s = Math.max((output?.frames ?? 1) - 1, 0) / rate_hz;
  return {duration_s, now_s: within(time / rate_hz, duration_s), rate_hz,
    names: namesOf(output),
    sources: (revision?.sources ?? []).slice(1).map(({id}) => id),
    avatars: revision?.avatars ?? []};
}

/** Returns why an operation cannot be added; empty: it can. */
export function whyNot(name: string, shown: Shown, ops: readonly {do: string}[]): string {
  if (name === 'splice' && shown.sources.length === 0) {
    return 'The recipe has no second source. Add a [[source]] with an id to its file.';
  }
  if (name !== 'retarget') return '';
  if (shown.avatars.length === 0) return 'There is no avatar next to the recipe.';
  return ops.some((op) => op.do.startsWith('retarget@')) ? 'The recipe has a retarget.' : '';
}

/** Returns a new operation. */
export function newOp(name: string, shown: Shown): OpKeys {
  const {duration_s, now_s, rate_hz, sources, avatars} = shown;
  const end_s = within(duration_s, duration_s);
  const half_s = within(duration_s / 2, duration_s);
  const span: Keys = {from_s: 0, to_s: end_s};
  const keys: Record<string, () => Keys> = {
    cut: () => span,
    keep: () => ({spans: [span]}),
    // Each part has at least one frame.
    split: () => ({instants: [{at_s: now_s * rate_hz >= 1 ? now_s : half_s}]}),
    retime: () => ({duration_s: Math.max(end_s, 0.001)}),
    scale_time: () => ({speed: 1}),
    pose: () => ({at_s: now_s, bone: 'hips', moved_m: [0, 0, 0]}),
    offset: () => ({bone: 'hips', moved_m: [0, 0, 0]}),
    place: () => ({position_xz_m: [0, 0]}),
    jump: () => ({apex_by_m: 0.1}),
    splice: () => ({source: sources[0] ?? ''}),
    contacts: () => ({detect: true}),
    constrain: () => ({detect: 'supports'}),
    tag: () => ({text: 'tag'}),
    event: () => ({text: 'event', at_s: now_s}),
    curve: () => ({name: 'weight', keys: end_s > 0
      ? [{at_s: 0, value: 0}, {at_s: end_s, value: 1}] : [{at_s: 0, value: 0}]}),
    retarget: () => ({avatar: avatars[0] ?? ''}),
  };
  return {do: `${name}@1`, ...keys[name]?.()};
}

/** Returns a constraint that holds the right hand. */
export function newConstraint(): Keys {
  return {type: 'Distance', name: 'hand', segment: 'rightHand', position_m: [0, 1, 0.3]};
}

/** Returns a row that can follow the others of a list. */
export function newRow(field: RowsField, rows: readonly Keys[], shown: Shown): Keys {
  const {now_s, duration_s} = shown;
  const last = rows.at(-1);
  const at = last ? instantOf(last, 'at') : null;
  const after_s = at?.kind === 's' && Number(at.value) >= now_s
    ? within(Math.min(Number(at.value) + 0.1, Math.max(duration_s, Number(at.value) + 0.001)),
      Infinity) : now_s;
  switch (field.key) {
    case 'spans': return {from_s: now_s, to_s: within(duration_s, duration_s)};
    case 'instants': return {at_s: after_s};
    case 'knots': {
      const gap_s = at?.kind === 's' ? after_s - Number(at.value) : 0.1;
      return {at_s: after_s,
        time_s: last ? rounded(Number(last.time_s) + Math.max(gap_s, 0.001), 3) : after_s};
    }
    case 'keys': return {at_s: after_s, value: last?.value ?? 0};
    case 'edits': return {do: 'set', foot: 'left', part: 'heel', from_s: now_s,
      to_s: within(now_s + 0.1, Math.max(duration_s, now_s))};
    case 'objects': {
      let number = rows.length + 1;
      while (rows.some((row) => row.name === `box ${number}`)) number += 1;
      return {...NEW_OBJECT, name: rows.length === 0 ? 'box' : `box ${number}`};
    }
    default: return {};
  }
}
