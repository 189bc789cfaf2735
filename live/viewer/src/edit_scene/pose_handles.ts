// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Handles of the hands, the feet, the hips and the constraints of the edited body. A drag
// makes a key of the pose, or a constraint, or moves one.

import type {Change} from '../edit/edit_document';
import type {EditView} from '../edit/edit_view';
import {legLength_m} from './leg_length';
import {constraintChange, isActiveAt, newConstraint, poseChange} from './pose_changes';
import type {Instant, ShownBody} from './pose_changes';
import type {EditConstraintWords} from '../protocol/edit_protocol';
import type {ConstraintWords, DragPhase, SkeletonWords, Vector} from '../protocol/protocol';
import {button, chooser, el, remember, remembered, setText} from '../base/elements';
import {boneWords, capitalized} from '../base/words';
import type {Stage} from '../scene/stage';

const BONES = ['leftHand', 'rightHand', 'leftFoot', 'rightFoot', 'hips'];
/** The bodies of the scene. */
const SOURCE = 0;
const RESULT = 1;
const MODES = [
  ['key', 'Key', 'A drag displaces the motion around the shown instant'],
  ['constraint', 'Constraint',
    'A drag adds a constraint that holds the place around the shown instant'],
] as const;
type Mode = typeof MODES[number][0];
/** Shorter drags change nothing. */
const MIN_DRAG_M = 0.0005;

/** Object that a handle belongs to. */
type Target = {bone: string; joint: number} | {constraint: EditConstraintWords};
/** A drag: `from` is the place of the handle, `start` that of its joint in the whole frame. */
interface Grip {target: Target; from: Vector; start: Vector; at: Instant; change: Change | null}

export class PoseHandles {
  readonly element: HTMLElement;
  private mode: Mode = remembered('edit.handles') === 'constraint' ? 'constraint' : 'key';
  private readonly modes: HTMLButtonElement[];
  private readonly bone = chooser(BONES.map((bone) => [bone, capitalized(boneWords(bone))]),
    BONES[0], () => this.showFields(), {'aria-label': 'Joint'});
  private readonly steps = ['x', 'y', 'z'].map((axis) => el('input', {type: 'number',
    step: '0.01', value: '0', 'aria-label': `Move along ${axis} in metres`}));
  private readonly note = el('p', {class: 'note'});
  private joints: Target[] = [];
  private constraints: readonly EditConstraintWords[] = [];
  private active = new Uint8Array(0);
  private readonly targets = new Map<string, Target>();
  private grip: Grip | null = null;
  private hidden = false;
  /** As in ShownBody. */
  private scale = 1;

  /** `seek` stops playing and shows a frame of the shown motion. */
  constructor(private readonly view: EditView, private readonly stage: Stage,
    private readonly seek: (frame: number) => void) {
    this.modes = MODES.map(([mode, text, title]) =>
      button({title, onclick: () => this.choose(mode)}, text));
    this.element = el('div', {class: 'pose-tool'},
      el('div', {class: 'row', role: 'group', 'aria-label': 'A drag makes a'},
        ...this.modes),
      el('div', {class: 'row'}, this.bone, button({onclick: () => this.moveByFields()}, 'Move')),
      el('div', {class: 'row'}, 'x ', this.steps[0], ' y ', this.steps[1], ' z ', this.steps[2],
        ' m'), this.note);
    this.choose(this.mode);
  }

  /** Sets the skeletons of the scene, after Stage.setScene(). */
  setSkeletons(skeletons: readonly SkeletonWords[]): void {
    const joints = skeletons[RESULT]?.joints ?? [];
    const [source_m, result_m] = [SOURCE, RESULT].map((i) =>
      legLength_m(skeletons[i]?.joints ?? []));
    this.scale = source_m && result_m ? source_m / result_m : 1;
    this.joints = BONES.map((bone) => ({bone, joint: joints.findIndex((one) => one.bone === bone)}))
      .filter(({joint}) => joint >= 0);
    this.update();
  }

  /** Called when the shown motion or the recipe has changed. */
  update(): void {
    if (this.grip) return; // At the end of the drag.
    this.constraints = this.view.output?.constraints ?? [];
    this.active = new Uint8Array(this.constraints.length);
    this.findActive(this.view.time);
    this.place();
    this.showFields();
  }

  /** Called when the shown instant has changed. */
  setTime(time: number): void {
    if (!this.grip && this.findActive(time)) this.place();
  }

  /** Removes the handles from the stage while another tool uses it. */
  setHidden(hidden: boolean): void {
    this.hidden = hidden;
    this.place();
  }

  /** StageListener.drag. */
  drag(id: string, p_in_world: Vector, phase: DragPhase): void {
    if (phase === 'begin') this.begin(id, p_in_world);
    const {grip} = this;
    if (!grip || phase === 'begin') return;
    const [dx, dy, dz] = p_in_world.map((part, k) => part - grip.start[k]);
    const away_m = Math.hypot(...p_in_world.map((part, k) => part - grip.from[k]));
    grip.change = away_m < MIN_DRAG_M ? null
      : this.changeOf(grip.target, [dx, dy, dz], p_in_world, grip.at);
    if (phase === 'move') {
      if (grip.change) this.view.preview(grip.change);
      return;
    }
    this.grip = null;
    if (grip.change) void this.view.commit(grip.change);
    else this.view.cancel();
    this.update();
  }

