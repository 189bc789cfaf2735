// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The list of operations on an empty page, with a view that applies patches by itself.

import type {Change} from '../src/edit/edit_document';
import type {EditView} from '../src/edit/edit_view';
import {OpsPanel} from '../src/edit/ops_panel';
import type {OpKeys, OpStep, OpWords, OutputWords, RevisionWords} from
  '../src/protocol/edit_protocol';

function applied(ops: readonly OpKeys[], steps: readonly OpStep[]): OpKeys[] {
  const list = [...ops];
  for (const step of steps) {
    if ('insert' in step) list.splice(step.insert, 0, step.op);
    else if ('replace' in step) list[step.replace] = step.op;
    else if ('remove' in step) list.splice(step.remove, 1);
    else if ('move' in step) list.splice(step.to, 0, ...list.splice(step.move, 1));
    else {
      const {off: _, ...keys} = list[step.toggle];
      list[step.toggle] = (step.off ? {...keys, off: true} : keys) as OpKeys;
    }
  }
  return list;
}

class TestPage {
  /** Calls of the view since the last look: name and steps. */
  calls: [string, OpStep[] | number | null][] = [];
  readonly panel: OpsPanel;
  private ops: OpKeys[] = [];
  private revision = 0;
  private readonly document = {revision: null as RevisionWords | null};

  constructor() {
    const output = {name: 'walk', frames: 361, rate_hz: 120, contacts: [], annotations: []};
    const compute = (change: Change): OpStep[] | null => change(this.words());
    const view = {document: this.document, until: null, outputIndex: 0, time: 90,
      output: output as unknown as OutputWords,
      preview: (change: Change) => { this.calls.push(['preview', compute(change)]); },
      commit: (change: Change) => {
        const steps = compute(change);
        this.calls.push(['commit', steps]);
        if (steps) this.patch(steps);
        return Promise.resolve(steps !== null);
      },
      cancel: () => { this.calls.push(['cancel', null]); }};
    this.panel = new OpsPanel(view as unknown as EditView, {selected: () => {}, lookAt: (until) => {
      this.calls.push(['look', until]);
      this.panel.setLook(until);
    }});
    document.body.append(this.panel.section.element);
  }

  /** A change by this page, or by another one. */
  patch(steps: OpStep[]): void {
    this.load(applied(this.ops, steps));
  }

  load(ops: OpKeys[]): void {
    this.ops = ops;
    this.revision += 1;
    this.document.revision = {type: 'revision', revision: this.revision,
      parent: this.revision - 1, cause: 'edit', sources: [], avatars: [], ops: this.words()} as
      unknown as RevisionWords;
    this.panel.setRevision(this.document.revision);
  }

  private words(): OpWords[] {
    return this.ops.map((keys) => ({do: keys.do, off: keys.off === true, keys,
      text: JSON.stringify(keys)}));
  }
}

(window as unknown as {testPage: TestPage}).testPage = new TestPage();
