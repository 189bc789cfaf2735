// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The bar at the top: title, status, and buttons.

import {el, setText} from '../base/elements';
import {pillOf} from './pill';
import type {RunWords} from '../protocol/run_protocol';
import type {SceneWords, StatusWords} from '../protocol/protocol';
import type {Theme} from '../base/theme';
import {milliseconds} from '../base/words';

/** Action of the record button, and state of the current recording. */
function recordWords(recording: StatusWords['recording']): string {
  if (!recording) return 'Record';
  if (recording.trouble) return 'Recording failed';
  return recording.seconds > 0 ? `Stop ${recording.seconds.toFixed(0)} s` : 'Stop (beginning)';
}

export class Header {
  private readonly title = el('h1', {}, 'marey');
  private readonly pill = el('span', {class: 'pill', role: 'status', 'aria-live': 'polite'});
  private readonly figures = el('span', {class: 'figures'});
  private readonly recordButton: HTMLButtonElement;
  private readonly banner = el('p', {class: 'banner', role: 'alert', hidden: true});
  private live = false;
  /** State of a scene of marey stage; null: none is shown. */
  private run: RunWords['state'] | null = null;
  private connected = false;
  private recording = false;
  private status: StatusWords | null = null;
  private statusAt_ms = 0;

  constructor(element: HTMLElement, stage: HTMLElement, theme: Theme,
    buttons: HTMLElement[], record: (on: boolean) => void) {
    this.recordButton = el('button', {type: 'button', class: 'record', 'aria-pressed': 'false',
      hidden: true, onclick: () => record(!this.recording)}, 'Record');
    const themeButton = el('button', {type: 'button', class: 'icon theme', title:
      'Dark or light colours', 'aria-label': 'Dark or light colours',
    onclick: () => theme.choose(theme.dark ? 'light' : 'dark')}, '◐');
    element.append(this.title, this.pill, this.figures, el('span', {class: 'spring'}),
      this.recordButton, themeButton, ...buttons);
    stage.append(this.banner);
    this.tell();
  }

  setScene(scene: SceneWords): void {
    this.live = scene.mode === 'live' && !scene.run;
    this.run = scene.run ? this.run ?? 'playing' : null;
    setText(this.title, scene.title || 'marey');
    document.title = scene.title ? `${scene.title} – marey` : 'marey';
    this.recordButton.hidden = !this.live;
    this.figures.hidden = !this.live;
    this.tell();
  }

  setConnected(connected: boolean): void {
    this.connected = connected;
    // A status from before the disconnection is outdated.
    if (!connected) this.status = null;
    this.banner.hidden = connected;
    setText(this.banner, connected ? ''
      : 'The connection to marey is lost. Check that it is still running. The page reconnects ' +
        'when it is.');
    this.tell();
  }

  setRun(state: RunWords['state']): void {
    this.run = state;
    this.tell();
  }

  setStatus(status: StatusWords): void {
    this.status = status;
    this.statusAt_ms = performance.now();
    const latency = status.latency_ms ? ` · ${milliseconds(status.latency_ms.p50)}` : '';
    setText(this.figures, `${status.rate_hz.toFixed(0)} Hz${latency}`);
    this.recording = status.recording !== null;
    this.recordButton.setAttribute('aria-pressed', String(this.recording));
    setText(this.recordButton, recordWords(status.recording));
    this.recordButton.title = status.recording?.trouble || status.recording?.file || '';
    this.tell();
  }

  /** Also called a few times per second, so that a missing status becomes visible. */
  tell(): void {
    const {state, words, why} = pillOf(this.connected, this.live, this.status,
      performance.now() - this.statusAt_ms, this.run);
    setText(this.pill, words);
    if (this.pill.title !== why) this.pill.title = why;
    const name = `pill pill-${state}`;
    if (this.pill.className !== name) this.pill.className = name;
  }
}
