// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The page of marey edit: passes messages between marey, the document, the scene, the timeline
// and the tools.

import {el} from '../base/elements';
import {Theme} from '../base/theme';
import {giveFocusBack, Help, listenToKeys} from '../panels/help';
import {Panels} from '../panels/panels';
import {viewKeys} from '../panels/view_keys';
import {ViewPanel} from '../panels/view_panel';
import type {Connection, Listener} from '../protocol/connection';
import {EDIT_TYPES} from '../protocol/edit_protocol';
import type {
  EditErrorWords, EditWords, OpStep, OutputWords, PreviewParts, PreviewWords, ProgressWords,
  RenderedParts, RenderedWords, RevisionWords,
} from '../protocol/edit_protocol';
import type {SceneWords, ServerWords, SkeletonWords} from '../protocol/protocol';
import {AvatarView} from '../scene/avatar_view';
import {drawingOfBrowser} from '../scene/renderer';
import {Stage} from '../scene/stage';
import type {StageListener} from '../scene/stage';
import {Timeline} from '../timeline/timeline';
import {Transport} from '../timeline/transport';
import {EditBar} from './edit_bar';
import {EditDocument} from './edit_document';
import type {Change, DocumentListener} from './edit_document';
import {EditReel} from './edit_reel';
import type {MotionPart} from './edit_reel';
import {editTimeline} from './edit_rows';
import {untilAfter} from './edit_view';
import type {EditView} from './edit_view';
import {ResultPanel} from './result_panel';

/** Frames before and after the shown one that a preview contains. */
const PREVIEW_FRAMES = 60;

/** A change that is shown and not made. */
interface Preview {change: Change; until: number | null | undefined}

export class EditPage implements Listener, StageListener, DocumentListener, EditView {
  readonly reel = new EditReel();
  readonly document: EditDocument;
  readonly stage: Stage;
  until: number | null = null;
  output: OutputWords | null = null;
  outputIndex = 0;
  /** Number of pictures drawn since the page was opened. */
  drawnCount = 0;
  private readonly theme = new Theme();
  private readonly timeline: Timeline;
  private readonly transport: Transport;
  private readonly bar: EditBar;
  private readonly help = new Help();
  private readonly panels: Panels;
  private readonly result: ResultPanel;
  private scene: SceneWords | null = null;
  private skeletons: readonly SkeletonWords[] = [];
  /** What `output` is from. */
  private parts: RenderedParts | null = null;
  private shownPreview: Preview | null = null;
  /** A gesture is in progress, so that the motion under it stays. */
  private isHeld = false;
  private loading = new AbortController();
  private stale = true;
  private last_ms = 0;

  constructor(connection: Connection) {
    const byId = (id: string): HTMLElement => document.getElementById(id)!;
    const drawing = drawingOfBrowser();
    if (drawing === 'lines') throw new Error('WebGL 2 is missing');
    this.document = new EditDocument((words) => connection.send(words), this);
    this.stage = new Stage(this.theme, this, {drawing, label:
      'Three-dimensional scene. Drag to rotate, press space to play, question mark for all keys.',
    load_skin: (words, signal) => AvatarView.load(words, signal, drawing === 'software')});
    byId('stage').append(this.stage.element);
    this.timeline = new Timeline(this.theme, (frame) => {
      this.reel.playback.playing = false;
      this.seek(frame);
    });
    this.transport = new Transport(this.reel.playback, this.timeline, () => this.renew());
    this.transport.setMode(false);
    byId('time').append(this.transport.element, el('div', {class: 'scroll'},
      this.timeline.element));
    this.panels = new Panels(byId('panels'), () => {});
    this.result = new ResultPanel({choose: (output) => this.choose(output),
      exportResults: () => this.document.exportResults()});
    const view = new ViewPanel(this.stage, this.theme, () => this.renew());
    this.panels.add(this.result.section, view.section);
    this.bar = new EditBar(byId('bar'), this.stage.element, this.theme, {
      undo: () => void this.document.undo(), redo: () => void this.document.redo(),
      showResult: () => this.lookAt(null),
    }, [this.help.button, this.panels.button]);
    this.listenToKeys();
    giveFocusBack();
  }

