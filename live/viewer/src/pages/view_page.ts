// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The page of marey live and marey view: passes data from marey to the stage, the timeline and
// the panels, and user input back.

import {CamerasPanel} from '../panels/cameras_panel';
import type {Connection, Listener} from '../protocol/connection';
import {ConstraintsPanel} from '../panels/constraints_panel';
import {FRAME_KIND} from '../protocol/decode_frame';
import {decodeThumbnail, THUMBNAIL_KIND} from '../protocol/decode_thumbnail';
import {el} from '../base/elements';
import {Header} from '../panels/header';
import {giveFocusBack, Help, listenToKeys} from '../panels/help';
import {Panels} from '../panels/panels';
import type {DragPhase, SceneWords, ServerWords, Vector} from '../protocol/protocol';
import type {RunWords} from '../protocol/run_protocol';
import {Reel} from '../timeline/reel';
import {AvatarView} from '../scene/avatar_view';
import {drawingOfBrowser} from '../scene/renderer';
import {Stage} from '../scene/stage';
import type {StageListener} from '../scene/stage';
import {StatusPanel} from '../panels/status_panel';
import {Theme} from '../base/theme';
import {Timeline} from '../timeline/timeline';
import {timelineOf} from '../timeline/timeline_paint';
import {RunPanel} from '../panels/run_panel';
import {Transport} from '../timeline/transport';
import {Trials} from '../panels/trials';
import {viewKeys} from '../panels/view_keys';
import {ViewPanel} from '../panels/view_panel';
import {WizardPanel} from '../panels/wizard_panel';

const SHOWN_EVERY_MS = 500;
const REPAINT_EVERY_MS = 250;
/** marey sends its status twice a second; after this time without one it counts as silent. */
const SILENCE_MS = 3000;
const DRAG_EVERY_MS = 15;
/** Minimum interval of updates of the timeline's text when live: each costs a layout. */
const PLACED_EVERY_MS = 100;

export class ViewPage implements Listener, StageListener {
  readonly reel = new Reel();
  readonly stage: Stage;
  /** Number of pictures drawn since the page was opened. */
  drawnCount = 0;
  /** Called after every picture of a new frame; for measurements. */
  onDrawn: ((sent_s: number) => void) | null = null;
  connected = false;
  private readonly theme = new Theme();
  private readonly timeline: Timeline;
  private readonly transport: Transport;
  private readonly header: Header;
  private readonly help = new Help();
  private readonly panels: Panels;
  private readonly cameras = new CamerasPanel((on) => this.send({type: 'thumbnails', on}));
  private readonly wizard = new WizardPanel((action) => this.send({type: 'wizard', action}));
  private readonly constraints = new ConstraintsPanel((id, active) =>
    this.send({type: 'constraint', id, active}));
  private readonly run = new RunPanel((action) => this.send({type: 'run', action}));
  private readonly status = new StatusPanel();
  private readonly trials = new Trials((name) => this.send({type: 'trial', name}));
  private scene: SceneWords | null = null;
  private sceneText = '';
  private loading = new AbortController();
  private stale = true;
  private last_ms = 0;
  private told_ms = 0;
  private dragged_ms = 0;
  private placed_ms = 0;
  private wasFollowing = false;
  private echoed_s = -1;
  private due = 0;
  private drawn = 0;

