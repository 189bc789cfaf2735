// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The scene: bodies, cameras, points, floor and handles.

import type {Object3D} from 'three';
import {BodyView} from './body_view';
import type {Shown, SkinLoader} from './body_view';
import {CrowdView} from './crowd_view';
import {ConstraintView} from './constraint_view';
import type {PointBlock} from '../protocol/decode_blocks';
import type {SceneFrame} from '../protocol/decode_frame';
import {el} from '../base/elements';
import {makeFloor} from './floor';
import type {Floor} from './floor';
import {HandleDrag} from './handle_drag';
import {Labels} from './labels';
import {framing, leash} from './orbit';
import type {Orbit} from './orbit';
import {PosedSkeleton} from './posed_skeleton';
import type {Pose} from './posed_skeleton';
import {PointsView} from './points_view';
import type {ConstraintWords, DragPhase, SceneWords, Vector} from '../protocol/protocol';
import {Renderer} from './renderer';
import type {RendererOptions} from './renderer';
import {RigView} from './rig_view';
import type {Theme} from '../base/theme';

const MOST_POINT_NAMES = 80;
/** More bodies than this are drawn as one mesh, without their names. */
const MOST_SINGLE_BODIES = 12;
const ROOM_HEIGHT = 0.4; // Angle of the eye above the horizon. [rad]
const NAME_ABOVE_M = 0.2; // Height of names above the highest joint, which is below the top of the head.

export interface StageListener {
  /** Called before the stage draws a picture. */
  beforePicture(now_ms: number): void;
  /** Called after a picture was drawn. */
  afterPicture(): void;
  /** Frames the whole scene again, instead of the bodies at this instant. */
  reset?(): void;
  drag?(id: string, p_in_world: Vector, phase: DragPhase): void;
  /** A handle was clicked twice; without it, a double click on it resets the view. */
  release?(id: string): void;
  /** A drag ended with Escape; without it, Escape does nothing. */
  dropDrag?(id: string): void;
  trouble(text: string): void;
}

/** An object of a page in its scene. */
export interface StagePart {
  readonly object: Object3D;
  paint(theme: Theme): void;
  /** Called before each picture. */
  update(eye: Vector): void;
}

/** Parts of a scene; the page's own part may be added to `stage.renderer.scene`. */
export type StageWords = Pick<SceneWords, 'skeletons' | 'cameras' | 'points' | 'floor' |
  'constraints'>;

export interface StageOptions extends RendererOptions {
  /** Without it, bodies have no skin. */
  load_skin?: SkinLoader;
  /** Bodies are mannequins instead of bones. */
  solid?: boolean;
  /** Length of the cameras' pyramids. */
  pyramid_m?: number;
  /** Index of the skeleton that is drawn as a ghost. The view does not follow it. */
  ghost?: number;
}

export class Stage {
  readonly element: HTMLElement;
  readonly renderer: Renderer;
  readonly orbit: Orbit;
  readonly shown: Shown = {skin: true, bones: false, uncertainty: true, balance: true,
    cameras: true, handles: true, names: true, follow: true, ghost: true,
    colouring: 'source'};
  private readonly labels = new Labels();
  private readonly floor: Floor;
  private readonly rig = new RigView();
  private readonly handles = new ConstraintView();
  private readonly still = window.matchMedia('(prefers-reduced-motion: reduce)');
  private readonly parts: StagePart[] = [];
  private bodies: BodyView[] = [];
  private crowd: CrowdView | null = null;
  private points: PointsView | null = null;
  private readonly drags: HandleDrag | null;
  private words: StageWords | null = null;
  /** Assumed place of the followed body on the floor (x, z). */
  private readonly anchor: [number, number] = [0, 0];
  private framed = false;
  private last_ms = 0;

  constructor(private readonly theme: Theme, private readonly listener: StageListener,
    private readonly options: StageOptions) {
    this.renderer = new Renderer((now_ms) => this.picture(now_ms), () => this.settle(), options);
    this.orbit = this.renderer.orbit;
    const {scene, canvas, software} = this.renderer;
    // A report is drawn rarely, so that it can afford pixels.
    this.floor = makeFloor(options.drawing === 'lines' || (software && !options.scrolled));
    scene.add(this.floor.object, this.rig.object, this.handles.object);
    this.element = el('div', {class: 'stage'}, canvas, this.labels.element);
    this.drags = listener.drag ? new HandleDrag(this.renderer, this.handles,
      (id, p_in_world, phase) => listener.drag!(id, p_in_world, phase),
      {giveUp: listener.dropDrag && ((id) => listener.dropDrag!(id)),
        release: listener.release && ((id) => listener.release!(id))}) : null;
    canvas.addEventListener('dblclick', () => {
      if (!this.drags?.hasReleased) this.reset();
    });
    theme.onChange(() => this.paint());
    this.paint();
  }