  // --- From marey ---

  words(words: ServerWords): void {
    if (words.type === 'scene') this.setScene(words);
    else if (words.type === 'error' || EDIT_TYPES.includes(words.type)) {
      this.document.hear(words as EditWords | EditErrorWords);
    }
  }

  binary(_buffer: ArrayBuffer): void {
    // Frames of the edit are in blocks.
  }

  state(state: 'open' | 'lost'): void {
    this.bar.setConnected(state === 'open');
    if (state === 'lost') this.document.lose();
  }

  trouble(text: string): void {
    this.bar.notify(text);
    this.result.tell(text);
  }

  onRevision(revision: RevisionWords): void {
    this.bar.setRevision(revision);
    this.result.setRevision(revision);
    this.bar.setBehind(this.document.isBehind);
    if (this.until !== null) this.lookAt(Math.min(this.until, revision.ops.length));
  }

  onProgress(progress: ProgressWords): void {
    this.bar.setProgress(progress);
  }

  onRendered(rendered: RenderedWords): void {
    this.bar.setBehind(this.document.isBehind);
    if (this.until === null && !this.isHeld) void this.take(rendered);
  }

  onPreview(preview: PreviewWords): void {
    if (this.shownPreview) void this.takePreview(preview);
    else if (this.until !== null) void this.take(preview);
  }

  onRefused(text: string): void {
    this.trouble(text);
  }

  private setScene(scene: SceneWords): void {
    this.scene = scene;
    this.transport.setMode(false);
  }

  /** Sets the bodies that frames belong to. */
  private useSkeletons(skeletons: readonly SkeletonWords[]): void {
    if (skeletons === this.skeletons) return;
    this.skeletons = skeletons;
    this.reel.setSkeletons(skeletons);
    this.stage.setScene({skeletons: [...skeletons], cameras: [], points: null,
      floor: this.scene?.floor ?? {height_m: 0}, constraints: []});
  }

  private skeletonsOf(parts: RenderedParts): readonly SkeletonWords[] | null {
    const own = (parts as PreviewWords).skeletons;
    if (own) return own;
    return this.scene && (parts as RenderedWords).type === 'rendered' &&
      parts.scene !== this.scene.revision ? null : this.scene?.skeletons ?? null;
  }

  /** Shows a motion with its figures. */
  private async take(parts: RenderedParts): Promise<void> {
    const skeletons = this.skeletonsOf(parts);
    if (!skeletons) return; // Of a scene that is replaced; the next result follows.
    this.outputIndex = Math.min(this.outputIndex, parts.outputs.length - 1);
    const output = parts.outputs[this.outputIndex];
    if (!output) return;
    this.useSkeletons(skeletons);
    const frames = await this.fetch(output);
    if (!frames) return;
    this.parts = parts;
    this.output = output;
    this.shownPreview = null;
    this.reel.setWhole(frames, output);
    this.timeline.load(editTimeline(output, null));
    this.transport.setMode(false);
    this.result.setRendered(parts, this.outputIndex);
    this.bar.setLook(this.until);
    this.renew();
  }

  private async takePreview(parts: PreviewWords): Promise<void> {
    const skeletons = this.skeletonsOf(parts);
    const output = parts.outputs[Math.min(this.outputIndex, parts.outputs.length - 1)];
    if (!skeletons || !output) return;
    this.useSkeletons(skeletons);
    const frames = await this.fetch(output);
    if (!frames || !this.shownPreview) return;
    this.reel.setPreview(frames);
    this.renew();
  }

  /** Returns the frames of an output; null if newer ones are awaited. */
  private async fetch(output: OutputWords): Promise<MotionPart | null> {
    this.loading.abort();
    this.loading = new AbortController();
    const {signal} = this.loading;
    try {
      const frames = await this.reel.fetch(output, signal);
      return signal.aborted ? null : frames;
    } catch (problem) {
      // An old block is removed when a newer result is ready.
      if (!signal.aborted && !this.document.isBehind) {
        this.trouble(`The motion cannot be shown: ${String(problem)}`);
      }
      return null;
    }
  }

