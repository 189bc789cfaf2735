// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Messages between marey edit and its page (docs/formats/edit_page.md). Times and frames
// count from the first pose of the shown motion.

import type {ConstraintWords, Gap, SkeletonWords, TrackWords, Vector} from './protocol';

export type OpValue = string | number | boolean | OpValue[] | {[key: string]: OpValue};
/** The keys of an operation in a recipe, with their units. Keys with default values are
 *  absent. */
export interface OpKeys {do: string; [key: string]: OpValue}

/** A step of a change of the recipe. */
export type OpStep =
  | {insert: number; op: OpKeys}
  | {replace: number; op: OpKeys}
  | {remove: number}
  | {move: number; to: number}
  | {toggle: number; off: boolean};

export interface OpWords {
  /** Name with version: cut@1. */
  do: string;
  off: boolean;
  /** Its text in the recipe. */
  text: string;
  keys: OpKeys;
}

export interface EditSourceWords {id: string; file: string; frames: number; rate_hz: number}

export interface RevisionWords {
  type: 'revision'; revision: number; parent: number;
  cause: 'open' | 'edit' | 'undo' | 'redo' | 'file'; sha256: string; name: string;
  recipe_file: string; recipe_text: string; sources: EditSourceWords[]; avatars: string[];
  ops: OpWords[]; undo_possible: boolean; redo_possible: boolean;
}

export interface ProgressWords {
  type: 'progress'; revision: number; done: number; total: number;
  state: 'rendering' | 'done' | 'failed';
  /** Index of the operation that failed. */
  op: number | null;
  error: string;
}

export interface FindingWords {
  severity: 'note' | 'fair' | 'poor'; id: string; text: string; next: string;
  value: number | null; limit: number | null; unit: string;
}

export interface OpReportWords {
  op: number; do: string; figures: Record<string, number>; findings: FindingWords[];
}

/** First and last frame, both included. */
export type Span = [number, number];
export type Foot = 'left' | 'right';
export type FootPart = 'heel' | 'ball';

export interface EditContactWords {name: string; foot: Foot; part: FootPart; spans: Span[]}
export interface AnnotationWords {text: string; start_s: number; end_s: number}

export interface EditConstraintWords {
  id: string; kind: ConstraintWords['kind']; segment: string; start_s: number | null;
  stop_s: number | null; start_duration_s: number; stop_duration_s: number;
  p_in_world: Vector | null; draggable: boolean;
}

export interface EditGraphWords {
  name: string; unit: string;
  values: (number | null)[];
  /** The same of the source. */
  before: (number | null)[];
}

export interface EditFiguresWords {
  duration_s: number; slide_mm: number; slide_cm_per_s: number; displaced_mm: number;
  acceleration_ratio: number; constraint_mm: number; inferred_frames: number;
}

export interface OutputWords {
  name: string; frames: number; rate_hz: number;
  /** Frames that `block`, `graphs` and `value_curves` contain. */
  span: Span;
  block: string; contacts: EditContactWords[]; trust: Gap[]; tracks: TrackWords[];
  /** First, last, index of the source, its first and last frame. */
  lineage: [number, number, number, number, number][];
  /** First, last, indices of operations. */
  touched: [number, number, number[]][];
  annotations: AnnotationWords[]; value_curves: {name: string; values: number[]}[];
  constraints: EditConstraintWords[]; graphs: EditGraphWords[];
  figures: EditFiguresWords | null;
}

/** Results of a revision, or of a preview. */
export interface RenderedParts {
  revision: number;
  /** Number of the scene that the blocks belong to. */
  scene: number;
  /** Number of operations that are applied; null: all. */
  until: number | null;
  outputs: OutputWords[]; reports: OpReportWords[]; findings: FindingWords[];
}

export interface RenderedWords extends RenderedParts {type: 'rendered'}

export interface PreviewWords extends RenderedParts {
  type: 'preview'; id: string;
  /** null: those of the scene. */
  skeletons: SkeletonWords[] | null;
}

