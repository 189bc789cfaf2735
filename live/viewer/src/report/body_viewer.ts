// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The viewer of a trial: the moving bodies, their time, and controls.

import {button, checkbox, chooser, el} from '../base/elements';
import {listenToKeys} from '../panels/help';
import type {Colouring} from '../scene/skeleton_view';
import {SCALE_END_M} from '../scene/skeleton_view';
import {Stage} from '../scene/stage';
import {listedCurve} from '../timeline/timeline_rows';
import {Transport} from '../timeline/transport';
import {sourceStrip} from '../timeline/timeline_paint';
import {scaleKey, sourceLegend} from './common';
import type {ReportCamera, TrialData, TrialFigures} from './data';
import type {Player} from './player';
import {RecordedBody, standAbreast} from './recorded_body';
import {cameraWords, reportDrawing} from './report_cameras';
import {gapRows} from './trial_sections';

const FOLLOW_BEYOND_M = 1.5; // A subject that travels farther is followed.
const KEYS = [
  ['space', 'play, pause'], ['← →', 'one frame'], ['shift ← →', 'one second'],
  ['↑ ↓ + −', 'zoom'], ['home', 'first frame'], ['drag', 'turn'],
  ['shift drag', 'move'], ['two fingers', 'zoom, move'], ['double click', 'first view'],
];
const COLOURINGS: [Colouring, string][] = [['source', 'source'], ['uncertainty', 'uncertainty'],
  ['plain', 'none']];

export class BodyViewer {
  readonly root = el('div', {class: 'viewer'});
  readonly stage: Stage;
  private bodies: RecordedBody[] = [];
  private readonly legend = el('div', {class: 'stage-legend'});
  private readonly time = el('div');
  private readonly follow: HTMLLabelElement;

  constructor(private readonly player: Player, private readonly cameras: readonly ReportCamera[]) {
    this.stage = new Stage(player.theme, {
      beforePicture: () => this.showInstant(),
      afterPicture: () => {},
      reset: () => this.frame(),
      trouble: () => {},
    }, {drawing: reportDrawing(), scrolled: true, solid: true,
      label: 'Three-dimensional view of the motion. Press space to play, arrow keys to step.'});
    Object.assign(this.stage.shown, {uncertainty: false, cameras: false});
    this.stage.renderer.canvas.setAttribute('role', 'img');
    this.stage.element.append(this.legend);
    this.follow = this.toggle('follow', 'Follow');
    this.root.append(this.stage.element, this.time, el('div', {class: 'controls'},
      el('label', {}, 'Colour by ', chooser(COLOURINGS, 'source', (value) =>
        this.colourBy(value as Colouring))),
      this.toggle('cameras', 'Cameras'), this.follow,
      button({onclick: () => this.frame()}, 'Reset view')),
    el('details', {class: 'keys'}, el('summary', {}, 'Keys and gestures'),
      el('p', {}, ...KEYS.flatMap(([key, what]) => [el('kbd', {}, key), ` ${what}  `]),
        'The wheel zooms after a click into the picture.')));
    this.listenToKeys();
  }

  /** Shows another trial. */
  load(trial: TrialData, figures: TrialFigures): void {
    const {player, stage} = this;
    this.bodies = trial.bodies.map((body, i) => new RecordedBody(body, i === 0));
    standAbreast(this.bodies);
    const frames = Math.max(0, ...this.bodies.map((body) => body.frames));
    player.load(frames, figures.rate_hz, figures.first_frame);
    player.onTime = () => stage.refresh();
    stage.setScene({skeletons: this.bodies.map(({words}) => words), points: null, floor: null,
      cameras: this.cameras.map(cameraWords), constraints: []}, this.bodies);
    stage.shown.follow = frames > 0 && this.travels();
    this.follow.querySelector('input')!.checked = stage.shown.follow;
    const rows = gapRows(figures);
    const timeline = player.timeline([sourceStrip(rows)], [{name: 'reprojection', unit: 'px',
      curves: [listedCurve(trial.frame_rms_px.map((value) => value || null))]}], rows, true);
    const transport = new Transport(player.playback, timeline, () => player.changed());
    transport.setMode(false);
    transport.setLoop(true);
    player.onTime = () => {
      transport.show();
      stage.refresh();
    };
    this.time.replaceChildren(el('div', {class: 'time'}, transport.element, timeline.element));
    this.colourBy('source');
    this.showInstant();
    this.frame();
    player.changed();
  }

  private showInstant(): void {
    const {time} = this.player.playback;
    for (const body of this.bodies) body.show(time);
    this.stage.show({frame: 0, time_s: 0, sent_s: 0, skeletons: this.bodies.map(({frame}) => frame)});
  }

  private toggle(option: 'cameras' | 'follow', label: string): HTMLLabelElement {
    return checkbox(label, this.stage.shown[option], (on) => {
      this.stage.shown[option] = on;
      this.frame();
    }, {class: 'toggle'});
  }

  private colourBy(colouring: Colouring): void {
    this.stage.shown.colouring = colouring;
    this.legend.replaceChildren(...(colouring === 'plain' ? [] : [colouring === 'source'
      ? sourceLegend(false) : scaleKey('sigma', `${1000 * SCALE_END_M} mm`)]));
    this.stage.refresh();
  }

  private travels(): boolean {
    const [xs, zs]: number[][] = [[], []];
    this.bodies[0].sample(60, (frame) => {
      const [x, , z] = this.bodies[0].recorded(frame, 0);
      xs.push(x);
      zs.push(z);
    });
    const range = (values: number[]): number => Math.max(...values) - Math.min(...values);
    return Math.max(range(xs), range(zs)) > FOLLOW_BEYOND_M;
  }

  /** Moves the eye so that the whole motion is in the picture. */
  private frame(): void {
    const {stage, bodies} = this;
    if (bodies.length === 0 || bodies[0].frames === 0) return;
    const {follow, cameras} = stage.shown;
    const [x, , z] = follow ? bodies[0].p_in_world : [0, 0, 0];
    const places = bodies.flatMap((body) => body.places(follow))
      .map((v, i) => v + [x, 0, z][i % 3]);
    if (cameras) places.push(...this.cameras.flatMap((camera) => camera.centre_in_world_m));
    const azimuth = bodies[0].meanHeading() + 0.55;
    this.showInstant();
    stage.frame(places, azimuth, 0.2, true);
  }

  private listenToKeys(): void {
    const {player, stage: {orbit}} = this;
    const step = (way: number) => (event: KeyboardEvent): void => {
      player.playback.step(way * (event.shiftKey ? Math.round(player.playback.rate_hz) : 1));
      player.changed();
    };
    const [nearer, farther] = [0.9, 1 / 0.9].map((factor) => () => orbit.zoom(factor));
    listenToKeys({
      ' ': () => player.play(!player.playback.playing), ArrowLeft: step(-1), ArrowRight: step(1),
      Home: () => player.seek(0), End: () => player.seek(player.playback.last),
      ArrowUp: nearer, ArrowDown: farther, '+': nearer, '-': farther,
    }, this.root);
  }
}
