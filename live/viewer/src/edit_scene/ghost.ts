// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The switch of the ghost: the source behind the result.

import {checkbox, remember, remembered} from '../base/elements';
import type {Stage} from '../scene/stage';

const KEY = 'layer.ghost';

export class Ghost {
  readonly element: HTMLLabelElement;
  private readonly box: HTMLInputElement;

  /** `changed` shows the instant again. Precondition: the stage has a ghost. */
  constructor(private readonly stage: Stage, private readonly changed: () => void) {
    stage.shown.ghost = remembered(KEY) !== 'off';
    this.element = checkbox('Ghost', stage.shown.ghost, (on) => this.set(on), {title:
      'The same frames of the source, translucent behind the result. Key G'});
    this.box = this.element.querySelector('input')!;
  }

  toggle(): void {
    this.set(!this.stage.shown.ghost);
  }

  private set(on: boolean): void {
    this.stage.shown.ghost = on;
    this.box.checked = on;
    remember(KEY, on ? 'on' : 'off');
    this.changed();
  }
}
