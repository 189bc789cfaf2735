// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Calibration in steps: stand, move, done.

import {el, keepRows, setText} from '../base/elements';
import {Guidance, setProgress} from './guidance';
import {Section} from './panels';
import type {CameraWords, WizardAction, WizardStep, WizardWords} from '../protocol/protocol';

const STEPS: [WizardStep, string][] = [['stand', 'Stand'], ['move', 'Move'], ['solve', 'Solve'],
  ['done', 'Done']];
const COLUMNS = 8;
const ROWS = 6;
/** Time for which an error is shown. */
const REFUSAL_MS = 6000;

export class WizardPanel {
  readonly section: Section;
  readonly guidance = new Guidance();
  private readonly steps = el('ol', {class: 'steps', 'aria-label': 'Steps of the calibration'},
    ...STEPS.map(([, title]) => el('li', {}, title)));
  private readonly title = el('h3');
  private readonly text = el('p');
  private readonly error = el('p', {class: 'error', role: 'alert'});
  private readonly progress = el('progress', {max: 1, 'aria-label': 'Progress of this step'});
  private readonly seen = el('p', {class: 'note'},
    'Tags seen by each camera, and the error of its calibration:');
  private readonly grids = el('div', {class: 'grids'});
  private readonly verdict = el('p');
  private readonly quality = el('ul', {class: 'quality', 'aria-label': 'Quality'});
  private readonly buttons: Record<WizardAction, HTMLButtonElement>;
  private step: WizardStep = 'idle';
  private error_said = '';
  private refusal = '';
  private refusal_timer = 0;
  /** Aspect ratio of each camera's picture, width over height. */
  private shapes = new Map<string, number>();

  constructor(private readonly act: (action: WizardAction) => void) {
    this.section = new Section('wizard', 'Calibration', false);
    const button = (action: WizardAction, label: string, kind: string): HTMLButtonElement =>
      el('button', {type: 'button', class: kind, onclick: () => this.act(action)}, label);
    this.buttons = {
      start: button('start', 'Start', 'primary'), next: button('next', 'Next', 'primary'),
      accept: button('accept', 'Accept', 'primary'), cancel: button('cancel', 'Cancel', ''),
    };
    this.section.body.append(this.steps, el('div', {'aria-live': 'polite'}, this.title,
      this.text), this.error, this.progress,
    el('div', {class: 'row'}, ...Object.values(this.buttons)), this.verdict, this.quality,
    this.seen, this.grids);
  }

  load(wizard: WizardWords | null, cameras: readonly CameraWords[], live: boolean): void {
    this.shapes = new Map(cameras.map(({name, width_px, height_px}) =>
      [name, width_px / height_px]));
    this.section.hidden = !live && wizard === null;
    this.show(wizard ?? {type: 'wizard', step: 'idle', title: 'Not calibrated here', text:
      'Measures the places of the tags on the body: stand still, then move every joint.',
      progress: 0, cameras: [], quality: [], error: ''});
  }

  show(wizard: WizardWords): void {
    const {step} = wizard;
    if (this.step !== step) this.refuse('');
    const begins = this.step !== step && (step === 'stand' || step === 'done' ||
      this.step === 'idle');
    this.step = step;
    this.guidance.show(wizard);
    const now = STEPS.findIndex(([name]) => name === step);
    [...this.steps.children].forEach((item, i) => {
      item.className = i < now || step === 'done' ? 'past' : i === now ? 'now' : '';
      if (i === now) item.setAttribute('aria-current', 'step');
      else item.removeAttribute('aria-current');
    });
    this.section.tell(now >= 0 ? STEPS[now][1].toLowerCase() : step === 'failed' ? 'failed' : '');
    setText(this.title, wizard.title);
    setText(this.text, wizard.text);
    this.error_said = wizard.error;
    this.showError();
    const busy = step === 'stand' || step === 'move' || step === 'solve';
    this.progress.hidden = !busy;
    setProgress(this.progress, wizard);
    this.showGrids(wizard.cameras);
    this.showQuality(wizard.quality);
    this.showButtons(wizard, busy);
    // After all content is set, because the page scrolls to it.
    if (begins) this.section.reveal();
  }

  /** Shows why a request failed; removed after a while. */
  refuse(why: string): void {
    window.clearTimeout(this.refusal_timer);
    this.refusal = why && `${why[0].toUpperCase()}${why.slice(1)}.`;
    this.showError();
    if (why) this.refusal_timer = window.setTimeout(() => this.refuse(''), REFUSAL_MS);
  }

  private showError(): void {
    const text = this.refusal || this.error_said;
    setText(this.error, text);
    this.error.hidden = text === '';
  }

  /** Poor results should be measured again rather than accepted. */
  private showButtons({step, quality}: WizardWords, busy: boolean): void {
    const {start, next, accept, cancel} = this.buttons;
    const poor = step === 'done' && quality.some(({good}) => !good);
    start.hidden = busy || (step === 'done' && !poor);
    setText(start, step === 'failed' || quality.length > 0 ? 'Start again' : 'Start');
    next.hidden = step !== 'stand' && step !== 'move';
    accept.hidden = step !== 'done';
    accept.className = poor ? '' : 'primary';
    setText(accept, poor ? 'Accept anyway' : 'Accept');
    cancel.hidden = !busy && step !== 'done';
  }

  private showGrids(cameras: WizardWords['cameras']): void {
    this.seen.hidden = cameras.length === 0;
    keepRows(this.grids, cameras, () => el('figure', {},
      el('canvas', {width: COLUMNS, height: ROWS, role: 'img'}), el('figcaption')),
    (row, {name, coverage, grid, rms_px}) => {
      const [canvas, caption] = row.children as unknown as [HTMLCanvasElement, HTMLElement];
      const share = `${Math.round(100 * coverage)} %`;
      setText(caption, `${name}: ${share}${rms_px === null ? '' : `, ${rms_px.toFixed(2)} px`}`);
      canvas.style.aspectRatio = String(this.shapes.get(name) ?? COLUMNS / ROWS);
      canvas.setAttribute('aria-label', `Tags were seen in ${share} of ${name}’s picture`);
      paintGrid(canvas, grid);
    });
  }

  private showQuality(quality: WizardWords['quality']): void {
    const poor = quality.filter(({good}) => !good).length;
    this.verdict.hidden = quality.length === 0;
    this.verdict.className = poor ? 'verdict poor' : 'verdict good';
    setText(this.verdict, poor ? `${poor} of ${quality.length} are poor.` : 'All results are good.');
    keepRows(this.quality, quality, () => el('li', {}, el('span'), el('b')),
      (row, {name, value, good}) => {
        row.className = good ? 'good' : 'poor';
        setText(row.children[0] as HTMLElement, name);
        setText(row.children[1] as HTMLElement, `${value} ${good ? '✓' : '✗'}`);
        row.title = good ? 'good' : 'not good enough';
      });
  }
}

/** One pixel per cell; the style enlarges it without smoothing. */
function paintGrid(canvas: HTMLCanvasElement, grid: readonly number[]): void {
  const context = canvas.getContext('2d')!;
  const style = getComputedStyle(canvas);
  context.clearRect(0, 0, COLUMNS, ROWS);
  context.fillStyle = style.color;
  for (let i = 0; i < COLUMNS * ROWS; ++i) {
    const share = Math.min(Math.max(grid[i] ?? 0, 0), 1);
    if (share === 0) continue;
    context.globalAlpha = 0.25 + 0.75 * share;
    context.fillRect(i % COLUMNS, Math.floor(i / COLUMNS), 1, 1);
  }
  context.globalAlpha = 1;
}
