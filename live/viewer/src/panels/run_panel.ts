// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A scene that runs live: play, pause, restart, and its figures as they are measured.

import {button, el, keepRows, setText} from '../base/elements';
import type {FigureWords, RunAction, RunWords} from '../protocol/run_protocol';
import {Section} from './panels';

/** Returns a value with its unit; a dash if there is none yet. */
export function figureText({value, unit}: Pick<FigureWords, 'value' | 'unit'>): string {
  if (value === null) return '–';
  const size = Math.abs(value);
  const digits = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;
  return unit ? `${value.toFixed(digits)} ${unit}` : value.toFixed(digits);
}

/** Returns the time of a scene: "12.3 of 30.0 s". A scene goes on after its duration. */
export function timeText({time_s, duration_s}: Pick<RunWords, 'time_s' | 'duration_s'>): string {
  if (time_s > duration_s) return `${time_s.toFixed(1)} s, the script ended`;
  return `${time_s.toFixed(1)} of ${duration_s.toFixed(1)} s`;
}

export class RunPanel {
  readonly section = new Section('run', 'Scene', true);
  private readonly play: HTMLButtonElement;
  private readonly time = el('output', {class: 'clock'});
  private readonly rows = el('tbody');
  private readonly figures: HTMLElement;
  private readonly messages = el('ul', {class: 'messages', 'aria-live': 'polite'});
  private state: RunWords['state'] = 'playing';

  constructor(private readonly act: (action: RunAction) => void) {
    this.play = button({class: 'primary run-play', onclick: () => this.toggle()}, 'Pause scene');
    const restart = button({class: 'run-restart', onclick: () => this.act('restart')}, 'Restart');
    this.figures = el('table', {}, el('caption', {class: 'unseen'}, 'Figures'),
      el('thead', {}, el('tr', {}, el('th', {scope: 'col'}, 'Figure'),
        el('th', {scope: 'col', class: 'number'}, 'Value'),
        el('th', {scope: 'col', class: 'number'}, 'Bound'))), this.rows);
    this.section.body.append(el('div', {class: 'row'}, this.play, restart, this.time),
      this.figures, this.messages, el('p', {class: 'note'},
        'Drag a target to move it. A double click on it returns it to its path.'));
    this.section.hidden = true;
  }

  load(isRun: boolean): void {
    this.section.hidden = !isRun;
  }

  /** Pauses a scene that plays; otherwise plays it. */
  toggle(): void {
    this.act(this.state === 'playing' ? 'pause' : 'play');
  }

  show(run: RunWords): void {
    this.state = run.state;
    const isPlaying = run.state === 'playing';
    setText(this.play, isPlaying ? 'Pause scene' : 'Play scene');
    setText(this.time, timeText(run));
    this.section.tell(run.state);
    this.figures.hidden = run.figures.length === 0;
    keepRows(this.rows, run.figures, () => el('tr', {}, el('th', {scope: 'row'}),
      el('td', {class: 'number'}), el('td', {class: 'number'})), (row, figure) => {
      const [name, value, bound] = [...row.children] as HTMLElement[];
      setText(name, figure.name);
      setText(value, figureText(figure));
      setText(bound, figure.passed === null ? figure.bound
        : `${figure.bound} ${figure.passed ? '✓' : '✗'}`);
      row.className = figure.passed === false ? 'failed' : '';
    });
    keepRows(this.messages, run.messages, () => el('li'), (row, text) => setText(row, text));
  }
}
