// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// One body on the stage: its pose, bones, optional skin, and balance.

import {Group} from 'three';
import {AvatarView} from './avatar_view';
import {BalanceView} from './balance_view';
import type {SkeletonFrame} from './decode_frame';
import {PosedSkeleton} from './posed_skeleton';
import type {SkeletonWords} from './protocol';
import {SkeletonView} from './skeleton_view';
import type {Colours} from './theme';

/** The parts that are drawn; the user chooses them. */
export interface Shown {
  skin: boolean;
  bones: boolean;
  doubt: boolean;
  balance: boolean;
  cameras: boolean;
  handles: boolean;
  names: boolean;
  follow: boolean;
}

export class BodyView {
  readonly object = new Group();
  readonly pose: PosedSkeleton;
  /** True once a pose was shown. */
  present = false;
  private readonly skeleton: SkeletonView;
  private readonly balance: BalanceView;
  private avatar: AvatarView | null = null;
  private readonly loading = new AbortController();

  constructor(readonly words: SkeletonWords, private readonly shown: Shown,
    private readonly floor_m: number, loaded: (trouble: string) => void) {
    this.pose = new PosedSkeleton(words);
    this.skeleton = new SkeletonView(this.pose, words.offset_m, words.kind === 'performer',
      words.skin !== null);
    this.balance = new BalanceView(words.offset_m);
    this.object.add(this.skeleton.object, this.balance.object);
    this.object.visible = false;
    if (words.skin) void this.dress(loaded);
  }

  private async dress(loaded: (trouble: string) => void): Promise<void> {
    const {words, loading} = this;
    // A separate pose at rest, because this one changes while the file is loaded.
    const rest = new PosedSkeleton(words);
    try {
      const avatar = await AvatarView.load(words, words.skin!, rest, loading.signal);
      avatar.follow(this.pose);
      this.avatar = avatar;
      this.object.add(avatar.object);
      avatar.update();
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

  paint(colours: Colours): void {
    this.skeleton.paint(colours);
    this.balance.paint(colours);
  }

  /** Shows the body of this frame; hides it if the body is absent. */
  update(frame: SkeletonFrame): void {
    this.object.visible = frame.hasPose;
    if (!frame.hasPose) return;
    this.present = true;
    this.pose.setFrame(frame);
    const skin = this.shown.skin && this.avatar !== null;
    this.skeleton.show(this.shown.bones || !skin, this.shown.doubt && frame.hasDoubt);
    this.skeleton.update(frame, this.floor_m);
    if (this.avatar) {
      this.avatar.object.visible = skin;
      if (skin) this.avatar.update();
    }
    this.balance.object.visible = this.shown.balance && frame.hasBalance;
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
    this.skeleton.dispose();
    this.balance.dispose();
    this.avatar?.dispose();
  }
}
