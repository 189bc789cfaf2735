// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The badge at the top: state of the subject. It is good only if there is no fault.

import type {StatusWords} from '../protocol/protocol';

/** marey sends its status twice a second; after this time the state is unknown. */
export const STATUS_SILENCE_MS = 1250;

const WORDS: Record<StatusWords['subject'], string> = {
  waiting: 'waiting for a performer', tracked: 'tracked', partly: 'tracked in part',
  behind: 'falling behind', stopped: 'no new poses', lost: 'lost',
};

export interface Pill {
  /** Suffix of the CSS class: pill-tracked. */
  state: StatusWords['subject'] | 'offline' | 'file' | 'silent';
  words: string;
  /** Reasons why it is not good; empty: none. */
  why: string;
}

const RUN_WORDS = {playing: 'scene runs', paused: 'scene is paused'};

/** `silent_ms`: time since the last status. `status` null: none received yet. `run`: state of a
 *  scene of marey stage; null: none is shown. */
export function pillOf(connected: boolean, live: boolean,
  status: Pick<StatusWords, 'subject' | 'warnings'> | null, silent_ms: number,
  run: keyof typeof RUN_WORDS | null = null): Pill {
  if (!connected) return {state: 'offline', words: 'not connected', why: ''};
  if (run) return {state: run === 'playing' ? 'tracked' : 'file', words: RUN_WORDS[run], why: ''};
  if (!live) return {state: 'file', words: 'from a file', why: ''};
  if (!status) return {state: 'waiting', words: WORDS.waiting, why: ''};
  if (silent_ms > STATUS_SILENCE_MS) {
    return {state: 'silent', words: 'marey is silent',
      why: 'marey has sent no status for more than a second: the computer may be too busy'};
  }
  const {subject, warnings} = status;
  return {state: subject, words: WORDS[subject] ?? subject, why: (warnings ?? []).join('\n')};
}
