// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The page of a motion library: passes messages between marey, the list, the scene, the
// timeline and the panels.

import {el} from '../base/elements';
import {Theme} from '../base/theme';
import {giveFocusBack, Help, listenToKeys} from '../panels/help';
import type {KeyHelp} from '../panels/help';
import {Panels} from '../panels/panels';
import {viewKeys} from '../panels/view_keys';
import type {Connection, Listener} from '../protocol/connection';
import {LIBRARY_TYPES} from '../protocol/library_protocol';
import type {
  ClipRow, ClipWords, LibraryQuestion, LibraryServerWords, LibraryWords, ListOrder,
} from '../protocol/library_protocol';
import type {SceneWords, ServerWords} from '../protocol/protocol';
import {drawingOfBrowser} from '../scene/renderer';
import {Stage} from '../scene/stage';
import type {StageListener} from '../scene/stage';
import {Reel} from '../timeline/reel';
import {Timeline} from '../timeline/timeline';
import {Transport} from '../timeline/transport';
import {ClipList} from '../library/clip_list';
import {ClipPanel} from '../library/clip_panel';
import {ClipStore} from '../library/clip_store';
import {clipTimeline} from '../library/clip_time';
import type {Stored} from '../library/corrections';
import {Drawings} from '../library/drawings';
import {FilterBar} from '../library/filter_bar';
import {LibraryBar} from '../library/library_bar';
import {Questions} from '../library/questions';

/** Holding an arrow key passes clips without loading them. */
const CHOOSE_AFTER_MS = 90;

/** Names of relations such as "hand_right above shoulder". */
const GUTTER_PX = 148;

const LIBRARY_KEYS: KeyHelp[] = [
  [['↑', '↓'], 'the clip above, below'],
  [['page up', 'page down'], 'in the list: a screen up, down'],
  [['enter'], 'in the list: play, pause'],
  [['/'], 'filter'],
];

export class LibraryPage implements Listener, StageListener {
  readonly reel = new Reel();
  readonly stage: Stage;
  readonly store: ClipStore;
  /** The shown clip. */
  clip: ClipWords | null = null;
  library: LibraryWords | null = null;
  /** Number of pictures drawn since the page was opened. */
  drawnCount = 0;
  private readonly theme = new Theme();
  private readonly questions: Questions;
  private readonly drawings: Drawings;
  private readonly list: ClipList;
  private readonly filter: FilterBar;
  private readonly panel: ClipPanel;
  private readonly bar: LibraryBar;
  private readonly timeline: Timeline;
  private readonly transport: Transport;
  private readonly help = new Help(LIBRARY_KEYS);
  private readonly panels: Panels;
  private readonly message = el('p', {class: 'stage-message', role: 'status', hidden: true});
  private readonly still = window.matchMedia('(prefers-reduced-motion: reduce)');
  /** The newest revision of the server. */
  private newest: LibraryWords | null = null;
  private mirrored = false;
  private chosen: ClipRow | null = null;
  private chooseTimer = 0;
  private loading = new AbortController();
  private stale = true;
  private last_ms = 0;

  constructor(connection: Connection) {
    const byId = (id: string): HTMLElement => document.getElementById(id)!;
    const drawing = drawingOfBrowser();
    if (drawing === 'lines') throw new Error('WebGL 2 is missing');
    document.body.classList.add('library');
    this.questions = new Questions((words) => connection.send(words));
    this.drawings = new Drawings((clips) => this.questions.ask({type: 'poses', clips}),
      () => this.list.renew());
    const order: ListOrder = {query: '', quality: null, sort: 'number', descending: false};
    this.store = new ClipStore(order, (wanted, offset, count) =>
      this.questions.ask({type: 'list', offset, count, ...wanted}), {
      rowsChanged: (isNew) => this.rowsChanged(isNew),
      orderRefused: (text) => this.filter.refuse(text, this.store.order),
      outdated: () => this.bar.setOutdated(true),
    });
    this.filter = new FilterBar(order, (wanted) => void this.store.setOrder(wanted));
    this.list = new ClipList(this.store, this.drawings, this.theme, {
      chosen: (row, isPressed) => this.choose(row, isPressed),
      entered: () => this.transport.toggle()});
    this.stage = new Stage(this.theme, this, {drawing, solid: true, label:
      'Three-dimensional scene. Drag to rotate, press space to play, question mark for all keys.'});
    byId('stage').append(this.stage.element, this.message);
    byId('stage').before(el('section', {id: 'clips', 'aria-label': 'Library'},
      this.filter.element, this.list.element));
    this.timeline = new Timeline(this.theme, (frame) => this.stopAt(frame), {gutter_px: GUTTER_PX});
    this.transport = new Transport(this.reel.playback, this.timeline, () => this.renew(),
      {keepOpen: true});
    this.transport.setMode(false);
    this.transport.setLoop(true);
    byId('time').append(this.transport.element, el('div', {class: 'scroll'},
      this.timeline.element));
    this.panel = new ClipPanel({
      jump: (frame) => this.stopAt(frame / (this.clip?.frame_step ?? 1)),
      open: (row) => this.open(row),
      setMirrored: (mirrored) => this.setMirrored(mirrored),
      storeVerdict: (form) => this.storeAnswer({type: 'verdict', ...form}),
      storeLabel: (form) => this.storeAnswer({type: 'label', ...form}),
      now_s: () => this.reel.playback.time / this.reel.playback.rate_hz});
    this.panels = new Panels(byId('panels'), () => {});
    this.panels.add(...this.panel.sections);
    this.bar = new LibraryBar(byId('bar'), this.stage.element, this.theme,
      () => this.loadNewest(), [this.help.button, this.panels.button]);
    this.listenToKeys();
    giveFocusBack();
  }

