// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Handles of constraints: one shape per kind, drawn over everything else.

import {
  BoxGeometry, BufferGeometry, ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial,
  OctahedronGeometry, SphereGeometry,
} from 'three';
import type {Pose} from './posed_skeleton';
import type {ConstraintWords, SkeletonWords, Vector} from '../protocol/protocol';
import type {Theme} from '../base/theme';

/** Share of the distance to the eye, so that handles have a constant size on screen. */
const SIZE = 0.0105;

const SHAPES: Record<ConstraintWords['kind'], () => BufferGeometry> = {
  position: () => new SphereGeometry(1, 16, 10),
  distance: () => new OctahedronGeometry(1.3),
  box: () => new BoxGeometry(1.7, 1.7, 1.7),
  orientation: () => new ConeGeometry(1, 2.2, 12),
  support: () => new CylinderGeometry(1.3, 1.3, 0.5, 14),
};

export interface Handle {
  words: ConstraintWords;
  /** Drawn position, including the offset of its skeleton. */
  shown_in_world: Vector;
  /** Offset of its skeleton. */
  offset_m: Vector;
  object: Group;
}

export class ConstraintView {
  readonly object = new Group();
  handles: Handle[] = [];
  /** The handle under the pointer or being dragged. */
  held: string | null = null;
  private readonly plain = new MeshBasicMaterial({depthTest: false, transparent: true});
  private readonly bright = new MeshBasicMaterial({depthTest: false, transparent: true});
  private readonly idle = new MeshBasicMaterial({depthTest: false, transparent: true,
    opacity: 0.45});
  private readonly rim = new MeshBasicMaterial({depthTest: false, transparent: true});

  /** Keeps a dragged handle at its dragged position. */
  set(constraints: readonly ConstraintWords[], skeletons: readonly SkeletonWords[],
    inHand: string | null): void {
    const before = new Map(this.handles.map((handle) => [handle.words.id, handle]));
    for (const handle of this.handles) handle.object.removeFromParent();
    this.handles = constraints.map((words) => {
      const offset_m = skeletons[words.skeleton]?.offset_m ?? [0, 0, 0];
      const old = before.get(words.id);
      const same = old && old.words.kind === words.kind;
      const object = same ? old.object : this.make(words.kind);
      const at = inHand === words.id && old ? old.words.p_in_world : words.p_in_world;
      const handle: Handle = {words: {...words, p_in_world: [...at]}, offset_m, object,
        shown_in_world: [at[0] + offset_m[0], at[1] + offset_m[1], at[2] + offset_m[2]]};
      this.object.add(object);
      return handle;
    });
  }

  /** Moves handles with their joints, except a dragged one; hides those of absent bodies.
   *  `poses` has one entry per skeleton of the scene, null for an absent body. */
  follow(poses: readonly (Pose | null)[], inHand: string | null): void {
    for (const handle of this.handles) {
      const {joint, skeleton, id} = handle.words;
      const pose = poses[skeleton];
      handle.object.visible = joint === undefined || id === inHand || !!pose;
      if (joint === undefined || id === inHand || !pose || joint >= pose.joints) continue;
      for (let k = 0; k < 3; ++k) {
        const at = pose.p_in_world[3 * joint + k];
        handle.words.p_in_world[k] = at;
        handle.shown_in_world[k] = at + handle.offset_m[k];
      }
    }
  }

  /** Moves targets to their new places, except a dragged one. Both lists have one entry per
   *  handle; other lists belong to another scene and are ignored. */
  setTargets(p_in_world: readonly Vector[], held: readonly boolean[], inHand: string | null): void {
    if (p_in_world.length !== this.handles.length || held.length !== this.handles.length) return;
    this.handles.forEach((handle, i) => {
      handle.words.active = held[i];
      if (handle.words.id === inHand) return;
      const at = p_in_world[i];
      handle.words.p_in_world = [...at];
      handle.shown_in_world = at.map((v, k) => v + handle.offset_m[k]) as Vector;
    });
  }

  /** `shown_in_world` is the drawn position of the handle. */
  move(handle: Handle, shown_in_world: Vector): void {
    handle.shown_in_world = shown_in_world;
    handle.words.p_in_world = shown_in_world.map((v, k) => v - handle.offset_m[k]) as Vector;
  }

  paint(theme: Theme): void {
    this.plain.color.setStyle(theme.colour('accent'));
    this.bright.color.setStyle(theme.colour('ink'));
    this.idle.color.setStyle(theme.colour('quiet'));
    this.rim.color.setStyle(theme.colour('card'));
  }

  update(eye: Vector): void {
    for (const {words, shown_in_world: at, object} of this.handles) {
      const away = Math.hypot(at[0] - eye[0], at[1] - eye[1], at[2] - eye[2]);
      object.position.set(...at);
      object.scale.setScalar(SIZE * away * (this.held === words.id ? 1.35 : 1));
      const [rim, body] = object.children as Mesh[];
      body.material = this.held === words.id ? this.bright
        : words.active ? this.plain : this.idle;
      rim.visible = words.active;
    }
  }

  private make(kind: ConstraintWords['kind']): Group {
    const shape = (SHAPES[kind] ?? SHAPES.position)();
    const rim = new Mesh(shape, this.rim);
    rim.scale.setScalar(1.28);
    rim.renderOrder = 20;
    const body = new Mesh(shape, this.plain);
    body.renderOrder = 21;
    const group = new Group();
    group.add(rim, body);
    return group;
  }
}
