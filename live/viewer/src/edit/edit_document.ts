// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The page's copy of the edited document. marey owns it: this class sends requests, one change
// after the other, and keeps the newest revision and its result. Knows no elements of the page.

import type {
  EditErrorWords, EditPageWords, EditWords, ExportedWords, JumpOptions, JumpWords, LoopsOptions,
  LoopsWords, OpKeys, OpStep, OpWords, PreviewParts, PreviewWords, ProgressWords, RenderedWords,
  RevisionWords,
} from '../protocol/edit_protocol';

/** Steps that are computed when they are sent, from the operations at that time. null: the
 *  change has become meaningless. */
export type Change = (ops: readonly OpWords[]) => OpStep[] | null;

export interface DocumentListener {
  /** The recipe has changed. */
  onRevision(revision: RevisionWords): void;
  onProgress(progress: ProgressWords): void;
  /** A new result. */
  onRendered(rendered: RenderedWords): void;
  /** The answer to preview(), or to show() if not `isChanged`. */
  onPreview(preview: PreviewWords, isChanged: boolean): void;
  /** A request was refused. */
  onRefused(text: string): void;
}

type Answer = EditWords | EditErrorWords;
type Send = (words: EditPageWords) => boolean;
/** Which part a preview renders, from the steps of its change. */
export type ChooseParts = (steps: readonly OpStep[]) => PreviewParts;
/** `isChange`: of preview(), not of show(). */
type Wish = {patch: Change; parts: ChooseParts; isChange: boolean};

const NOT_CONNECTED: EditErrorWords = {type: 'error', text:
  'marey does not answer. The change was not made: is the program still running?'};

const LOST: EditErrorWords = {type: 'error', text:
  'The connection was lost before marey answered. Check in the list of operations whether the ' +
  'last change was made.'};

export class EditDocument {
  revision: RevisionWords | null = null;
  progress: ProgressWords | null = null;
  rendered: RenderedWords | null = null;
  private readonly waiting = new Map<string, (answer: Answer) => void>();
  private readonly newRevision: (() => void)[] = [];
  private count = 0;
  /** Number of lost connections. */
  private lost = 0;
  private changes: Promise<unknown> = Promise.resolve();
  /** The next preview; older ones that were not sent are replaced. */
  private wish: Wish | null = null;
  private isPreviewing = false;

  constructor(private readonly send: Send, private readonly listener: DocumentListener) {}

  get ops(): readonly OpWords[] {
    return this.revision?.ops ?? [];
  }

  /** True if the shown result belongs to an older revision. */
  get isBehind(): boolean {
    return this.revision !== null && this.rendered?.revision !== this.revision.revision;
  }

  /** Handles a message of marey. */
  hear(words: Answer): void {
    if (words.type === 'revision') this.hearRevision(words);
    else if (words.type === 'progress') {
      this.progress = words;
      this.listener.onProgress(words);
    } else if (words.type === 'rendered') {
      this.rendered = words;
      this.listener.onRendered(words);
    } else this.hearAnswer(words);
  }

  /** The connection is lost: open requests have no answer. */
  lose(): void {
    const open = [...this.waiting.values()];
    this.waiting.clear();
    for (const answer of open) answer(LOST);
    // The next connection begins with the newest revision, whatever its number is.
    this.lost += 1;
    for (const arrived of this.newRevision.splice(0)) arrived();
  }

  /** Changes the recipe, after the changes that were requested before. Returns whether it was
   *  done; if not, the listener received the reason. */
  change(change: Change): Promise<boolean> {
    return this.inTurn(() => {
      const ops_patch = change(this.ops);
      if (!ops_patch || ops_patch.length === 0) return Promise.resolve(false);
      return this.request({type: 'edit', ops_patch, ...this.base()});
    });
  }

  undo(): Promise<boolean> {
    return this.inTurn(() => this.revision?.undo_possible
      ? this.request({type: 'undo', ...this.base()}) : Promise.resolve(false));
  }

  redo(): Promise<boolean> {
    return this.inTurn(() => this.revision?.redo_possible
      ? this.request({type: 'redo', ...this.base()}) : Promise.resolve(false));
  }

  /** Renders a change without making it, as in a drag. While an answer is awaited, only the
   *  newest request is kept. */
  preview(patch: Change, parts: ChooseParts = () => ({})): void {
    this.want({patch, parts, isChange: true});
  }

