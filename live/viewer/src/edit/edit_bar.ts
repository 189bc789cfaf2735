// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The bar at the top of the edit page: name, state of rendering, undo and redo.

import {button, el, setText} from '../base/elements';
import type {Theme} from '../base/theme';
import {plural} from '../base/words';
import type {ProgressWords, RevisionWords} from '../protocol/edit_protocol';

/** Actions of the bar's buttons. */
export interface BarActions {
  undo(): void;
  redo(): void;
  showResult(): void;
}

const CAUSES = {open: 'opened', edit: 'changed', undo: 'undone', redo: 'redone',
  file: 'changed by another program'};

export class EditBar {
  private readonly title = el('h1', {}, 'marey');
  private readonly pill = el('span', {class: 'pill', role: 'status', 'aria-live': 'polite'});
  private readonly figures = el('span', {class: 'figures'});
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly result: HTMLButtonElement;
  private readonly banner = el('p', {class: 'banner', role: 'alert', hidden: true});
  private readonly notice = el('p', {class: 'notice', role: 'alert', hidden: true});
  private connected = true;
  private isBehind = false;
  private progress: ProgressWords | null = null;
  private timer = 0;

  constructor(element: HTMLElement, stage: HTMLElement, theme: Theme, actions: BarActions,
    buttons: HTMLElement[]) {
    this.undo = button({class: 'undo', title: 'Undo (Ctrl Z)', disabled: true,
      onclick: () => actions.undo()}, 'Undo');
    this.redo = button({class: 'redo', title: 'Redo (Ctrl Shift Z)', disabled: true,
      onclick: () => actions.redo()}, 'Redo');
    this.result = button({class: 'primary', hidden: true, title: 'Show the motion after all ' +
      'operations', onclick: () => actions.showResult()}, 'Show the result');
    const themeButton = button({class: 'icon theme', title: 'Dark or light colours',
      'aria-label': 'Dark or light colours',
      onclick: () => theme.choose(theme.dark ? 'light' : 'dark')}, '◐');
    element.append(this.title, this.pill, this.figures, el('span', {class: 'spring'}),
      this.result, this.undo, this.redo, themeButton, ...buttons);
    stage.append(this.banner, this.notice);
    this.tell();
  }

  setRevision(revision: RevisionWords): void {
    setText(this.title, revision.name);
    document.title = `${revision.name} – marey edit`;
    setText(this.figures, `${plural(revision.ops.length, 'operation')} · revision ` +
      `${revision.revision}, ${CAUSES[revision.cause]}`);
    this.figures.title = revision.recipe_file;
    this.undo.disabled = !revision.undo_possible;
    this.redo.disabled = !revision.redo_possible;
  }

  setProgress(progress: ProgressWords): void {
    this.progress = progress;
    this.tell();
  }

  /** `isBehind`: the shown result belongs to an older revision. */
  setBehind(isBehind: boolean): void {
    this.isBehind = isBehind;
    this.tell();
  }

  /** `until`: number of operations that are applied to the shown motion; null: all. */
  setLook(until: number | null): void {
    this.result.hidden = until === null;
  }

  setConnected(connected: boolean): void {
    this.connected = connected;
    this.banner.hidden = connected;
    setText(this.banner, connected ? '' : 'The connection to marey is lost. Check that it is ' +
      'still running. Nothing is lost: the recipe is on the disk.');
    this.tell();
  }

  /** Shows a text over the scene for some seconds. */
  notify(text: string): void {
    setText(this.notice, text);
    this.notice.hidden = false;
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => { this.notice.hidden = true; }, 9000);
  }

  private tell(): void {
    const {progress} = this;
    const failed = progress?.state === 'failed';
    const [state, words] = !this.connected ? ['offline', 'not connected']
      : failed ? ['stopped', 'an operation failed']
        : this.isBehind ? ['behind', progress && progress.total > 0
          ? `rendering ${progress.done} of ${progress.total}` : 'rendering']
          : ['tracked', 'up to date'];
    setText(this.pill, words);
    this.pill.title = failed ? progress.error : '';
    this.pill.className = `pill pill-${state}`;
  }
}
