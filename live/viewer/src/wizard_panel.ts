// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Calibration in steps: stand, move, done.

import {el, keepRows, setText} from './elements';
import {Section} from './panels';
import type {WizardAction, WizardStep, WizardWords} from './protocol';

const STEPS: [WizardStep, string][] = [['stand', 'Stand'], ['move', 'Move'], ['solve', 'Solve'],
  ['done', 'Done']];
const COLUMNS = 8;
const ROWS = 6;

export class WizardPanel {
  readonly section: Section;
  private readonly steps = el('ol', {class: 'steps', 'aria-label': 'Steps of the calibration'},
    ...STEPS.map(([, title]) => el('li', {}, title)));
  private readonly title = el('h3');
  private readonly text = el('p');
  private readonly error = el('p', {class: 'error', role: 'alert'});
  private readonly progress = el('progress', {max: 1, 'aria-label': 'Progress of this step'});
  private readonly grids = el('div', {class: 'grids'});
  private readonly quality = el('ul', {class: 'quality', 'aria-label': 'Quality'});
  private readonly buttons: Record<WizardAction, HTMLButtonElement>;
  private step: WizardStep = 'idle';

  constructor(private readonly act: (action: WizardAction) => void) {
    this.section = new Section('wizard', 'Calibration', false);
    const button = (action: WizardAction, label: string, kind: string): HTMLButtonElement =>
      el('button', {type: 'button', class: kind, onclick: () => this.act(action)}, label);
    this.buttons = {
      start: button('start', 'Start', 'primary'), next: button('next', 'Next', 'primary'),
      accept: button('accept', 'Accept', 'primary'), cancel: button('cancel', 'Cancel', ''),
    };
    this.section.body.append(this.steps, el('div', {'aria-live': 'polite'}, this.title,
      this.text), this.error, this.progress, this.grids, this.quality,
    el('div', {class: 'row'}, ...Object.values(this.buttons)));
  }

  load(wizard: WizardWords | null, live: boolean): void {
    this.section.hidden = !live && wizard === null;
    this.show(wizard ?? {type: 'wizard', step: 'idle', title: 'Not calibrated here', text:
      'Finds where the tags sit on the body: stand still, then move every joint.', progress: 0,
    cameras: [], quality: [], error: ''});
  }

  show(wizard: WizardWords): void {
    const {step} = wizard;
    if (this.step === 'idle' && step !== 'idle') this.section.reveal();
    this.step = step;
    const now = STEPS.findIndex(([name]) => name === step);
    [...this.steps.children].forEach((item, i) => {
      item.className = i < now || step === 'done' ? 'past' : i === now ? 'now' : '';
      if (i === now) item.setAttribute('aria-current', 'step');
      else item.removeAttribute('aria-current');
    });
    this.section.tell(now >= 0 ? STEPS[now][1].toLowerCase() : step === 'failed' ? 'failed' : '');
    setText(this.title, wizard.title);
    setText(this.text, wizard.text);
    setText(this.error, wizard.error);
    this.error.hidden = wizard.error === '';
    const busy = step === 'stand' || step === 'move' || step === 'solve';
    this.progress.hidden = !busy;
    this.progress.value = Math.min(Math.max(wizard.progress, 0), 1);
    this.showGrids(wizard.cameras);
    this.showQuality(wizard.quality);
    this.buttons.start.hidden = busy || step === 'done';
    setText(this.buttons.start, step === 'failed' ? 'Start again' : 'Start');
    this.buttons.next.hidden = step !== 'stand' && step !== 'move';
    this.buttons.accept.hidden = step !== 'done';
    this.buttons.cancel.hidden = !busy && step !== 'done';
  }

  private showGrids(cameras: WizardWords['cameras']): void {
    keepRows(this.grids, cameras, () => el('figure', {},
      el('canvas', {width: COLUMNS, height: ROWS, role: 'img'}), el('figcaption')),
    (row, {name, coverage, grid, rms_px}) => {
      const [canvas, caption] = row.children as unknown as [HTMLCanvasElement, HTMLElement];
      const share = `${Math.round(100 * coverage)} %`;
      setText(caption, `${name}: ${share}${rms_px === null ? '' : `, ${rms_px.toFixed(2)} px`}`);
      canvas.setAttribute('aria-label', `Tags were seen in ${share} of ${name}’s picture`);
      paintGrid(canvas, grid);
    });
  }

  private showQuality(quality: WizardWords['quality']): void {
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