  constructor(private readonly connection: Connection) {
    const byId = (id: string): HTMLElement => document.getElementById(id)!;
    const drawing = drawingOfBrowser();
    if (drawing === 'lines') throw new Error('WebGL 2 is missing');
    this.stage = new Stage(this.theme, this, {drawing, label:
      'Three-dimensional scene. Drag to rotate, press space to play, question mark for all keys.',
    load_skin: (words, signal) => AvatarView.load(words, signal, drawing === 'software')});
    byId('stage').append(this.stage.element, this.wizard.guidance.element);
    this.panels = new Panels(byId('panels'), () => this.cameras.ask());
    const view = new ViewPanel(this.stage, this.theme, () => this.renew());
    this.panels.add(this.trials.section, this.run.section, view.section, this.cameras.section,
      this.wizard.section, this.constraints.section, this.status.section);
    this.timeline = new Timeline(this.theme, (frame) => {
      this.reel.playback.playing = false;
      this.reel.playback.seek(frame);
      this.renew();
    });
    this.transport = new Transport(this.reel.playback, this.timeline, () => this.renew());
    byId('time').append(this.transport.element, el('div', {class: 'scroll'},
      this.timeline.element));
    this.header = new Header(byId('bar'), this.stage.element, this.theme,
      [this.help.button, this.panels.button], (on) => this.send({type: 'record', on}));
    this.listenToKeys();
    giveFocusBack();
    window.setInterval(() => this.second(), 1000);
    window.setInterval(() => {
      this.repaintLive();
      this.header.tell();
    }, REPAINT_EVERY_MS);
  }

  // --- From marey ---

  words(words: ServerWords): void {
    if (words.type === 'scene') void this.setScene(words);
    else if (words.type === 'status') {
      this.header.setStatus(words);
      this.status.show(words);
      this.cameras.status(words.cameras);
    } else if (words.type === 'wizard') this.wizard.show(words);
    else if (words.type === 'constraints') this.setConstraints(words.constraints);
    else if (words.type === 'run') this.showRun(words);
    else if (words.type === 'targets') this.stage.setTargets(words.p_in_world, words.held);
    else if (words.type !== 'error') return;
    else if (words.about === 'wizard') this.wizard.refuse(words.text);
    else this.trouble(words.text);
  }

  binary(buffer: ArrayBuffer): void {
    const view = new DataView(buffer);
    const kind = buffer.byteLength > 0 ? view.getUint8(0) : 0;
    if (kind === FRAME_KIND && this.scene) {
      if (!this.reel.push(view)) return;
      ++this.due;
      if (this.live && !this.reel.playback.following) this.placeTimeline();
      else this.renew();
    } else if (kind === THUMBNAIL_KIND) {
      const thumbnail = decodeThumbnail(buffer);
      if (thumbnail) this.cameras.show(thumbnail);
    }
  }

  state(state: 'open' | 'lost'): void {
    this.connected = state === 'open';
    this.header.setConnected(this.connected);
    if (this.connected) this.cameras.repeat();
  }

  trouble(text: string): void {
    this.status.tell(text);
    this.status.section.reveal();
  }

  private async setScene(scene: SceneWords): Promise<void> {
    // The requested trial was asked for; its scene follows.
    if (this.trials.asksInsteadOf(scene.file)) return;
    // A reconnected server repeats its messages.
    const text = JSON.stringify({...scene, revision: 0, wizard: null, constraints: []});
    const same = text === this.sceneText;
    this.scene = scene;
    // A scene of marey stage has no cameras, no performer and no status.
    const tracks = scene.mode === 'live' && !scene.run;
    const loadWizard = (): void =>
      this.wizard.load(scene.wizard, scene.cameras, tracks);
    if (same) {
      this.setConstraints(scene.constraints);
      loadWizard();
      return;
    }
    this.sceneText = text;
    this.loading.abort();
    this.loading = new AbortController();
    const {signal} = this.loading;
    this.reel.setScene(scene);
    this.stage.setScene(scene);
    this.constraints.show(scene.constraints);
    this.header.setScene(scene);
    this.cameras.load(scene.cameras, tracks);
    this.status.load(tracks);
    this.run.load(scene.run === true);
    loadWizard(); // Last, because the page scrolls to it when it begins.
    this.timeline.load(timelineOf(scene, this.reel));
    this.transport.setMode(scene.mode === 'live');
    this.trials.show(scene.file);
    const frame = this.trials.takeFrame(scene.file, this.reel.playback.rate_hz);
    if (frame !== null) this.reel.playback.seek(frame);
    this.renew();
    try {
      await this.reel.load(scene, signal);
    } catch (problem) {
      if (!signal.aborted) this.trouble(`The recording cannot be shown: ${String(problem)}`);
    }
    if (!signal.aborted) this.renew();
  }

