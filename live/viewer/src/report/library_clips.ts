// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The table of a library's clips: sorted, filtered, rows made as they come into view.

import {button, chooser, el} from '../base/elements';
import {boneWords, plural} from '../base/words';
import {lead} from './common';
import {VERDICTS} from './library_data';
import type {Clip, LibraryData, Problem} from './library_data';
import {figureWords, withFigureUnit} from './library_figures';
import {shellWord} from './library_sections';

const ROWS_AT_ONCE = 60;
const DELAY_MS = 120;

type Key = 'rank' | 'name' | 'seconds' | 'problems' | 'figure';

export class ClipTable {
  readonly elements: HTMLElement[];
  private readonly body = el('tbody');
  private readonly head = el('tr');
  private readonly count = el('p', {class: 'count', role: 'status'});
  private readonly more = el('p', {class: 'more'});
  private readonly kindChooser: HTMLSelectElement;
  private readonly figureChooser: HTMLSelectElement;
  private shown: Clip[] = [];
  private words = '';
  private verdict = '';
  private kind = -1;
  private figure = -1;
  private key: Key = 'rank';
  private downward = true;
  private timer = 0;

  constructor(private readonly clips: readonly Clip[], private readonly data: LibraryData) {
    const {kinds, figures} = data.summary;
    const search = el('input', {type: 'search', placeholder: 'Name, id, source or problem',
      'aria-label': 'Filter clips', oninput: () => {
        clearTimeout(this.timer);
        this.timer = window.setTimeout(() => {
          this.words = search.value.toLowerCase().trim();
          this.update();
        }, DELAY_MS);
      }});
    this.kindChooser = chooser([[-1, 'all problems'],
      ...kinds.map(({kind}, i): [number, string] => [i, kind])], -1, (value) =>
      this.chooseKind(Number(value)));
    this.figureChooser = chooser([[-1, 'no figure'],
      ...figures.map(({figure}, i): [number, string] => [i, figureWords(figure).name])], -1,
    (value) => this.chooseFigure(Number(value)));
    this.elements = [
      lead('Marks on the bar are problems, on the time of the clip. A click on a clip shows its ' +
        'figures.'),
      el('div', {class: 'filters'}, search,
        el('label', {}, 'Verdict ', chooser([['', 'all'], ...VERDICTS.map((verdict, i):
        [number, string] => [i, verdict])], '', (value) => {
          this.verdict = value;
          this.update();
        })),
        el('label', {}, 'Problem ', this.kindChooser),
        el('label', {}, 'Figure ', this.figureChooser), this.count),
      el('div', {class: 'scroll clips', tabindex: 0, role: 'region', 'aria-label': 'Clips'},
        el('table', {}, el('caption', {class: 'unseen'}, 'Clips'), el('thead', {}, this.head),
          this.body)),
      this.more];
    new IntersectionObserver((entries) => {
      if (entries.some(({isIntersecting}) => isIntersecting)) this.addRows();
    }, {rootMargin: '600px'}).observe(this.more);
    this.update();
  }

  get shownRows(): number {
    return this.body.querySelectorAll('tr.clip').length;
  }

  /** Shows a figure of all clips, the worst first; -1: none. */
  chooseFigure(figure: number): void {
    this.figure = figure;
    this.figureChooser.value = String(figure);
    this.key = figure < 0 ? 'rank' : 'figure';
    this.downward = true;
    this.update();
  }

  /** Shows the clips with a kind of problem; -1: all. */
  chooseKind(kind: number): void {
    this.kind = kind;
    this.kindChooser.value = String(kind);
    this.update();
  }

  private update(): void {
    this.shown = this.clips.filter((clip) => clip.words.includes(this.words) &&
      (this.verdict === '' || clip.verdict === Number(this.verdict)) &&
      (this.kind < 0 || clip.problems.some(({kind}) => kind === this.kind)) &&
      (this.key !== 'figure' || clip.values[this.figure] !== null));
    this.sort();
    this.count.textContent = this.shown.length === this.clips.length
      ? plural(this.clips.length, 'clip') : `${this.shown.length} of ${
        plural(this.clips.length, 'clip')}`;
    this.writeHead();
    this.body.replaceChildren();
    this.addRows();
  }

  private sort(): void {
    const value: Record<Key, (clip: Clip) => number> = {rank: ({rank}) => -rank,
      name: () => 0, seconds: ({seconds}) => seconds, problems: ({problems}) => problems.length,
      figure: ({values}) => values[this.figure] ?? -Infinity};
    const of = value[this.key];
    const way = this.downward ? 1 : -1;
    const names = new Intl.Collator('en', {numeric: true});
    this.shown.sort((a, b) => way * (this.key === 'name' ? names.compare(a.name, b.name)
      : of(b) - of(a)) || a.rank - b.rank);
  }

