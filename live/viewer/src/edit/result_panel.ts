// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The result of an edit: which of several motions is shown, figures, findings, export, and the
// text of the recipe.

import {button, chooser, el, keepRows, setText} from '../base/elements';
import {fixed} from '../base/words';
import {Section} from '../panels/panels';
import {Messages} from '../panels/messages';
import type {
  EditFiguresWords, ExportedWords, FindingWords, OutputWords, RenderedParts, RevisionWords,
} from '../protocol/edit_protocol';

export interface ResultActions {
  /** Shows the motion with this index. */
  choose(output: number): void;
  exportResults(): Promise<ExportedWords | null>;
}

/** Figures with the words for them; a unit is part of the words. */
const FIGURES: [keyof EditFiguresWords, string, (value: number) => string][] = [
  ['duration_s', 'Duration', (value) => `${fixed(value, 2)} s`],
  ['slide_mm', 'Drift of standing feet', (value) => `${fixed(value, 2)} mm`],
  ['slide_cm_per_s', 'Speed of standing feet', (value) => `${fixed(value, 2)} cm/s`],
  ['displaced_mm', 'Largest displacement', (value) => `${fixed(value, 0)} mm`],
  ['acceleration_ratio', 'Peak acceleration to the source’s', (value) => fixed(value, 2)],
  ['constraint_mm', 'Largest error of a constraint', (value) => `${fixed(value, 1)} mm`],
  ['inferred_frames', 'Invented frames', (value) => fixed(value, 0)],
];

export class ResultPanel {
  readonly section = new Section('result', 'Result', true);
  private readonly outputs = el('div', {class: 'row', hidden: true});
  private readonly figures = el('dl', {class: 'facts'});
  private readonly findings = el('ul', {class: 'findings'});
  private readonly exportButton: HTMLButtonElement;
  private readonly exported = el('p', {class: 'note', role: 'status'});
  private readonly recipe = el('pre', {class: 'recipe'});
  private readonly recipeFile = el('summary', {}, 'Recipe');
  private readonly messages = el('ul', {class: 'messages', 'aria-live': 'polite',
    'aria-label': 'Messages'});
  private readonly said = new Messages();
  private names = '';

  constructor(private readonly actions: ResultActions) {
    this.exportButton = button({class: 'export primary', title: 'Write the results into the ' +
      'folder that was given with --out', onclick: () => void this.export()}, 'Export');
    this.section.body.append(this.outputs, this.figures, this.findings,
      el('div', {class: 'row'}, this.exportButton, this.exported),
      el('details', {class: 'recipe'}, this.recipeFile, this.recipe), this.messages);
  }

  setRevision({recipe_file, recipe_text}: RevisionWords): void {
    setText(this.recipeFile, recipe_file);
    setText(this.recipe, recipe_text);
    setText(this.exported, '');
  }

  /** `output`: index of the shown motion. */
  setRendered({outputs, findings}: RenderedParts, output: number): void {
    this.showNames(outputs, output);
    const figures = outputs[output]?.figures ?? null;
    keepRows(this.figures, figures ? FIGURES : [], () => el('div', {}, el('dt'), el('dd')),
      (row, [key, words, format]) => {
        setText(row.children[0] as HTMLElement, words);
        setText(row.children[1] as HTMLElement, format(figures![key]));
      });
    showFindings(this.findings, findings);
    this.section.tell(findings.some(({severity}) => severity === 'poor') ? 'above a limit' : '');
  }

  /** Adds a message of the page itself. */
  tell(message: string): void {
    this.said.add(message);
    keepRows(this.messages, this.said.shown(), () => el('li'), (row, text) => setText(row, text));
  }

  private showNames(outputs: readonly OutputWords[], output: number): void {
    this.outputs.hidden = outputs.length < 2;
    const names = JSON.stringify([outputs.map(({name}) => name), output]);
    if (names === this.names) return;
    this.names = names;
    this.outputs.replaceChildren(el('label', {}, 'Motion ', chooser(outputs.map(({name}, i) =>
      [i, name]), output, (value) => this.actions.choose(Number(value)))));
  }

  private async export(): Promise<void> {
    this.exportButton.disabled = true;
    setText(this.exported, 'Writing …');
    const answer = await this.actions.exportResults();
    this.exportButton.disabled = false;
    setText(this.exported, answer ? `Written: ${answer.files.join(', ')}` : 'Not written.');
    if (answer) showFindings(this.findings, answer.findings);
  }
}

/** Shows findings, each with its next step. */
export function showFindings(list: HTMLElement, findings: readonly FindingWords[]): void {
  keepRows(list, findings, () => el('li'), (row, {severity, text, next}) => {
    row.className = `finding finding-${severity}`;
    setText(row, next ? `${text}. Next: ${next}.` : text);
  });
}
