// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Messages of a scene that runs live: marey stage --live (docs/formats/page.md).

import type {Vector} from './protocol';

export type RunAction = 'play' | 'pause' | 'restart';

/** A measured figure of the scene. */
export interface FigureWords {
  name: string; unit: string;
  /** null: not measured yet. */
  value: number | null;
  /** Bound in words; empty: none. */
  bound: string;
  /** null: there is no bound, or no value. */
  passed: boolean | null;
}

export interface RunWords {
  type: 'run'; state: 'playing' | 'paused'; time_s: number; duration_s: number;
  figures: FigureWords[]; messages: string[];
}

/** Targets of the scene, in the order of its constraints. */
export interface TargetsWords {
  type: 'targets';
  p_in_world: Vector[];
  /** The user has moved the target; its path does not apply. */
  held: boolean[];
}

export const RUN_TYPES: readonly string[] = ['run', 'targets'];
