// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The head of the page of a library's check, and its short tables.

import {button, el} from '../base/elements';
import {percent, plural} from '../base/words';
import {card, cards, lead, showHead, sortableTable, table} from './common';
import type {Grade} from './common';
import {VERDICTS} from './library_data';
import type {CheckSummary, FailedSource, LibraryData} from './library_data';

/** The argument as a shell reads it. */
export function shellWord(text: string): string {
  return /^[\w./+:@%-]+$/.test(text) ? text : `'${text.replaceAll('\'', '\'\\\'\'')}'`;
}

export function hours(value: number): string {
  return value >= 0.1 ? `${value.toFixed(2)}\u00a0h` : `${(60 * value).toFixed(1)}\u00a0min`;
}

const GRADES: readonly Grade[] = ['good', 'fair', 'look closer'];
const MEANING = ['every figure is within its limits', 'a figure is above its limit of warnings',
  'a figure is above its limit of failures'];

export function headSection({summary, folder, left_out}: LibraryData): void {
  const {total, verdicts, failed} = summary;
  const all = Math.max(total.clips, 1);
  const about = [plural(total.clips, 'clip'), hours(total.hours),
    ...(summary.query ? [`query ${summary.query}`] : []),
    ...(summary.duplicates > 0 ? [plural(summary.duplicates, 'duplicate')] : []),
    ...(left_out > 0 ? [`the page has the worst ${total.clips - left_out}`] : [])];
  showHead(summary.library, 'library', about.join(' · '), [
    el('p', {class: 'next'}, 'Play the clips: ',
      el('code', {class: 'command'}, `marey view ${shellWord(folder)}`)),
    cards(...VERDICTS.map((verdict, i) => card(verdict, String(verdicts[verdict].clips), 'clips',
      `${percent(verdicts[verdict].clips / all)}, ${hours(verdicts[verdict].hours)}: ${MEANING[i]}`,
      verdicts[verdict].clips > 0 || i === 0 ? GRADES[i] : null)),
    card('Sources failed', String(failed.length), '',
      failed.length > 0 ? 'gave no clip; their reasons are below' : 'all sources gave clips',
      failed.length > 0 ? 'look closer' : null)),
  ]);
}

export function problemsSection({kinds, total}: CheckSummary, choose: (kind: number) => void):
  HTMLElement[] {
  const all = Math.max(total.clips, 1);
  const place = new Map(kinds.map(({kind}, i) => [kind, i]));
  return [
    lead('A problem is a place in a clip where a figure exceeds its limit.'),
    sortableTable('Kinds of problems', kinds, [
      ['Kind', ({kind}) => button({class: 'link', onclick: () => choose(place.get(kind)!)}, kind),
        '', ({kind}) => kind],
      ['Clips', ({clips}) => String(clips), 'number', ({clips}) => clips],
      ['Share of clips', ({clips}) => percent(clips / all), 'number', ({clips}) => clips],
      ['Places', ({problems}) => String(problems), 'number', ({problems}) => problems],
      ['Time', ({seconds}) => `${seconds.toFixed(1)}\u00a0s`, 'number', ({seconds}) => seconds],
    ], 1),
  ];
}

export function sourcesSection(failed: readonly FailedSource[]): HTMLElement[] {
  return [
    lead('Each source that gave no clip, with its cause and the next step.'),
    table('Sources without clips', failed, [
      ['Source', ({source}) => source],
      ['Cause', ({where, cause}) => el('span', {title: where}, cause)],
      ['Next', ({next}) => next],
    ], 'bounded sources'),
  ];
}
