// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The panel for jumps on an empty page, with a document that answers with a made jump.

import {Theme} from '../src/base/theme';
import type {Change} from '../src/edit/edit_document';
import type {EditView} from '../src/edit/edit_view';
import {JumpPanel} from '../src/edit_scene/jump_panel';
import type {JumpOptions, JumpWords, OpKeys, OpStep, OpWords} from
  '../src/protocol/edit_protocol';
import {madeJump} from './made_jump';

function applied(ops: readonly OpKeys[], steps: readonly OpStep[]): OpKeys[] {
  const list = [...ops];
  for (const step of steps) {
    if ('insert' in step) list.splice(step.insert, 0, step.op);
    else if ('replace' in step) list[step.replace] = step.op;
  }
  return list;
}

class TestPage {
  /** Calls of the view and its document since the last look. */
  calls: [string, unknown][] = [];
  /** The answer to each question; null: the made jump. */
  answer: string | null = null;
  readonly panel: JumpPanel;
  readonly view: {document: unknown; until: number | null; time: number};
  private ops: OpKeys[] = [];

  constructor() {
    const compute = (change: Change): OpStep[] | null => change(this.words());
    const page = this;
    this.view = {document: {
      get ops() { return page.words(); },
      revision: {revision: 1, sources: [], avatars: []},
      jump: async (options: JumpOptions): Promise<JumpWords | string> => {
        this.calls.push(['jump', options]);
        await new Promise((done) => setTimeout(done, 5));
        const ops = applied(this.ops, options.ops_patch ?? []);
        return this.answer ?? madeJump('1', options.op, ops[options.op]);
      }}, until: null, time: 108, ...{outputIndex: 0,
      output: {name: 'jump', frames: 400, rate_hz: 120, contacts: [], annotations: []},
      preview: (change: Change) => { this.calls.push(['preview', compute(change)]); },
      commit: (change: Change) => {
        const steps = compute(change);
        this.calls.push(['commit', steps]);
        if (steps) this.load(applied(this.ops, steps));
        return Promise.resolve(steps !== null);
      },
      cancel: () => { this.calls.push(['cancel', null]); }}};
    this.panel = new JumpPanel(this.view as unknown as EditView, new Theme(), {
      seek: (frame) => { this.calls.push(['seek', frame]); },
      select: (index) => {
        this.calls.push(['select', index]);
        this.panel.select(index);
      }});
    this.panel.section.element.open = true;
    document.getElementById('panels')!.append(this.panel.section.element);
  }

  load(ops: OpKeys[]): void {
    this.ops = ops;
    this.panel.update();
  }

  private words(): OpWords[] {
    return this.ops.map((keys) => ({do: keys.do, off: keys.off === true, keys,
      text: JSON.stringify(keys)}));
  }
}

(window as unknown as {testPage: TestPage}).testPage = new TestPage();
