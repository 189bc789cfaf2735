// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Name labels in the scene: elements over the canvas.

import type {PerspectiveCamera} from 'three';
import {Vector3} from 'three';
import {el, setText} from '../base/elements';

const HALF_LETTER_PX = 4;

export class Labels {
  readonly element = el('div', {class: 'labels', 'aria-hidden': 'true'});
  private readonly spans: HTMLSpanElement[] = [];
  private readonly at = new Vector3();
  private used = 0;
  private width = 1;
  private height = 1;

  begin(width: number, height: number): void {
    this.used = 0;
    this.width = width;
    this.height = height;
  }

  /** The label is drawn above this point. */
  add(text: string, kind: string, camera: PerspectiveCamera, x: number, y: number,
    z: number): void {
    const {at} = this;
    at.set(x, y, z).project(camera);
    if (at.z > 1 || Math.abs(at.x) > 1.1 || Math.abs(at.y) > 1.1) return;
    const span = this.spans[this.used] ?? this.grow();
    ++this.used;
    setText(span, text);
    if (span.className !== kind) span.className = kind;
    if (span.hidden) span.hidden = false;
    // Kept within the stage with an estimated width, because measuring it costs a layout.
    const half = Math.min(HALF_LETTER_PX * text.length, this.width / 2);
    const left = Math.round(Math.min(Math.max((at.x + 1) / 2 * this.width, half),
      this.width - half));
    const top = Math.round((1 - at.y) / 2 * this.height);
    span.style.transform = `translate(${left}px, ${top}px) translate(-50%, -100%)`;
  }

  end(): void {
    for (let i = this.used; i < this.spans.length; ++i) {
      if (!this.spans[i].hidden) this.spans[i].hidden = true;
    }
  }

  private grow(): HTMLSpanElement {
    const span = el('span');
    this.spans.push(span);
    this.element.append(span);
    return span;
  }
}
