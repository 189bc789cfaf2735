// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Details of the chosen clip: figures, problems, labels, similar clips, origin.

import {button, checkbox, el} from '../base/elements';
import {boneWords, duration, plural} from '../base/words';
import {Section} from '../panels/panels';
import type {
  ClipSpan, ClipWords, FigureWords, LabelForm, NeighbourWords, ProblemWords, VerdictForm,
} from '../protocol/library_protocol';
import {labelForm, verdictForm} from './corrections';
import type {Stored} from './corrections';
import {figureMeaning, figureName, figureValue, verdictOfKind, worstFirst} from './figure_words';

export interface PanelActions {
  /** Shows a frame of the clip. */
  jump(frame: number): void;
  open(clip: NeighbourWords): void;
  setMirrored(mirrored: boolean): void;
  storeVerdict(form: VerdictForm): Promise<Stored>;
  storeLabel(form: LabelForm): Promise<Stored>;
  /** The shown instant since the first frame of the clip. [s] */
  now_s(): number;
}

const MAX_PROBLEMS = 60;

export class ClipPanel {
  private readonly quality = new Section('clip-quality', 'Quality', true);
  private readonly labels = new Section('clip-labels', 'Labels', true);
  private readonly similar = new Section('clip-similar', 'Similar clips', true);
  private readonly origin = new Section('clip-origin', 'Origin', true);
  readonly sections = [this.quality, this.similar, this.labels, this.origin];

  constructor(private readonly actions: PanelActions) {
    this.setHidden(true);
  }

  /** null: no clip is chosen. */
  show(clip: ClipWords | null): void {
    this.setHidden(!clip);
    if (!clip) return;
    this.showQuality(clip);
    this.showSimilar(clip);
    this.showLabels(clip);
    this.showOrigin(clip);
  }

  private setHidden(hidden: boolean): void {
    for (const section of this.sections) section.hidden = hidden;
  }

  // --- Quality ---

  private showQuality(clip: ClipWords): void {
    const {quality} = clip.row;
    const place = el('div');
    const sorted = worstFirst(clip.figures);
    const judged = sorted.filter(({verdict}) => verdict === 'fail' || verdict === 'warn');
    const rest = sorted.filter((one) => !judged.includes(one));
    this.quality.tell(quality);
    this.quality.body.replaceChildren(
      el('div', {class: 'row'}, el('span', {class: `verdict-word verdict-${quality}`}, quality),
        el('span', {class: 'spring'}), this.wrongButton(clip, 'quality', null, quality, place,
          'Wrong verdict …')),
      place, ...this.figureTable(clip, judged), ...this.problemList(clip),
      el('details', {class: 'more'}, el('summary', {},
        `${plural(rest.length, judged.length > 0 ? 'other figure' : 'figure')}`),
      ...this.figureTable(clip, rest)));
  }

  private figureTable(clip: ClipWords, figures: readonly FigureWords[]): HTMLElement[] {
    if (figures.length === 0) return [];
    return [el('table', {class: 'figures'}, el('tbody', {}, ...figures.flatMap((figure) =>
      this.figureRows(clip, figure))))];
  }

  private figureRows(clip: ClipWords, figure: FigureWords): HTMLElement[] {
    const {name, value, verdict, joint, frames, warn, fail} = figure;
    const limits = warn === null || fail === null ? ''
      : `Warning above ${figureValue(name, warn)}, failure above ${figureValue(name, fail)}. `;
    const place = el('div');
    const more = el('tr', {class: 'figure-form'}, el('td', {colspan: 4}, place));
    const where = [joint && boneWords(joint), frames && `frame ${frames[0]}`].filter((word) => word)
      .join(', ');
    const label = el('td', {title: figureMeaning(name)}, frames
      ? button({class: 'link', title: `Show frame ${frames[0]}`,
        onclick: () => this.actions.jump(frames[0])}, figureName(name)) : figureName(name),
    where && el('span', {class: 'quiet'}, where));
    const row = el('tr', {},
      el('td', {}, el('span', {class: `mark verdict-${verdict ?? 'none'}`,
        title: verdict ?? 'no verdict'})), label,
      el('td', {class: 'value', title: limits}, figureValue(name, value)),
      el('td', {}, verdict && this.wrongButton(clip, name, frames, verdict, place, '✎')));
    return [row, more];
  }

  private wrongButton(clip: ClipWords, figure: string, frames: ClipSpan | null,
    now: FigureWords['verdict'], place: HTMLElement, text: string): HTMLButtonElement {
    const close = (): void => {
      place.replaceChildren();
      opener.focus();
    };
    const opener = button({class: text.length > 1 ? 'wrong' : 'icon wrong',
      title: 'This verdict is wrong', 'aria-label': `The verdict on ${figureName(figure)} is wrong`,
      onclick: () => {
        if (place.firstChild) {
          close();
          return;
        }
        const form = verdictForm(clip.row.clip_id, figure, frames, now,
          (words) => this.actions.storeVerdict(words), close);
        place.replaceChildren(form);
        form.querySelector('select')?.focus();
      }}, text);
    return opener;
  }