export interface LoopCandidateWords {
  first: number; last: number; first_s: number; last_s: number; period_s: number;
  distance_mm: number; edge: 'left_strike' | 'right_strike' | 'none';
}

export interface LoopMapWords {
  cells: number; cell_frames: number;
  /** Row after row; 0 below the diagonal. */
  distance_mm: number[];
}

export interface LoopsWords {
  type: 'loops'; id: string; revision: number; until: number | null; output: number;
  candidates: LoopCandidateWords[]; map: LoopMapWords | null;
}

/** A jump of the motion before the operation. */
export interface FoundJumpWords {
  start_s: number; takeoff_s: number; apex_s: number; landing_s: number | null;
  end_s: number | null; airtime_s: number | null; rise_m: number;
  /** Vertical acceleration of the captured flight; 0: unknown. */
  fall_m_s2: number;
  /** Captured lowest point of the push; `lowest_at` is a share of its duration. */
  lowest_at: number | null; lowest_m: number;
  takeoff: 'measured' | 'inferred'; landing: 'measured' | 'inferred'; findings: FindingWords[];
}

export type PushRule = 'force' | 'fall' | 'rise';
/** Share of the push, lowest and highest allowed height [m], and the rules that bind there. */
export type SpaceColumnWords = [number, number, number, PushRule, PushRule];
/** A lowest point of a push: share of its duration, and height of the centre of mass. */
export interface LowestWords {at: number; height_m: number}

export interface JumpPhasesWords {
  start_s: number; lowest_s: number; takeoff_s: number; apex_s: number; landing_s: number;
  end_s: number;
}

export interface JumpWords {
  type: 'jump'; id: string; revision: number; op: number; output: number;
  /** Which of `jumps` the operation changes, from 1. */
  number: number;
  jumps: FoundJumpWords[];
  /** Why the wishes cannot be met; empty: they can. */
  refusal: string;
  /** Times of the new motion; the curves have the same size or are empty. */
  time_s: number[];
  height_m: (number | null)[]; captured_height_m: (number | null)[];
  push_g: (number | null)[]; captured_push_g: (number | null)[];
  phases: JumpPhasesWords | null; strength_g: number | null;
  space: SpaceColumnWords[]; lowest: LowestWords | null;
}

export interface AcceptedWords {type: 'accepted'; id: string; revision: number}
export interface StaleWords {
  type: 'stale'; id: string; about: string; base_revision: number; revision: number;
}
export interface ExportedWords {
  type: 'exported'; id: string; revision: number; files: string[]; findings: FindingWords[];
}
/** A request that was refused; `id` is empty if the message could not be read. */
export interface EditErrorWords {type: 'error'; id?: string; about?: string; text: string}

/** Messages that only marey edit sends. */
export type EditWords = RevisionWords | ProgressWords | RenderedWords | PreviewWords |
  LoopsWords | JumpWords | AcceptedWords | StaleWords | ExportedWords;

export const EDIT_TYPES: readonly string[] = ['revision', 'progress', 'rendered', 'preview',
  'loops', 'jump', 'accepted', 'stale', 'exported'] satisfies EditWords['type'][];

/** Which part of which motion is rendered for a preview. */
export interface PreviewParts {until?: number | null; output?: number; span?: Span}

export interface LoopsOptions {
  until?: number | null; output?: number; min_period_s?: number; max_period_s?: number;
  map?: boolean;
}

export interface JumpOptions {op: number; output?: number; ops_patch?: OpStep[]}

interface Asked {base_revision: number; id: string}

/** Messages from the page of marey edit. */
export type EditPageWords =
  | ({type: 'edit'; ops_patch: OpStep[]} & Asked)
  | ({type: 'undo' | 'redo' | 'export'} & Asked)
  | ({type: 'preview'; ops_patch: OpStep[]} & Asked & PreviewParts)
  | ({type: 'render'} & Asked & PreviewParts)
  | ({type: 'loops'} & Asked & LoopsOptions)
  | ({type: 'jump'} & Asked & JumpOptions);