  /** Renders the unchanged recipe, such as the motion as operation `until` receives it. */
  show(parts: PreviewParts): void {
    this.want({patch: () => [], parts: () => parts, isChange: false});
  }

  /** Forgets a preview() that was not sent. */
  dropPreview(): void {
    if (this.wish?.isChange) this.wish = null;
  }

  /** Searches for loops. null: refused; the listener received the reason. */
  async loops(options: LoopsOptions): Promise<LoopsWords | null> {
    const answer = await this.ask({type: 'loops', ...this.base(), ...options});
    return answer.type === 'loops' ? answer : null;
  }

  /** Returns the curves of a jump, or why there are none. The listener receives no reason,
   *  because the page asks by itself. */
  async jump(options: JumpOptions): Promise<JumpWords | string> {
    await this.changes;
    const answer = await this.ask({type: 'jump', ...this.base(), ...options}, true);
    if (answer.type === 'jump') return answer;
    return answer.type === 'error' ? answer.text : 'The recipe has changed meanwhile.';
  }

  /** Writes the results into the folder of the command line. null: refused. */
  async exportResults(): Promise<ExportedWords | null> {
    await this.changes;
    const answer = await this.ask({type: 'export', ...this.base()});
    return answer.type === 'exported' ? answer : null;
  }

  // --- Requests ---

  private base(): {base_revision: number; id: string} {
    this.count += 1;
    return {base_revision: this.revision?.revision ?? 0, id: String(this.count)};
  }

  private inTurn(act: () => Promise<boolean>): Promise<boolean> {
    const mine = this.changes.then(act);
    this.changes = mine.catch(() => false);
    return mine;
  }

  /** Sends a change. Ends when its revision has arrived. */
  private async request(words: EditPageWords & {id: string}): Promise<boolean> {
    const answer = await this.ask(words);
    if (answer.type !== 'accepted') return false;
    const {lost} = this;
    while ((this.revision?.revision ?? 0) < answer.revision && lost === this.lost) {
      await new Promise<void>((arrived) => { this.newRevision.push(arrived); });
    }
    return true;
  }

  /** `isQuiet`: the listener does not receive why the request was refused. */
  private async ask(words: EditPageWords & {id: string}, isQuiet = false): Promise<Answer> {
    const answer = await new Promise<Answer>((resolve) => {
      this.waiting.set(words.id, resolve);
      if (this.send(words)) return;
      this.waiting.delete(words.id);
      resolve(NOT_CONNECTED);
    });
    if (isQuiet) return answer;
    if (answer.type === 'error') this.listener.onRefused(answer.text);
    else if (answer.type === 'stale') {
      this.listener.onRefused('Another page or program changed the recipe at the same time; ' +
        'this change was not made. Repeat it.');
    }
    return answer;
  }

  private want(wish: Wish): void {
    this.wish = wish;
    if (!this.isPreviewing) void this.sendWish();
  }

  private async sendWish(): Promise<void> {
    this.isPreviewing = true;
    while (this.wish) {
      await this.changes;
      if (!this.wish) break;
      const {patch, parts, isChange} = this.wish;
      this.wish = null;
      const ops_patch = patch(this.ops);
      if (!ops_patch) continue;
      const answer = await this.ask(ops_patch.length > 0
        ? {type: 'preview', ops_patch, ...this.base(), ...parts(ops_patch)}
        : {type: 'render', ...this.base(), ...parts([])});
      if (answer.type === 'preview') this.listener.onPreview(answer, isChange);
    }
    this.isPreviewing = false;
  }

  // --- Messages ---

  private hearRevision(revision: RevisionWords): void {
    this.revision = revision;
    this.listener.onRevision(revision);
    for (const arrived of this.newRevision.splice(0)) arrived();
  }

  private hearAnswer(answer: Exclude<Answer, RevisionWords | ProgressWords | RenderedWords>):
    void {
    const waiting = answer.id ? this.waiting.get(answer.id) : undefined;
    if (waiting && answer.id) {
      this.waiting.delete(answer.id);
      waiting(answer);
    } else if (answer.type === 'error') {
      this.listener.onRefused(answer.text);
    }
  }
}

/** Returns the operation without its version: "cut" for "cut@1". */
export function opName({do: name}: Pick<OpKeys, 'do'>): string {
  const end = name.indexOf('@');
  return end < 0 ? name : name.slice(0, end);
}
