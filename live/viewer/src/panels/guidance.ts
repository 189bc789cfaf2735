// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The current instruction over the stage, in letters that the subject can read from a
// distance. The panel repeats it for screen readers.

import {el, setText} from '../base/elements';
import type {WizardWords} from '../protocol/protocol';

/** Shows an indeterminate bar if the end is unknown. */
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