  private showRun(words: RunWords): void {
    this.run.show(words);
    this.header.setRun(words.state);
  }

  private setConstraints(constraints: SceneWords['constraints']): void {
    this.stage.setConstraints(constraints);
    this.constraints.show(constraints);
  }

  // --- From the stage ---

  beforePicture(now_ms: number): void {
    const seconds = Math.min((now_ms - this.last_ms) / 1000, 0.25);
    this.last_ms = now_ms;
    const {playback} = this.reel;
    const before = playback.time;
    playback.advance(seconds, this.live);
    if (playback.time !== before) this.stale = true;
    if (playback.playing && !playback.following) this.stage.refresh();
    if (!this.stale) return;
    this.stale = false;
    if (this.reel.compose()) this.stage.show(this.reel.shown);
    if (this.reel.points) this.stage.showPoints(this.reel.points, playback.frame);
    this.placeTimeline();
  }

  private placeTimeline(): void {
    const {playback} = this.reel;
    if (playback.following && playback.following === this.wasFollowing &&
      performance.now() - this.placed_ms < PLACED_EVERY_MS) return;
    this.placed_ms = performance.now();
    this.wasFollowing = playback.following;
    this.timeline.place(playback.first, playback.last, playback.time, playback.frame);
    this.transport.show();
  }

  afterPicture(): void {
    ++this.drawnCount;
    const {sent_s} = this.reel.shown;
    const fresh = this.live && this.reel.playback.following && sent_s !== this.echoed_s;
    if (!fresh) return;
    ++this.drawn;
    this.echoed_s = sent_s;
    this.onDrawn?.(sent_s);
    if (this.last_ms - this.told_ms < SHOWN_EVERY_MS) return;
    this.told_ms = this.last_ms;
    this.send({type: 'shown', sent_s});
  }

  release(id: string): void {
    this.send({type: 'constraint', id, active: false});
  }

  drag(id: string, p_in_world: Vector, phase: DragPhase): void {
    // Send at most as many moves as the server can show; the end contains the last one.
    const now_ms = performance.now();
    if (phase === 'move' && now_ms - this.dragged_ms < DRAG_EVERY_MS) return;
    this.dragged_ms = now_ms;
    if (!this.live && phase === 'begin') {
      this.reel.playback.pause();
      // Only whole frames can be adapted.
      if (this.reel.playback.time !== this.reel.playback.frame) {
        this.reel.playback.seek(this.reel.playback.frame);
      }
      this.reel.expectAdapted();
      this.renew();
    }
    this.send({type: 'drag', id, p_in_world, phase,
      ...(this.live ? {} : {frame: this.reel.playback.frame + this.firstFrame})});
  }

  private get firstFrame(): number {
    return this.scene?.file?.first_frame ?? 0;
  }

  private get live(): boolean {
    return this.scene?.mode === 'live';
  }

  private send(words: Parameters<Connection['send']>[0]): void {
    this.connection.send(words);
  }

  /** Called when the shown instant has changed. */
  private renew(): void {
    this.stale = true;
    this.stage.refresh();
  }

  private second(): void {
    const {playback} = this.reel;
    if (playback.following) this.stage.renderer.adapt(this.due, this.drawn);
    this.due = 0;
    this.drawn = 0;
    if (this.live && this.connected) this.connection.renewAfter(SILENCE_MS);
  }

  /** Repaints an advancing timeline a few times per second. */
  private repaintLive(): void {
    if (this.live && !document.hidden) this.timeline.repaint();
  }

  private listenToKeys(): void {
    const {transport, stage, panels, help, reel: {playback}} = this;
    const seek = (frame: number): void => this.seek(frame);
    listenToKeys({...viewKeys({playback, transport, stage, panels, help, seek}),
      End: () => (this.live ? this.follow() : this.seek(playback.last))});
  }

  private seek(frame: number): void {
    this.reel.playback.seek(frame);
    this.renew();
  }

  private follow(): void {
    this.reel.playback.follow();
    this.renew();
  }
}