  /** `poses`: one per skeleton; without them, frames have rotations of joints. */
  setScene(words: StageWords, poses?: readonly Pose[]): void {
    for (const body of this.bodies) body.dispose();
    this.crowd?.dispose();
    const isCrowd = words.skeletons.length > MOST_SINGLE_BODIES &&
      words.skeletons.every(({skin}) => skin === null);
    if (this.points) this.points.object.removeFromParent();
    this.points?.dispose();
    this.words = words;
    this.floor.height_m = words.floor?.height_m ?? 0;
    this.bodies = words.skeletons.map((skeleton, i) => {
      const body = new BodyView(skeleton, poses?.[i] ?? new PosedSkeleton(skeleton), this.shown,
        this.floor.height_m, this.options.solid ?? false, i === this.options.ghost, isCrowd);
      if (skeleton.skin && this.options.load_skin) {
        void body.dress(this.options.load_skin, (trouble) => {
          if (trouble) this.listener.trouble(trouble);
          this.renderer.invalidate();
        });
      }
      this.renderer.scene.add(body.object);
      return body;
    });
    this.crowd = isCrowd ? new CrowdView(this.bodies.map(({pose, words: {offset_m}}) =>
      ({pose, offset_m}))) : null;
    if (this.crowd) this.renderer.scene.add(this.crowd.object);
    this.rig.set(words.cameras, this.options.pyramid_m);
    this.points = words.points ? new PointsView(words.points.labels) : null;
    if (this.points) this.renderer.scene.add(this.points.object);
    this.setConstraints(words.constraints);
    if (!this.framed) this.frameRoom();
    this.paint();
  }

  add(part: StagePart): void {
    this.parts.push(part);
    this.renderer.scene.add(part.object);
    part.paint(this.theme);
    this.renderer.invalidate();
  }

  setConstraints(constraints: readonly ConstraintWords[]): void {
    this.handles.set(constraints, this.words?.skeletons ?? [], this.drags?.inHand ?? null);
    this.takeAlong();
    this.renderer.invalidate();
  }

  /** Moves the targets of a running scene. */
  setTargets(p_in_world: readonly Vector[], held: readonly boolean[]): void {
    this.handles.setTargets(p_in_world, held, this.drags?.inHand ?? null);
    this.renderer.invalidate();
  }

  /** Shows this instant. Precondition: it belongs to the scene set last. */
  show(frame: SceneFrame): void {
    this.bodies.forEach((body, i) => {
      body.update(frame.skeletons[i]);
      this.crowd?.update(i, body.object.visible, this.floor.height_m);
    });
    this.takeAlong();
    if (!this.framed && this.first()) {
      this.frameBodies(true, this.firstAzimuth());
    }
    this.follow();
  }

  private takeAlong(): void {
    this.handles.follow(this.bodies.map((body) => body.present ? body.pose : null),
      this.drags?.inHand ?? null);
  }

  showPoints(block: PointBlock, frame: number): void {
    if (!this.points || block.points !== this.points.labels.length) return;
    this.points.update(block, frame);
    if (this.bodies.length > 0) return;
    if (!this.framed) this.frameBodies(true);
    this.follow();
  }

  /** Returns the shown pose of a skeleton of the scene; null if it has not been present. */
  poseOf(skeleton: number): Pose | null {
    const body = this.bodies[skeleton];
    return body?.present ? body.pose : null;
  }

  get floor_m(): number {
    return this.floor.height_m;
  }

  /** Redraws after a change of appearance without a new instant. */
  refresh(): void {
    this.renderer.invalidate();
  }

  /** Moves the eye so that all bodies are in the picture. */
  frameBodies(atOnce = false, azimuth = this.orbit.azimuth, height = this.orbit.height): void {
    const framed = this.bodies.filter((body) => body.present && !body.isGhost);
    const places = framed.flatMap((body) => {
      const [dx, dy, dz] = body.words.offset_m;
      const p = body.pose.p_in_world;
      const moved: number[] = [];
      for (let i = 0; i < p.length; i += 3) moved.push(p[i] + dx, p[i + 1] + dy, p[i + 2] + dz);
      if (this.shown.names) moved.push(p[0] + dx, body.top_m() + dy + NAME_ABOVE_M, p[2] + dz);
      return moved;
    });
    if (this.points) places.push(...this.points.p_in_world);
    this.frame(places, azimuth, height, atOnce);
  }

  /** Moves the eye so that all places (x y z each) are in the picture. */
  frame(places: readonly number[], azimuth: number, height: number, atOnce: boolean): void {
    const view = framing(places, azimuth, height, this.renderer.width / this.renderer.height);
    if (!view) return;
    this.framed = true;
    const place = this.place();
    if (place) [this.anchor[0], this.anchor[1]] = place;
    this.orbit.goTo(view, atOnce || this.still.matches);
    this.renderer.invalidate();
  }