  // --- From marey ---

  words(words: ServerWords): void {
    if (words.type === 'library') this.setLibrary(words);
    else if (words.type === 'error' || LIBRARY_TYPES.includes(words.type)) {
      const known = this.questions.hear(words as LibraryServerWords);
      if (!known && words.type === 'error') this.trouble(words.text);
    }
  }

  /** Motions are in blocks. */
  binary(_buffer: ArrayBuffer): void {}

  state(state: 'open' | 'lost'): void {
    this.bar.setConnected(state === 'open');
    if (state === 'lost') this.questions.lose();
  }

  trouble(text: string): void {
    this.bar.notify(text);
  }

  private setLibrary(library: LibraryWords): void {
    const isFirst = this.newest === null;
    // A server that was started again counts from 1.
    const isSame = this.library?.revision === library.revision &&
      this.library.folder === library.folder && this.library.clips === library.clips;
    this.newest = library;
    if (isFirst) {
      this.store.order = {...this.store.order, query: library.query};
      this.filter.setQuery(library.query);
    }
    if (isSame) return;
    // Without a list there is nothing to keep.
    if (isFirst || this.store.found === 0) this.loadNewest();
    else this.bar.setOutdated(true);
  }

  /** Shows the list of the newest build. */
  private loadNewest(): void {
    const library = this.newest;
    if (!library) return;
    this.library = library;
    this.questions.revision = library.revision;
    this.bar.setLibrary(library);
    this.bar.setOutdated(false);
    this.drawings.clear();
    const isUsable = library.trouble === '' && library.clips > 0;
    this.list.tellEmpty(library.trouble || (isUsable ? '' : emptyWords(library)));
    this.filter.element.hidden = !isUsable;
    this.timeline.element.hidden = !isUsable;
    this.transport.element.hidden = !isUsable;
    if (isUsable) void this.store.setOrder(this.store.order);
    else this.clear();
  }

  private clear(): void {
    this.chosen = null;
    this.clip = null;
    this.panel.show(null);
    this.store.found = 0;
    this.list.show(true);
  }

  private rowsChanged(isNew: boolean): void {
    this.list.show(isNew);
    if (!isNew) return;
    this.filter.show(this.store, this.library?.clips ?? 0);
    this.list.tellEmpty(this.store.found > 0 ? '' : 'No clip fulfils this filter.');
    const row = this.store.row(0);
    if (!row) return;
    if (!this.chosen) this.list.choose(0, false);
    // After a build the numbers of clips are others.
    else if (this.clip && this.clip.revision !== this.questions.revision) {
      if (this.list.index < 0) this.list.choose(0, false);
      else this.list.choose(this.list.index, false);
    }
  }

  // --- The chosen clip ---

  private choose(row: ClipRow, isPressed: boolean): void {
    const isPlaying = isPressed || this.reel.playback.playing;
    const isFirst = this.chosen === null;
    this.chosen = row;
    window.clearTimeout(this.chooseTimer);
    this.chooseTimer = window.setTimeout(() => void this.load(row, isPlaying ||
      (!isFirst && !this.still.matches)), isPressed || isFirst ? 0 : CHOOSE_AFTER_MS);
  }

