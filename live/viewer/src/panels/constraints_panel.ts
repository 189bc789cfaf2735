// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// List of constraints, each with a switch.

import {checkbox, el, setText} from '../base/elements';
import {Section} from './panels';
import type {ConstraintWords} from '../protocol/protocol';

export class ConstraintsPanel {
  readonly section = new Section('constraints', 'Constraints', false);
  private readonly list = el('ul', {class: 'constraints'});
  private shown = '';

  constructor(private readonly activate: (id: string, active: boolean) => void) {
    this.section.body.append(this.list);
  }

  show(constraints: readonly ConstraintWords[]): void {
    this.section.hidden = constraints.length === 0;
    const active = constraints.filter((constraint) => constraint.active).length;
    this.section.tell(`${active} of ${constraints.length}`);
    // Rebuilt only if the constraints differ, so that a focused box keeps the focus.
    const shown = constraints.map(({id, kind}) => `${id}\n${kind}`).join('\n');
    if (shown !== this.shown) {
      this.shown = shown;
      this.list.replaceChildren(...constraints.map((constraint) => this.row(constraint)));
    }
    constraints.forEach((constraint, i) => {
      const row = this.list.children[i];
      row.querySelector('input')!.checked = constraint.active;
      setText(row.querySelector('.place')!, constraint.p_in_world.map((v) =>
        v.toFixed(2)).join(', '));
    });
  }

  private row({id, kind}: ConstraintWords): HTMLElement {
    return el('li', {}, checkbox(id, false, (on) => this.activate(id, on)),
      el('span', {class: 'kind'}, kind),
      el('span', {class: 'place', title: 'x, y, z in metres'}));
  }
}