  // --- For tools ---

  get time(): number {
    return this.reel.playback.time;
  }

  preview(change: Change, until?: number | null): void {
    this.isHeld = true;
    this.reel.playback.pause();
    this.shownPreview = {change, until};
    this.document.preview(change, (steps) => this.previewParts(steps, until));
  }

  async commit(change: Change): Promise<boolean> {
    let after = this.until;
    const done = this.document.change((ops) => {
      const steps = change(ops);
      if (steps && this.until !== null) after = untilAfter(steps, this.until);
      return steps;
    });
    this.document.dropPreview();
    this.isHeld = false;
    this.shownPreview = null;
    // The revision's message comes before its answer, and shows the motion until here.
    const isDone = await done;
    if (!isDone) this.cancel();
    else if (after !== this.until) this.lookAt(after);
    return isDone;
  }

  cancel(): void {
    this.isHeld = false;
    this.shownPreview = null;
    this.document.dropPreview();
    this.reel.setPreview(null);
    const {rendered} = this.document;
    const base = this.until === null && rendered ? rendered : this.parts;
    if (base && (base !== this.parts || this.skeletonsOf(base) !== this.skeletons)) {
      void this.take(base);
    }
    this.renew();
  }

  private previewParts(steps: readonly OpStep[], until?: number | null): PreviewParts {
    const {frame} = this.reel.playback;
    const end = until !== undefined ? until
      : this.until === null ? null : untilAfter(steps, this.until);
    return {until: end, output: this.outputIndex,
      span: [Math.max(frame - PREVIEW_FRAMES, 0), frame + PREVIEW_FRAMES]};
  }

  /** Shows the motion after this number of operations; null: the result. */
  lookAt(until: number | null): void {
    this.until = until;
    this.shownPreview = null;
    this.bar.setLook(until);
    const {rendered} = this.document;
    if (until !== null) this.document.show({until});
    else if (rendered) void this.take(rendered);
  }

  private choose(output: number): void {
    this.outputIndex = output;
    if (this.parts) void this.take(this.parts);
  }

  // --- From the stage ---

  beforePicture(now_ms: number): void {
    const seconds = Math.min((now_ms - this.last_ms) / 1000, 0.25);
    this.last_ms = now_ms;
    const {playback} = this.reel;
    const before = playback.time;
    playback.advance(seconds, false);
    if (playback.time !== before) this.stale = true;
    if (playback.playing) this.stage.refresh();
    if (!this.stale) return;
    this.stale = false;
    if (this.reel.compose()) this.stage.show(this.reel.shown);
    if (this.shownPreview && !this.reel.hasPreviewedFrame) {
      this.preview(this.shownPreview.change, this.shownPreview.until);
    }
    this.timeline.place(playback.first, playback.last, playback.time, playback.frame);
    this.transport.show();
  }

  afterPicture(): void {
    ++this.drawnCount;
  }

  /** Called when the shown instant has changed. */
  private renew(): void {
    this.stale = true;
    this.stage.refresh();
  }

  private seek(frame: number): void {
    this.reel.playback.seek(frame);
    this.renew();
  }

  private listenToKeys(): void {
    const {transport, stage, panels, help, reel: {playback}} = this;
    listenToKeys(viewKeys({playback, transport, stage, panels, help,
      seek: (frame) => this.seek(frame)}));
    document.addEventListener('keydown', (event) => {
      const isText = (event.target as HTMLElement).closest('input:not([type=checkbox]), textarea');
      if (!(event.ctrlKey || event.metaKey) || event.altKey || isText) return;
      const key = event.key.toLowerCase();
      if (key !== 'z' && key !== 'y') return;
      event.preventDefault();
      if (key === 'y' || event.shiftKey) void this.document.redo();
      else void this.document.undo();
    });
  }
}
