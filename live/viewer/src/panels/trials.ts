// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The selected trial of a results folder. The address contains it, too: a report links to
// /?trial=walk&frame=372 (the recording's frame number) or &t=12.4 (seconds from its start).

import {el} from '../base/elements';
import {Section} from './panels';
import type {FileWords} from '../protocol/protocol';

export class Trials {
  readonly section = new Section('trials', 'Results', true);
  private readonly chooser = el('select', {onchange: () => this.turnTo(this.chooser.value)});
  private readonly query = new URLSearchParams(location.search);
  private wanted = this.query.get('trial');

  constructor(private readonly ask: (name: string) => void) {
    this.section.element.hidden = true;
  }

  /** Returns true if this scene belongs to another trial than the requested one. */
  asksInsteadOf(file: FileWords | null): boolean {
    const {wanted} = this;
    if (!wanted || !file?.trials?.includes(wanted) || file.trial === wanted) return false;
    this.ask(wanted);
    return true;
  }

  /** Sets the available trials. */
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

  /** Returns the frame of the address, counted from 0; only once. */
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
    // The address names this trial, so that a reload shows it again.
    history.replaceState(null, '', `?${this.query.toString()}`);
    this.ask(name);
  }
}
