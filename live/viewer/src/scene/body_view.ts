// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// One body on the stage: its pose, bones, optional skin, and balance.

import {Group} from 'three';
import type {Object3D} from 'three';
import {BalanceView} from './balance_view';
import type {SkeletonFrame} from '../protocol/decode_frame';
import type {Pose} from './posed_skeleton';
import type {SkeletonWords} from '../protocol/protocol';
import {SkeletonView} from './skeleton_view';
import type {Colouring} from './skeleton_view';
import type {Theme} from '../base/theme';

/** The parts that are drawn; the user chooses them. */
export interface Shown {
  skin: boolean; bones: boolean; uncertainty: boolean; balance: boolean; cameras: boolean;
  handles: boolean; names: boolean; follow: boolean; ghost: boolean; colouring: Colouring;
}

/** The skin of a body. */
export interface Skin {
  readonly object: Object3D;
  /** Applies the pose that was set last. */
  update(pose: Pose): void;
  dispose(): void;
}

/** Loads the skin of a skeleton. Throws an Error with the cause. */
export type SkinLoader = (words: SkeletonWords, signal: AbortSignal) => Promise<Skin>;

export class BodyView {
  readonly object = new Group();
  /** True once a pose was shown. */
  present = false;
  /** null: its bones are drawn with those of the crowd. */
  private readonly skeleton: SkeletonView | null;
  private readonly balance: BalanceView;
  private avatar: Skin | null = null;
  private readonly loading = new AbortController();

  /** `isGhost`: drawn translucent, to compare another body with it. `isInCrowd`: a CrowdView
   *  draws its bones. */
  constructor(readonly words: SkeletonWords, readonly pose: Pose, private readonly shown: Shown,
    private readonly floor_m: number, isSolid: boolean, readonly isGhost = false,
    isInCrowd = false) {
    this.skeleton = isInCrowd ? null : new SkeletonView(pose, words.offset_m, words.kind === 'performer',
      words.skin !== null, isSolid ? words.joints.map(({bone}) => bone) : null, isGhost);
    this.balance = new BalanceView(words.offset_m);
    this.object.add(this.balance.object);
    if (this.skeleton) this.object.add(this.skeleton.object);
    this.object.visible = false;
  }

  /** Adds the skin; `loaded` gets the error, or an empty text. */
  async dress(load: SkinLoader, loaded: (trouble: string) => void): Promise<void> {
    const {words, loading} = this;
    try {
      const avatar = await load(words, loading.signal);
      this.avatar = avatar;
      this.object.add(avatar.object);
      avatar.update(this.pose);
      loaded('');
    } catch (problem) {
      if (loading.signal.aborted) return;
      loaded(`The skin of ${words.name} cannot be shown, its bones are: ` +
        `${problem instanceof Error ? problem.message : String(problem)}`);
    }
  }

  get dressed(): boolean {
    return this.avatar !== null;
  }

  paint(theme: Theme): void {
    this.skeleton?.paint(theme);
    this.balance.paint(theme);
  }

  /** Shows the body of this frame; hides it if the body is absent. */
  update(frame: SkeletonFrame): void {
    this.object.visible = frame.hasPose && (this.shown.ghost || !this.isGhost);
    if (!frame.hasPose) return;
    this.present = true;
    this.pose.setFrame(frame);
    const skin = this.shown.skin && this.avatar !== null;
    this.skeleton?.show(this.shown.bones || !skin, this.shown.uncertainty && frame.hasUncertainty,
      this.isGhost ? 'plain' : this.shown.colouring);
    this.skeleton?.update(frame, this.floor_m);
    if (this.avatar) {
      this.avatar.object.visible = skin;
      if (skin) this.avatar.update(this.pose);
    }
    this.balance.object.visible = this.shown.balance && frame.hasBalance && !this.isGhost;
    if (this.balance.object.visible) this.balance.update(frame, this.floor_m);
  }

  /** Height of the highest joint. [m] */
  top_m(): number {
    let top = -Infinity;
    for (let i = 1; i < this.pose.p_in_world.length; i += 3) {
      top = Math.max(top, this.pose.p_in_world[i]);
    }
    return top;
  }

  dispose(): void {
    this.loading.abort();
    this.object.removeFromParent();
    this.skeleton?.dispose();
    this.balance.dispose();
    this.avatar?.dispose();
  }
}
