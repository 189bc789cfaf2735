// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Which trial of a folder of results is looked at. The address says it, too: a report links
// to /?trial=walk&frame=372 (as the recording numbers it) or &t=12.4 (seconds from its start).

import {el} from './elements';
import {Section} from './panels';
import type {FileWords} from './protocol';

export class Trials {
  readonly section = new Section('trials', 'Results', true);
  private readonly chooser = el('select', {onchange: () => this.turnTo(this.chooser.value)});
  private readonly query = new URLSearchParams(location.search);
  private wanted = this.query.get('trial');

  constructor(private readonly ask: (name: string) => void) {
    this.section.element.hidden = true;
  }

  /** True when this scene is not of the trial that is wanted, which was asked for. */
  asksInsteadOf(file: FileWords | null): boolean {
    const {wanted} = this;
    if (!wanted || !file?.trials?.includes(wanted) || file.trial === wanted) return false;
    this.ask(wanted);
    return true;
  }

  /** What there is to choose from. */
  show(file: FileWords | null): void {
    const trials = file?.trials ?? [];
    const report = file?.report ?? '';
    this.section.element.hidden = trials.length < 2 && report === '';
    this.chooser.replaceChildren(...trials.map((name) =>
      el('option', {value: name, selected: name === file?.trial}, name)));
    this.section.body.replaceChildren(
      ...(trials.length > 1 ? [el('label', {class: 'row'}, 'Trial ', this.chooser)] : []),
      ...(report ? [el('a', {class: 'report', href: report}, 'Its report')] : []));
  }

  /** The frame that the address names, counted from 0, once. */
  takeFrame(file: FileWords | null, rate_hz: number): number | null {
    if (!file) return null;
    const [frame, seconds] = ['frame', 't'].map((name) => {
      const text = this.query.get(name);
      this.query.delete(name);
      return text === null || text.trim() === '' ? NaN : Number(text);
    });
    if (Number.isFinite(frame)) return frame - file.first_frame;
    return Number.isFinite(seconds) ? seconds * rate_hz : null;
  }

  private turnTo(name: string): void {
    this.wanted = name;
    this.query.set('trial', name);
    // So that the address is this one's, and a reload stays here.
    history.replaceState(null, '', `?${this.query.toString()}`);
    this.ask(name);
  }
}
