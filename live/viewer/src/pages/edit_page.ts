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
  EditErrorWords, EditWords, OutputWords, PreviewWords, ProgressWords, RenderedParts,
  RenderedWords, RevisionWords,
} from '../protocol/edit_protocol';
import type {DragPhase, SceneWords, ServerWords, Vector} from '../protocol/protocol';
import {AvatarView} from '../scene/avatar_view';
import {drawingOfBrowser} from '../scene/renderer';
import {Stage} from '../scene/stage';
import type {StageListener} from '../scene/stage';
import {Timeline} from '../timeline/timeline';
import {Transport} from '../timeline/transport';
import {bodiesOf, sameBodies} from '../edit/edit_bodies';
import type {Bodies} from '../edit/edit_bodies';
import {EditBar} from '../edit/edit_bar';
import {EditDocument} from '../edit/edit_document';
import type {Change, DocumentListener} from '../edit/edit_document';
import {EDIT_KEYS, listenToUndo} from '../edit/edit_keys';
import {EditReel} from '../edit/edit_reel';
import {editTimeline} from '../edit/edit_rows';
import {sceneSections} from '../edit/edit_sections';
import {previewParts, untilAfter} from '../edit/edit_view';
import type {EditView} from '../edit/edit_view';
import {OpsPanel} from '../edit/ops_panel';
import {ResultPanel} from '../edit/result_panel';
import {Ghost} from '../edit_scene/ghost';
import {JumpPanel} from '../edit_scene/jump_panel';
import {LoopsPanel} from '../edit_scene/loops_panel';
import {PathTool} from '../edit_scene/path_tool';
import {PoseHandles} from '../edit_scene/pose_handles';
import {TimelineTools} from '../edit_time/timeline_tools';

