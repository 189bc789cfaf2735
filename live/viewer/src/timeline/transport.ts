// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Playback buttons: play, step, speed, loop, live.

import {button, chooser, el, remember, remembered, setText} from '../base/elements';
import type {Playback} from './playback';
import type {Timeline} from './timeline';

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2];

export class Transport {
  readonly element: HTMLElement;
  private readonly playButton: HTMLButtonElement;
  private readonly liveButton: HTMLButtonElement;
  private readonly loopButton: HTMLButtonElement;
  private readonly foldButton: HTMLButtonElement;
  private readonly clock = el('output', {class: 'clock'});
  private live = false;
  private folded = false;

  /** `changed` is called when the user changes the time or its speed. `keepOpen`: the rows of
   *  the timeline are always shown. */
  constructor(private readonly playback: Playback, private readonly timeline: Timeline,
    private readonly changed: () => void, private readonly options: {keepOpen?: boolean} = {}) {
    this.playButton = this.button('play', 'Play (space)', () => this.toggle());
    this.liveButton = this.button('live-button', 'Go to now (End)', () => {
      playback.follow();
      changed();
    }, 'Live');
    this.loopButton = this.button('loop', 'Repeat from the start', () => this.setLoop(
      !playback.loop), 'Loop');
    this.foldButton = this.button('fold', 'Segments, contacts and graphs',
      () => this.toggleFold(), 'Details');
    const speed = chooser(SPEEDS.map((value) => [value, `${value} ×`]), 1, (value) => {
      playback.speed = Number(value);
      changed();
    }, {'aria-label': 'Speed'});
    const back = this.button('step', 'One frame back (left arrow)', () => this.step(-1));
    back.append('‹');
    const on = this.button('step', 'One frame forward (right arrow)', () => this.step(1));
    on.append('›');
    this.element = el('div', {class: 'transport'}, back, this.playButton, on, this.liveButton,
      this.clock, el('span', {class: 'spring'}), speed, this.loopButton, this.foldButton);
    this.setFolded(!options.keepOpen && remembered('timeline') !== 'open', false);
  }

  /** Adapts the buttons to a scene of another kind. */
  setMode(live: boolean): void {
    this.live = live;
    this.liveButton.hidden = !live;
    this.loopButton.hidden = live;
    this.foldButton.hidden = this.options.keepOpen === true || !this.timeline.foldable;
  }

  toggle(): void {
    if (this.playback.playing) this.playback.pause();
    else this.playback.play();
    this.changed();
  }

  step(count: number): void {
    this.playback.step(count);
    this.changed();
  }

  setLoop(loop: boolean): void {
    this.playback.loop = loop;
    this.loopButton.setAttribute('aria-pressed', String(loop));
    this.changed();
  }

  show(): void {
    const {playback} = this;
    const word = playback.playing ? '❚❚' : '▶';
    setText(this.playButton, word);
    const label = playback.playing ? 'Pause (space)' : 'Play (space)';
    if (this.playButton.title !== label) {
      this.playButton.title = label;
      this.playButton.setAttribute('aria-label', label);
    }
    this.liveButton.setAttribute('aria-pressed', String(playback.following));
    setText(this.clock, this.live && playback.following ? 'now'
      : this.timeline.clock(playback.frame));
  }

  toggleFold(): void {
    if (this.options.keepOpen) return;
    this.setFolded(!this.folded);
  }

  private setFolded(folded: boolean, keep = true): void {
    this.folded = folded;
    if (keep) remember('timeline', folded ? 'folded' : 'open');
    this.timeline.fold(folded);
    setText(this.foldButton, folded ? 'Details ▴' : 'Details ▾');
    this.foldButton.setAttribute('aria-expanded', String(!folded));
  }

  private button(kind: string, label: string, pressed: () => void, text?: string):
    HTMLButtonElement {
    return button({class: kind, title: label,
      'aria-label': text ? null : label, onclick: pressed}, text);
  }
}
