// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Status of the session: latency, stages, cameras, outputs, messages.

import {el, keepRows, setText} from '../base/elements';
import {milliseconds} from '../base/words';
import {Messages} from './messages';
import {Section} from './panels';
import type {StatusWords} from '../protocol/protocol';

export function count(value: number): string {
  return value.toLocaleString('en', {maximumFractionDigits: 0});
}

export class StatusPanel {
  readonly section = new Section('status', 'Status', false);
  private readonly facts = el('dl', {class: 'facts'});
  private readonly overload = el('p', {class: 'warning'});
  private readonly stages = table('Stages', 'Stage', 'p50', 'p95');
  private readonly cameras = table('Cameras', 'Camera', 'Frames', 'Dropped');
  private readonly outputs = table('Outputs', 'Output', 'Sent', 'Failed');
  private readonly messages = el('ul', {class: 'messages', 'aria-live': 'polite',
    'aria-label': 'Messages'});
  private readonly said = new Messages();

  constructor() {
    this.section.body.append(this.overload, this.facts, this.stages.table, this.cameras.table,
      this.outputs.table, this.messages);
    for (const part of [this.overload, this.stages.table, this.cameras.table,
      this.outputs.table]) part.hidden = true;
  }

  /** A file has no status but may have messages. */
  load(live: boolean): void {
    this.section.hidden = !live && this.said.shown().length === 0;
  }

  show(status: StatusWords): void {
    this.section.tell(`${status.rate_hz.toFixed(0)} Hz`);
    this.overload.hidden = status.overload === '' || status.overload === 'none';
    setText(this.overload, status.overload);
    this.showFacts(status);
    rows(this.stages, status.stages.map(({name, p50_ms, p95_ms}) =>
      [name, milliseconds(p50_ms), milliseconds(p95_ms)]));
    rows(this.cameras, status.cameras.map(({name, state, frames, dropped, detail}) =>
      [state === 'streaming' ? name : `${name} (${state})${detail && `: ${detail}`}`,
        count(frames), count(dropped)]));
    rows(this.outputs, status.outputs.map(({name, sent, failed, detail}) =>
      [detail ? `${name}: ${detail}` : name, count(sent), count(failed)]));
    this.said.serve(status.messages);
    this.showMessages();
  }

  /** Adds a message of the page itself. */
  tell(message: string): void {
    this.said.add(message);
    this.section.hidden = false;
    this.showMessages();
  }

  private showMessages(): void {
    keepRows(this.messages, this.said.shown(), () => el('li'),
      (row, text) => setText(row, text));
  }

  private showFacts(status: StatusWords): void {
    const facts: [string, string][] = [
      ['Frame', `${count(status.frame)} at ${status.rate_hz.toFixed(1)} Hz`],
      ['Frame to packet', status.latency_ms
        ? `${milliseconds(status.latency_ms.p50)}, p95 ${milliseconds(status.latency_ms.p95)}`
        : '–'],
      ['Recording', status.recording ? `${status.recording.file}, ` +
        `${status.recording.seconds.toFixed(0)} s` : 'off'],
      ['Pages open', count(status.clients)],
    ];
    if (status.recording?.trouble) facts.push(['Recording trouble', status.recording.trouble]);
    keepRows(this.facts, facts, () => el('div', {}, el('dt'), el('dd')),
      (row, [name, value]) => {
        setText(row.children[0] as HTMLElement, name);
        setText(row.children[1] as HTMLElement, value);
      });
  }
}

interface Table {
  table: HTMLTableElement;
  body: HTMLElement;
}

function table(caption: string, ...heads: string[]): Table {
  const body = el('tbody');
  return {body, table: el('table', {}, el('caption', {class: 'unseen'}, caption),
    el('thead', {}, el('tr', {}, ...heads.map((head, i) =>
      el('th', {scope: 'col', class: i > 0 && 'number'}, head)))), body)};
}

function rows({table: shown, body}: Table, cells: readonly string[][]): void {
  shown.hidden = cells.length === 0;
  keepRows(body, cells, () => el('tr', {}, el('th', {scope: 'row'}),
    el('td', {class: 'number'}), el('td', {class: 'number'})), (row, texts) => {
    texts.forEach((text, i) => setText(row.children[i] as HTMLElement, text));
  });
}