  /** Opens a neighbour: chosen in the list if its row is there. */
  private open(row: ClipRow): void {
    const index = this.store.indexOf(row.clip_id);
    if (index >= 0) this.list.choose(index, true);
    else this.choose(row, true);
  }

  private setMirrored(mirrored: boolean): void {
    this.mirrored = mirrored;
    if (this.chosen) void this.load(this.chosen, this.reel.playback.playing);
  }

  private async load(row: ClipRow, plays: boolean): Promise<void> {
    this.loading.abort();
    this.loading = new AbortController();
    const {signal} = this.loading;
    const reply = await this.questions.ask({type: 'clip', clip: row.clip,
      mirrored: this.mirrored});
    if (signal.aborted) return;
    if (reply.kind === 'outdated') this.bar.setOutdated(true);
    if (reply.kind === 'refused') this.trouble(reply.text);
    if (reply.kind !== 'answer' || reply.words.type !== 'clip') return;
    const clip = reply.words;
    this.clip = clip;
    this.panel.show(clip);
    this.tell(clip.scene ? '' : clip.trouble);
    const scene = namedScene(clip);
    this.reel.setScene(scene);
    this.timeline.load(clipTimeline(clip, scene.rate_hz));
    this.timeline.window.showAll();
    this.reel.playback.seek(0);
    this.stage.setScene(scene);
    try {
      await this.reel.load(scene, signal);
    } catch (problem) {
      if (!signal.aborted) this.trouble(`The motion cannot be shown: ${String(problem)}`);
    }
    if (signal.aborted) return;
    this.reel.playback.playing = plays && clip.scene !== null;
    this.renew();
    this.frameAfterPicture = true;
  }

  /** The bodies of a new clip are framed when their places are known. */
  private frameAfterPicture = false;

  private tell(text: string): void {
    this.message.textContent = text;
    this.message.hidden = text === '';
  }

  private async storeAnswer(question: LibraryQuestion): Promise<Stored> {
    const reply = await this.questions.ask(question);
    if (reply.kind === 'answer' && reply.words.type === 'stored') return {file: reply.words.file};
    if (reply.kind === 'refused') return {problem: reply.text};
    if (reply.kind === 'outdated') {
      this.bar.setOutdated(true);
      return {problem: 'The library was built again. Load the new list, then save again.'};
    }
    return {problem: 'The connection to marey is lost. Nothing was stored.'};
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
    if (this.frameAfterPicture) {
      this.frameAfterPicture = false;
      if (!this.stage.orbit.touched) this.stage.frameBodies(true);
    }
    this.timeline.place(playback.first, playback.last, playback.time, playback.frame);
    this.transport.show();
  }

  afterPicture(): void {
    ++this.drawnCount;
  }

  private renew(): void {
    this.stale = true;
    this.stage.refresh();
  }

  private stopAt(frame: number): void {
    this.reel.playback.pause();
    this.reel.playback.seek(frame);
    this.renew();
  }

  private listenToKeys(): void {
    const {transport, stage, panels, help, reel: {playback}} = this;
    listenToKeys({...viewKeys({playback, transport, stage, panels, help, seek: (frame) => {
      playback.seek(frame);
      this.renew();
    }}), ArrowDown: () => this.list.move(1), ArrowUp: () => this.list.move(-1),
    '/': () => this.filter.focus()});
  }
}

function emptyWords({failed, folder}: LibraryWords): string {
  const reason = failed > 0 ? ` The reasons of ${failed} failed sources are in ${folder}/failed.`
    : '';
  return `This library has no clips.${reason} Add files with: marey library add ${folder} FILE`;
}

/** Returns the scene of a clip; neighbours have their place in the list as names. */
function namedScene(clip: ClipWords): SceneWords {
  if (!clip.scene) return EMPTY_SCENE;
  const shown = clip.neighbours.filter(({trouble}) => trouble === '');
  const names = [clip.scene.skeletons.length > 1 ? 'chosen' : '', ...shown.map((one) =>
    `${clip.neighbours.indexOf(one) + 1} · ${one.distance.toFixed(2)}`)];
  return {...clip.scene, skeletons: clip.scene.skeletons.map((skeleton, i) =>
    ({...skeleton, name: names[i] ?? skeleton.name}))};
}

const EMPTY_SCENE: SceneWords = {type: 'scene', version: 1, revision: 0, title: '', mode: 'file',
  rate_hz: 30, skeletons: [], cameras: [], points: null, floor: {height_m: 0}, constraints: [],
  file: {frames: 1, first_frame: 0, block: null, points_block: null, tracks: [], contacts: [],
    graphs: [], notes: []}, wizard: null};
