// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The menu at the end of a brushed span: operations that are added over it.

import {button, chooser, el} from '../base/elements';
import {fixed} from '../base/words';
import {clearContact, setContact} from './contact_patches';
import type {Change} from '../edit/edit_document';
import type {EditView} from '../edit/edit_view';
import {addCurve, addOverSpan, keepSpan, removeSpan, trim} from './patches';

const GAP_PX = 6;

export interface BrushedSpan {
  from_s: number; to_s: number;
  /** The row of contacts that it was brushed in. */
  contact: number | null;
}

export class SpanMenu {
  private readonly element = el('div', {class: 'span-menu', role: 'dialog',
    'aria-label': 'Brushed span', hidden: true});
  private before: Element | null = null;

  /** `closed`: called when the menu has closed, after a choice or without one. */
  constructor(private readonly view: EditView, private readonly tell: (text: string) => void,
    private readonly closed: () => void) {
    // Keys of the page do nothing while the menu has the focus.
    this.element.addEventListener('keydown', (event) => {
      event.stopPropagation();
      if (event.key === 'Escape') this.close();
    });
  }

  get isOpen(): boolean {
    return !this.element.hidden;
  }

  /** Opens above `top_px`, or below `bottom_px` if there is no room. [px in the window] */
  open(span: BrushedSpan, x_px: number, top_px: number, bottom_px: number): void {
    this.before = document.activeElement;
    this.element.replaceChildren(...this.rows(span));
    this.element.hidden = false;
    document.body.append(this.element);
    document.addEventListener('pointerdown', this.outside, true);
    const {offsetWidth: width, offsetHeight: height} = this.element;
    const left = Math.min(Math.max(x_px - width / 2, GAP_PX), window.innerWidth - width - GAP_PX);
    const above = top_px - height - GAP_PX;
    const top = above >= GAP_PX ? above
      : Math.max(Math.min(bottom_px + GAP_PX, window.innerHeight - height - GAP_PX), GAP_PX);
    this.element.style.left = `${left.toFixed(0)}px`;
    this.element.style.top = `${top.toFixed(0)}px`;
    this.element.querySelector('button')?.focus({preventScroll: true});
  }

  close(): void {
    if (!this.isOpen) return;
    this.element.hidden = true;
    this.element.remove();
    document.removeEventListener('pointerdown', this.outside, true);
    if (this.before instanceof HTMLElement) this.before.focus({preventScroll: true});
    this.closed();
  }

  private readonly outside = (event: Event): void => {
    if (!this.element.contains(event.target as Node)) this.close();
  };

  private rows(span: BrushedSpan): HTMLElement[] {
    const {from_s, to_s, contact} = span;
    const row = (...children: (HTMLElement | null)[]): HTMLElement =>
      el('div', {class: 'row'}, ...children);
    const contacts = this.contactRow(span);
    return [
      el('h2', {}, `${fixed(from_s, 3)} to ${fixed(to_s, 3)} s (${fixed(to_s - from_s, 3)} s)`),
      ...(contacts && contact !== null ? [contacts] : []),
      row(this.item('Cut to it', 'Removes the rest', () => trim(this.view, from_s, to_s)),
        this.item('Keep it', 'Keeps the span as a motion of its own',
          () => keepSpan(this.view, from_s, to_s)),
        // Only a span at an end can be removed.
        removeSpan(this.view, from_s, to_s) && this.item('Remove it', 'Keeps the rest',
          () => removeSpan(this.view, from_s, to_s))),
      row(this.item('Filter', 'Removes noise', () => this.over(span, 'filter@1')),
        this.item('Exaggerate', 'Amplifies the movement', () => this.over(span, 'exaggerate@1')),
        this.item('Offset…', 'Displaces a bone by a constant angle',
          () => this.over(span, 'offset@1', {bone: 'spine', rotation_deg: [0, 0, 0]}),
          'The offset is 0: set its bone and its angle in the list of operations.')),
      this.textRow(span),
      ...(contacts && contact === null ? [contacts] : [])];
  }

  private over({from_s, to_s}: BrushedSpan, name: string,
    keys: Parameters<typeof addOverSpan>[2] = {}): Change {
    return addOverSpan(this.view, name, keys, from_s, to_s);
  }

  private textRow(span: BrushedSpan): HTMLElement {
    const text = el('input', {type: 'text', maxlength: 200, placeholder: 'text or name',
      'aria-label': 'Text of the tag, or name of the curve'});
    const named = (make: (name: string) => Change) => (): Change | null => {
      const name = text.value.trim();
      if (name) return make(name);
      this.tell('State the text of the tag, or the name of the curve.');
      return null;
    };
    const tag = named((name) => this.over(span, 'tag@1', {text: name}));
    text.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') this.choose(tag);
    });
    return el('div', {class: 'row'}, text,
      this.item('Tag', 'Adds an annotation with this text', tag),
      this.item('Curve', 'Adds a curve of this name that rises from 0 to 1',
        named((name) => addCurve(this.view, name, span.from_s, span.to_s))));
  }

  private contactRow({from_s, to_s, contact}: BrushedSpan): HTMLElement | null {
    const contacts = this.view.output?.contacts ?? [];
    if (contacts.length === 0) return null;
    const rows = chooser(contacts.map(({name}, i) => [i, name]), contact ?? 0, () => {},
      {'aria-label': 'Part of the foot'});
    const change = (make: typeof setContact) => (): Change => {
      const {foot, part} = contacts[Number(rows.value)];
      return make(this.view, foot, part, from_s, to_s);
    };
    return el('div', {class: 'row'}, rows,
      this.item('Set contact', 'The part bears in this span', change(setContact)),
      this.item('Clear', 'The part does not bear in this span', change(clearContact)));
  }

  private item(text: string, title: string, make: () => Change | null, after = ''):
    HTMLButtonElement {
    return button({title, onclick: () => this.choose(make, after)}, text);
  }

  private choose(make: () => Change | null, after = ''): void {
    const change = make();
    if (!change) return;
    this.close();
    void this.view.commit(change).then((done) => {
      if (done && after) this.tell(after);
    });
  }
}