  /** Ends a drag without a change. */
  giveUp(): void {
    if (!this.grip) return;
    this.grip = null;
    this.view.cancel();
    this.update();
  }

  // --- Handles ---

  /** Returns whether other constraints are active than before. Allocates nothing. */
  private findActive(time: number): boolean {
    const time_s = time / (this.view.output?.rate_hz ?? 1);
    let changed = false;
    for (let i = 0; i < this.constraints.length; ++i) {
      const active = isActiveAt(this.constraints[i], time_s) ? 1 : 0;
      if (this.active[i] === active) continue;
      this.active[i] = active;
      changed = true;
    }
    return changed;
  }

  /** Sets the handles on the stage. Where two coincide, the last one is dragged. */
  private place(): void {
    if (this.hidden) {
      this.stage.setConstraints([]);
      return;
    }
    const ids = new Set(this.constraints.map(({id}) => id));
    this.targets.clear();
    const joints = this.joints.map((target): ConstraintWords => {
      const {bone, joint} = target as {bone: string; joint: number};
      const name = capitalized(boneWords(bone));
      const id = ids.has(name) ? `${name} (joint)` : name;
      this.targets.set(id, target);
      return {id, skeleton: RESULT, kind: 'position', active: true, p_in_world: [0, 0, 0],
        draggable: true, joint};
    });
    const goals: ConstraintWords[] = [];
    this.constraints.forEach((constraint, i) => {
      const {id, kind, p_in_world, draggable} = constraint;
      if (!this.active[i] || !p_in_world) return;
      this.targets.set(id, {constraint});
      const movable = draggable &&
        constraintChange(constraint, [0, 0, 0], this.view.document.ops, this.body) !== null;
      goals.push({id, skeleton: RESULT, kind: kind === 'position' ? 'distance' : kind,
        active: movable, p_in_world: [...p_in_world], draggable: movable});
    });
    this.stage.setConstraints(this.mode === 'key' ? [...goals, ...joints]
      : [...joints, ...goals]);
  }

  private choose(mode: Mode): void {
    this.mode = mode;
    remember('edit.handles', mode);
    this.modes.forEach((one, i) => {
      one.setAttribute('aria-pressed', String(MODES[i][0] === mode));
    });
    this.place();
    this.showFields();
  }

  // --- Changes ---

  private get body(): ShownBody {
    return {until: this.view.until, scale: this.scale};
  }

  private instant(frame: number): Instant {
    const {output, until} = this.view;
    return {frame, until, rate_hz: output?.rate_hz ?? 30, frames: output?.frames ?? 1};
  }

  private begin(id: string, p_in_world: Vector): void {
    const target = this.targets.get(id);
    if (!target || !this.view.output) return;
    const {time} = this.view;
    const frame = Math.round(time);
    this.seek(frame);
    let start: Vector = [...p_in_world];
    if ('joint' in target && frame !== time) {
      // The joint moves to its place in the whole frame.
      this.stage.draw();
      start = this.jointInWorld(target.joint) ?? start;
    }
    this.grip = {target, from: [...p_in_world], start, at: this.instant(frame), change: null};
  }

  private changeOf(target: Target, moved_m: Vector, to_m: Vector, at: Instant): Change | null {
    if ('constraint' in target) {
      return constraintChange(target.constraint, moved_m, this.view.document.ops, this.body);
    }
    if (this.mode === 'key') return poseChange(target.bone, moved_m, at);
    return newConstraint(target.bone, to_m, at, this.constraints.map(({id}) => id));
  }

  private jointInWorld(joint: number): Vector | null {
    const p = this.stage.poseOf(RESULT)?.p_in_world;
    return p ? [p[3 * joint], p[3 * joint + 1], p[3 * joint + 2]] : null;
  }

  // --- Fields ---

  private showFields(): void {
    const bone = boneWords(this.bone.value);
    setText(this.note, this.mode === 'key'
      ? `Moves the ${bone} at the shown instant, with a fade of 0.5 s before and after it.`
      : `Holds the ${bone} at the new place for 0.5 s around the shown instant.`);
  }

  private moveByFields(): void {
    const target = this.joints.find((one) => 'bone' in one && one.bone === this.bone.value);
    const moved = this.steps.map(({value}) => Number(value)) as Vector;
    if (!target || !('joint' in target) || !this.view.output || !moved.every(Number.isFinite)) {
      return;
    }
    const frame = Math.round(this.view.time);
    this.seek(frame);
    this.stage.draw();
    const p = this.jointInWorld(target.joint);
    const isStill = moved.every((part) => part === 0) && this.mode === 'key';
    if (!p || isStill) return;
    const change = this.changeOf(target, moved, [p[0] + moved[0], p[1] + moved[1],
      p[2] + moved[2]], this.instant(frame));
    for (const step of this.steps) step.value = '0';
    if (change) void this.view.commit(change);
  }
}