  /** Looks at the cameras and the floor between them while there is no body. */
  private frameRoom(): void {
    const places = (this.words?.cameras ?? []).flatMap(({world_from_camera: {p}}) =>
      [...p, p[0], this.floor.height_m, p[2]]);
    const {width, height: tall} = this.renderer;
    const view = framing(places, this.orbit.azimuth, ROOM_HEIGHT, width / tall);
    if (view) this.orbit.goTo(view, true);
    this.renderer.invalidate();
  }

  /** Views from the front, from the bodies' left, from above. */
  viewFrom(side: 'front' | 'left' | 'above'): void {
    const aside = side === 'left' ? Math.PI / 2 : 0;
    this.frameBodies(false, this.heading() + aside, side === 'above' ? 1.5 : 0.12);
  }

  /** Avoids a view along X, the direction of the row of bodies. */
  private firstAzimuth(): number {
    const heading = this.heading();
    if (this.bodies.filter((body) => !body.isGhost).length < 2) return heading + 0.5;
    return (Math.cos(heading) >= 0 ? 0 : Math.PI) + 0.35;
  }

  private first(): BodyView | undefined {
    return this.bodies.find((body) => body.present && !body.isGhost);
  }

  /** Returns the place (x, z) to follow, which is that of the first body or the centre of all points. */
  private place(): [number, number] | null {
    const body = this.first();
    if (!body) return this.points?.middle() ?? null;
    return [body.pose.p_in_world[0], body.pose.p_in_world[2]];
  }

  private follow(): void {
    const place = this.place();
    if (!place || !this.framed || !this.shown.follow) return;
    const [dx, dz] = leash(place[0] - this.anchor[0], place[1] - this.anchor[1]);
    this.anchor[0] += dx;
    this.anchor[1] += dz;
    this.orbit.shift(dx, dz);
  }

  /** Returns the heading of the first body. */
  heading(): number {
    return this.first()?.pose.heading() ?? 0;
  }

  /** Returns the place of a handle on the canvas, for tests. */
  pixelOfHandle(id: string): [number, number] | null {
    const handle = this.handles.handles.find(({words}) => words.id === id);
    return handle ? this.renderer.pixelOf(handle.shown_in_world) : null;
  }

  private paint(): void {
    for (const part of [this.floor, this.rig, this.handles, this.points, this.crowd, ...this.bodies,
      ...this.parts]) {
      part?.paint(this.theme);
    }
    this.renderer.paint(this.theme);
  }

  /** Frames the bodies again after the stage was resized. */
  private settle(): void {
    if (this.listener.reset && !this.orbit.touched) this.listener.reset();
    else if (!this.listener.reset && this.framed) this.frameBodies(true);
    else if (!this.framed) this.frameRoom();
  }

  /** Draws a picture now. */
  draw(): void {
    this.picture(performance.now());
  }

  private reset(): void {
    if (this.listener.reset) this.listener.reset();
    else this.frameBodies();
  }

  private picture(now_ms: number): void {
    const seconds = Math.min((now_ms - this.last_ms) / 1000, 0.1);
    this.last_ms = now_ms;
    this.listener.beforePicture(now_ms);
    this.orbit.glide(seconds);
    const {x, z} = this.orbit.target;
    this.floor.place(x, z);
    this.rig.object.visible = this.shown.cameras;
    this.handles.object.visible = this.shown.handles;
    const {eye} = this.renderer;
    this.handles.update(eye);
    for (const part of this.parts) part.update(eye);
    this.renderer.render();
    this.placeLabels();
    this.listener.afterPicture();
  }

  private placeLabels(): void {
    const {labels, renderer: {camera, width, height}, words} = this;
    labels.begin(width, height);
    if (this.shown.names && words) {
      for (const body of this.crowd ? [] : this.bodies) {
        if (!body.object.visible || body.isGhost) continue;
        const [dx, dy, dz] = body.words.offset_m;
        const p = body.pose.p_in_world;
        labels.add(body.words.name, 'body', camera, p[0] + dx, body.top_m() + dy + NAME_ABOVE_M,
          p[2] + dz);
      }
      if (this.shown.cameras) {
        for (const {name, world_from_camera: {p}} of words.cameras) {
          labels.add(name, 'camera', camera, p[0], p[1] + 0.1, p[2]);
        }
      }
      this.namePoints();
    }
    if (this.shown.handles) this.nameHandles();
    labels.end();
  }

  private namePoints(): void {
    const {points} = this;
    if (!points || points.labels.length > MOST_POINT_NAMES) return;
    points.labels.forEach((label, i) => {
      const at = 3 * i;
      const p = points.p_in_world;
      if (Number.isNaN(p[at])) return;
      this.labels.add(label, 'point', this.renderer.camera, p[at], p[at + 1] + 0.01, p[at + 2]);
    });
  }

  /** Shows the name of the handle under the pointer only; all names would hide the body. */
  private nameHandles(): void {
    const handle = this.handles.handles.find(({words}) => words.id === this.handles.held);
    if (!handle) return;
    const [x, y, z] = handle.shown_in_world;
    this.labels.add(handle.words.id, 'handle', this.renderer.camera, x, y + 0.06, z);
  }
}