  private writeHead(): void {
    const {figures} = this.data.summary;
    const columns: [string, Key, string][] = [['Clip', 'name', ''], ['Verdict', 'rank', ''],
      ['Duration', 'seconds', 'number'], ['Problems', 'problems', ''],
      ['', 'problems', 'bar-head']];
    if (this.figure >= 0) {
      columns.push([figureWords(figures[this.figure].figure).name, 'figure', 'number']);
    }
    this.head.replaceChildren(...columns.map(([title, key, look]) => {
      if (!title) return el('th', {class: look});
      const isChosen = key === this.key;
      const mark = !isChosen ? '' : this.downward ? ' ▾' : ' ▴';
      return el('th', {class: look, scope: 'col'}, button({class: 'sort',
        'aria-pressed': String(isChosen), onclick: () => {
          this.downward = !isChosen || !this.downward;
          this.key = key;
          this.update();
        }}, title + mark));
    }));
  }

  private addRows(): void {
    const from = this.shownRows;
    const next = this.shown.slice(from, from + ROWS_AT_ONCE);
    this.body.append(...next.map((clip) => this.row(clip)));
    const left = this.shown.length - from - next.length;
    this.more.textContent = left > 0 ? `${left} more below` : this.data.left_out > 0
      ? `${this.data.left_out} better clips are not on this page.` : '';
  }

  private row(clip: Clip): HTMLElement {
    const {figures, kinds} = this.data.summary;
    const value = this.figure < 0 ? null : clip.values[this.figure];
    const opener = button({class: 'link', 'aria-expanded': 'false', title: clip.source,
      onclick: () => this.toggle(clip, row, opener)}, clip.name || clip.id);
    const row = el('tr', {class: 'clip'}, el('th', {scope: 'row'}, opener),
      el('td', {class: `verdict-${VERDICTS[clip.verdict]}`}, VERDICTS[clip.verdict]),
      el('td', {class: 'number'}, `${clip.seconds.toFixed(2)}\u00a0s`),
      el('td', {class: 'kinds'}, [...new Set(clip.problems.map(({kind}) => kinds[kind].kind))]
        .join(', ')),
      el('td', {}, this.bar(clip)),
      this.figure >= 0 && el('td', {class: `number verdict-${VERDICTS[
        clip.verdicts[this.figure] ?? 0]}`},
      value === null ? '–' : withFigureUnit(value, figures[this.figure].figure)));
    return row;
  }

  private problemWords({kind, joint, start_s, end_s, value}: Problem): string {
    return `${this.data.summary.kinds[kind].kind}${joint ? `, ${boneWords(joint)}` : ''}, ${
      start_s.toFixed(2)} to ${end_s.toFixed(2)} s: ${Number(value.toPrecision(4))}`;
  }

  /** Problems of the whole clip are a thin line, others marks of at least three pixels. */
  private bar(clip: Clip): HTMLElement {
    const words = clip.problems.map((problem) => this.problemWords(problem));
    const bar = el('div', {class: 'bar', role: 'img',
      'aria-label': words.length > 0 ? words.join('; ') : 'no problems'});
    clip.problems.forEach((problem, i) => {
      const start = 100 * problem.start_s / clip.seconds;
      const width = 100 * (problem.end_s - problem.start_s) / clip.seconds;
      bar.append(el('span', {class: `mark ${VERDICTS[problem.verdict]}${
        width > 95 ? ' whole' : ''}${this.kind >= 0 && problem.kind !== this.kind
        ? ' other' : ''}`, title: words[i], style: `left: ${start.toFixed(2)}%; width: ${
        width.toFixed(2)}%`}));
    });
    return bar;
  }

  private toggle(clip: Clip, row: HTMLElement, opener: HTMLElement): void {
    const isOpen = opener.getAttribute('aria-expanded') === 'true';
    opener.setAttribute('aria-expanded', String(!isOpen));
    if (isOpen) row.nextElementSibling!.remove();
    else row.after(el('tr', {class: 'detail'}, el('td', {colspan: 6}, this.detail(clip))));
  }

  private detail(clip: Clip): HTMLElement {
    const {figures} = this.data.summary;
    const query = `marey view ${shellWord(this.data.folder)} --query ${
      shellWord(`id=${clip.id}`)}`;
    const entries = figures.map((summary, i): [number, HTMLElement | null] => {
      const value = clip.values[i];
      if (value === null) return [0, null];
      const verdict = clip.verdicts[i] ?? 0;
      const place = clip.places.get(i);
      const where = place ? [place.joint && boneWords(place.joint),
        place.start_s !== null && `${place.start_s.toFixed(2)} s`].filter(Boolean).join(', ') : '';
      return [verdict, el('li', {class: `verdict-${VERDICTS[verdict]}`,
        title: summary.limits ? `limits ${summary.limits.join(', ')}` : 'only reported'},
      `${figureWords(summary.figure).name} `, el('b', {}, withFigureUnit(value, summary.figure)),
      where && ` ${where}`)];
    }).filter(([, entry]) => entry).sort(([a], [b]) => b - a);
    return el('div', {}, el('p', {}, `${clip.source} · ${clip.id} · `,
      el('code', {class: 'command'}, query)),
    el('ul', {class: 'values'}, ...entries.map(([, entry]) => entry)),
    clip.problems.length > 0 && el('ul', {class: 'places'}, ...clip.problems.map((problem) =>
      el('li', {class: `verdict-${VERDICTS[problem.verdict]}`}, this.problemWords(problem)))));
  }
}