  private problemList(clip: ClipWords): HTMLElement[] {
    const {problems} = clip;
    if (problems.length === 0) return [];
    const rest = problems.length - MAX_PROBLEMS;
    return [el('div', {class: 'problems', role: 'group', 'aria-label': 'Problems'},
      ...problems.slice(0, MAX_PROBLEMS).map((problem) => this.problemButton(clip, problem)),
      rest > 0 && el('span', {class: 'quiet'}, `and ${rest} more`))];
  }

  private problemButton(clip: ClipWords, {frames, kind, joint}: ProblemWords): HTMLElement {
    const [first, last] = frames;
    return button({class: `problem verdict-${verdictOfKind(clip, kind)}`,
      title: `Show frame ${first}`, onclick: () => this.actions.jump(first)},
    `${kind}${joint ? ` ${boneWords(joint)}` : ''} ${first === last ? first : `${first}–${last}`}`);
  }

  // --- Similar clips ---

  private showSimilar(clip: ClipWords): void {
    const {neighbours, neighbour_trouble, mirrored, compared_s, row} = clip;
    this.similar.tell(mirrored ? 'mirrored' : '');
    this.similar.body.replaceChildren(
      checkbox('Mirrored', mirrored, (on) => this.actions.setMirrored(on),
        {title: 'Search for the mirror image of this clip'}),
      ...(neighbour_trouble ? [el('p', {class: 'problem-text'}, neighbour_trouble)] : []),
      el('ol', {class: 'neighbours'}, ...neighbours.map((one, i) => this.neighbour(one, i))),
      neighbours.length === 0 && !neighbour_trouble
        ? el('p', {class: 'quiet'}, 'No other clip is comparable.')
        : el('p', {class: 'quiet'}, compared_s > 0 && compared_s < row.seconds - 0.15
          ? `Compared: the first ${duration(compared_s)}.` : ''));
  }

  private neighbour(one: NeighbourWords, index: number): HTMLElement {
    return el('li', {}, button({class: 'neighbour', title: `Open ${one.name}`,
      onclick: () => this.actions.open(one)},
    el('b', {}, String(index + 1)), el('span', {class: 'clip-name'}, one.name),
    el('span', {class: `mark verdict-${one.quality}`, title: one.quality}),
    el('span', {class: 'distance', title: 'Mean distance of the features'},
      one.distance.toFixed(2)),
    el('span', {class: 'quiet'}, one.trouble || [
      `${one.start_s.toFixed(1)}–${duration(one.end_s)}`, one.subject, one.labels[0]]
      .filter((word) => word).join(' · '))));
  }

  // --- Labels ---

  private showLabels(clip: ClipWords): void {
    const given = clip.labels.filter(({by}) => by !== 'marey');
    const found = new Set(clip.labels.filter(({by}) => by === 'marey').map(({text}) => text));
    const place = el('div');
    const close = (): void => place.replaceChildren();
    this.labels.tell(given.length > 0 ? String(given.length) : '');
    this.labels.body.replaceChildren(
      el('ul', {class: 'labels-given'}, ...given.map(({text, start_s, end_s, by}) =>
        el('li', {}, button({class: 'link', title: `By ${by}`,
          onclick: () => this.actions.jump(Math.round(start_s * clip.row.rate_hz))}, text),
        el('span', {class: 'quiet'}, `${start_s.toFixed(1)}–${duration(end_s)}`)))),
      button({class: 'add-label', onclick: () => {
        const form = labelForm(clip.row.clip_id, {start_s: 0, end_s: clip.row.seconds,
          now_s: () => this.actions.now_s()}, (words) => this.actions.storeLabel(words), close);
        place.replaceChildren(form);
        form.querySelector('input')?.focus();
      }}, 'Add a label …'), place,
      ...(found.size > 0 ? [el('p', {class: 'quiet'},
        `Found by marey: ${[...found].sort().join(', ')}.`)] : []));
  }

  // --- Origin ---

  private showOrigin(clip: ClipWords): void {
    const {provenance: from, row, frames, rate_by} = clip;
    const facts: [string, string][] = [['licence', from.licence], ['name to state',
      from.attribution], ['subject', from.subject], ['split', row.split],
    ['file', from.path], ['frames', `${frames[0]} to ${frames[1]}`],
    ['rate', `${row.rate_hz} Hz, by ${rate_by}`], ['body', clip.body], ['origin', from.origin],
    ['version', from.commit], ['duplicate of', clip.duplicate_of], ['mirror of', clip.mirror_of],
    ['clip', row.clip_id], ['object', clip.object_key.slice(0, 16)]];
    this.origin.tell(from.licence);
    this.origin.body.replaceChildren(el('dl', {class: 'facts'}, ...facts
      .filter(([, value]) => value !== '').map(([name, value]) =>
        el('div', {}, el('dt', {}, name), el('dd', {title: value}, value)))));
  }
}
