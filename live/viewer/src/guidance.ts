// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// What to do now, over the stage in letters that are read from where one stands while one is
// measured. The panel says the same, to those who listen as well.

import {el, setText} from './elements';
import type {WizardWords} from './protocol';

/** Without an end that is known, a bar that only moves. */
export function setProgress(bar: HTMLProgressElement, {step, progress}: WizardWords): void {
  if (step === 'solve' && progress === 0) bar.removeAttribute('value');
  else bar.value = Math.min(Math.max(progress, 0), 1);
}

export class Guidance {
  private readonly title = el('strong');
  private readonly text = el('p');
  private readonly progress = el('progress', {max: 1});
  readonly element = el('div', {class: 'guidance', 'aria-hidden': 'true', hidden: true},
    this.title, this.text, this.progress);

  show(wizard: WizardWords): void {
    const {step, title, text, error} = wizard;
    this.element.hidden = step === 'idle';
    this.element.className = `guidance guidance-${step}`;
    setText(this.title, title);
    setText(this.text, step === 'failed' && error ? error : text);
    this.progress.hidden = step === 'done' || step === 'failed';
    setProgress(this.progress, wizard);
  }
}