/** Index of the source in a scene. */
const SOURCE = 0;

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
  private readonly help = new Help(EDIT_KEYS);
  private readonly panels: Panels;
  private readonly ops: OpsPanel;
  private readonly result: ResultPanel;
  private readonly tools: TimelineTools;
  private readonly handles: PoseHandles;
  private readonly path: PathTool;
  private readonly ghost: Ghost;
  private readonly jump: JumpPanel;
  private readonly sceneTools: readonly {update(): void; setTime(time: number): void}[];
  private scene: SceneWords | null = null;
  private skeletons: Bodies = [];
  /** The message that contains `output`. */
  private parts: RenderedParts | null = null;
  private shownPreview: Preview | null = null;
  /** A gesture is in progress, so that the motion under it stays. */
  private isHeld = false;
  /** The result could not be computed yet, so that the motion before the failed operation is
   *  shown. */
  private isFallback = false;
  /** Called when the motion that lookAt() requested is shown. */
  private whenShown: (() => void) | null = null;
  private stale = true;
  private last_ms = 0;

  constructor(connection: Connection) {
    const byId = (id: string): HTMLElement => document.getElementById(id)!;
    const drawing = drawingOfBrowser();
    if (drawing === 'lines') throw new Error('WebGL 2 is missing');
    this.document = new EditDocument((words) => connection.send(words), this);
    this.stage = new Stage(this.theme, this, {drawing, ghost: SOURCE, label:
      'Three-dimensional scene. Drag to rotate, press space to play, question mark for all keys.',
    load_skin: (words, signal) => AvatarView.load(words, signal, drawing === 'software')});
    byId('stage').append(this.stage.element);
    const seek = (frame: number): void => this.stopAt(frame);
    this.ops = new OpsPanel(this, {lookAt: (until) => this.lookAt(until),
      selected: () => this.onSelected()});
    this.tools = new TimelineTools(this, this.ops, (text) => this.bar.notify(text));
    this.timeline = new Timeline(this.theme, seek, {tools: this.tools});
    this.transport = new Transport(this.reel.playback, this.timeline, () => this.renew());
    this.transport.setMode(false);
    this.transport.element.append(this.tools.brushButton);
    byId('time').append(this.transport.element, el('div', {class: 'scroll'},
      this.timeline.element));
    this.handles = new PoseHandles(this, this.stage, seek);
    this.path = new PathTool(this, this.stage, this.theme, (on) => this.handles.setHidden(on));
    this.ghost = new Ghost(this.stage, () => this.renew());
    const loops = new LoopsPanel(this, this.theme, {
      seek: (frame, until) => this.whenAt(until, () => this.stopAt(frame)),
      playCycle: (first, last, until) => this.whenAt(until, () => this.playCycle(first, last))});
    this.jump = new JumpPanel(this, this.theme, {seek, select: (op) => this.ops.select(op)});
    this.sceneTools = [this.handles, this.path, loops, this.jump];
    this.result = new ResultPanel({choose: (output) => this.choose(output),
      exportResults: () => this.document.exportResults()});
    this.panels = new Panels(byId('panels'), () => {});
    this.panels.add(this.ops.section, this.result.section, ...sceneSections(
      {handles: this.handles, path: this.path, loops, jump: this.jump,
        ghost: this.ghost},
      new ViewPanel(this.stage, this.theme, () => this.renew())));
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

  /** Frames of the edit are in blocks. */
  binary(_buffer: ArrayBuffer): void {}

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
    this.ops.setRevision(revision);
    this.bar.setBehind(this.document.isBehind);
    this.updateTools();
    const {isFallback} = this;
    if (this.until !== null) this.lookAt(Math.min(this.until, revision.ops.length));
    this.isFallback = isFallback;
  }

  onProgress(progress: ProgressWords): void {
    this.bar.setProgress(progress);
    this.ops.setProgress(progress);
    if (progress.state !== 'failed') return;
    if (!this.shownPreview && this.reel.dropPreview()) this.renew();
    if (!this.isFallback && (this.output || this.until !== null)) return;
    this.lookAt(progress.op ?? 0);
    this.isFallback = true;
  }

  onRendered(rendered: RenderedWords): void {
    this.bar.setBehind(this.document.isBehind);
    if (this.isFallback && !this.isHeld) this.lookAt(null);
    else if (this.until === null && !this.isHeld) void this.take(rendered);
  }

  onPreview(preview: PreviewWords, isChanged: boolean): void {
    if (isChanged) {
      if (this.shownPreview) void this.takePreview(preview);
    } else if (this.until !== null && !this.isHeld) void this.take(preview);
  }

  onRefused(text: string): void {
    this.trouble(text);
  }

  private setScene(scene: SceneWords): void {
    this.scene = scene;
    this.transport.setMode(false);
  }

  /** Sets the bodies that frames belong to. */
  private useSkeletons(skeletons: Bodies): void {
    if (sameBodies(skeletons, this.skeletons)) return;
    this.skeletons = skeletons;
    this.reel.setSkeletons(skeletons);
    this.stage.setScene({skeletons: [...skeletons], cameras: [], points: null,
      floor: this.scene?.floor ?? {height_m: 0}, constraints: []});
    this.handles.setSkeletons(skeletons);
  }

  /** Shows a motion with its figures. */
  private async take(parts: RenderedParts): Promise<void> {
    const skeletons = bodiesOf(parts, this.scene);
    if (!skeletons) return; // Its scene is replaced; the next result follows.
    this.outputIndex = Math.min(this.outputIndex, parts.outputs.length - 1);
    const output = parts.outputs[this.outputIndex];
    if (!output) return;
    const frames = await this.reel.fetch(output, skeletons, this.fetchFailed);
    // During a gesture, the motion that it began on stays.
    if (!frames || this.isHeld || parts.until !== this.until) return;
    this.useSkeletons(skeletons);
    this.parts = parts;
    this.output = output;
    this.shownPreview = null;
    this.reel.setWhole(frames, output);
    this.timeline.load(editTimeline(output, this.ops.selected));
    this.transport.setMode(false);
    this.ops.setRendered(parts);
    if (this.until === null) this.result.setRendered(parts, this.outputIndex);
    this.path.setMotion(frames.block, skeletons, output.rate_hz);
    this.updateTools();
    this.renew();
    const then = this.whenShown;
    this.whenShown = null;
    then?.();
  }

  private async takePreview(parts: PreviewWords): Promise<void> {
    const skeletons = bodiesOf(parts, this.scene);
    const output = parts.outputs[Math.min(this.outputIndex, parts.outputs.length - 1)];
    if (!skeletons || !output) return;
    const frames = await this.reel.fetch(output, skeletons, this.fetchFailed);
    if (!frames || !this.shownPreview) return;
    this.useSkeletons(skeletons);
    this.reel.setPreview(frames);
    this.ops.setRendered(parts);
    if (frames.block.frames === output.frames) {
      this.path.setMotion(frames.block, skeletons, output.rate_hz);
      if (output.frames === this.output?.frames) {
        this.timeline.load(editTimeline(output, this.ops.selected));
      }
    }
    this.renew();
  }

  private readonly fetchFailed = (problem: string): void => {
    // An old block is removed when a newer result is ready.
    if (!this.document.isBehind) this.trouble(`The motion cannot be shown: ${problem}`);
  };

  // --- For tools ---

  get time(): number {
    return this.reel.playback.time;
  }

  preview(change: Change, until?: number | null): void {
    this.isHeld = true;
    this.reel.playback.pause();
    this.shownPreview = {change, until};
    this.document.preview(change, (steps) => previewParts(steps, this, until));
  }

  async commit(change: Change): Promise<boolean> {
    let after: number | null = null;
    const done = this.document.change((ops) => {
      const steps = change(ops);
      if (steps && this.until !== null && !this.isFallback) after = untilAfter(steps, this.until);
      return steps;
    });
    this.document.dropPreview();
    this.isHeld = false;
    this.shownPreview = null;
    // The revision's message comes before its answer, and shows the motion until here.
    const isDone = await done;
    if (!isDone) this.cancel();
    else if (after !== null && after !== this.until) this.lookAt(after);
    return isDone;
  }

  cancel(): void {
    this.isHeld = false;
    this.shownPreview = null;
    this.document.dropPreview();
    this.reel.setPreview(null);
    const {rendered, revision} = this.document;
    const {parts, until} = this;
    const base = until === null && rendered ? rendered : parts;
    if (until !== null && (parts?.until !== until || parts.revision !== revision?.revision)) {
      this.document.show({until});
    } else if (base && (base !== parts ||
      !sameBodies(bodiesOf(base, this.scene) ?? [], this.skeletons))) void this.take(base);
    this.renew();
  }

  /** Shows the motion after this number of operations; null: the result. */
  lookAt(until: number | null): void {
    this.until = until;
    this.isFallback = false;
    this.shownPreview = null;
    this.whenShown = null;
    this.bar.setLook(until);
    this.ops.setLook(until);
    const {rendered} = this.document;
    if (until !== null) this.document.show({until});
    else if (rendered) void this.take(rendered);
  }

  /** Calls `then` when the motion after `until` operations is shown. */
  private whenAt(until: number | null, then: () => void): void {
    if (until === this.until) {
      then();
      return;
    }
    this.lookAt(until);
    this.whenShown = then;
  }

  private updateTools(): void {
    for (const tool of this.sceneTools) tool.update();
    this.timeline.repaint();
  }

  private onSelected(): void {
    this.path.select(this.ops.selected);
    this.jump.select(this.ops.selected);
    if (this.output) this.timeline.load(editTimeline(this.output, this.ops.selected));
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
    if (playback.playing && !this.shownPreview && this.reel.dropPreview()) this.stale = true;
    if (playback.playing) this.stage.refresh();
    if (!this.stale) return;
    this.stale = false;
    if (this.reel.compose()) this.stage.show(this.reel.shown);
    if (this.shownPreview && !this.reel.hasPreviewedFrame) {
      this.preview(this.shownPreview.change, this.shownPreview.until);
    }
    this.timeline.place(playback.first, playback.last, playback.time, playback.frame);
    this.transport.show();
    for (const tool of this.sceneTools) tool.setTime(playback.time);
  }

  afterPicture(): void {
    ++this.drawnCount;
  }

  private renew(): void {
    this.stale = true;
    this.stage.refresh();
  }

  drag(id: string, p_in_world: Vector, phase: DragPhase): void {
    this.handles.drag(id, p_in_world, phase);
  }

  dropDrag(): void {
    this.handles.giveUp();
  }

  private seek(frame: number): void {
    this.reel.playback.seek(frame);
    this.renew();
  }

  private stopAt(frame: number): void {
    this.reel.playback.pause();
    this.seek(frame);
  }

  private playCycle(first: number, last: number): void {
    this.reel.playback.playCycle(first, last);
    this.renew();
  }

  private listenToKeys(): void {
    const {transport, stage, panels, help, reel: {playback}} = this;
    listenToKeys({...viewKeys({playback, transport, stage, panels, help,
      seek: (frame) => this.seek(frame)}), ...this.tools.keys, g: () => this.ghost.toggle()});
    listenToUndo(() => void this.document.undo(), () => void this.document.redo());
  }
}
