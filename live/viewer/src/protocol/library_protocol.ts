// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Messages between marey and the page of a motion library (docs/formats/library_page.md).
// Frames and times count from the first frame of a clip.

import type {SceneWords} from './protocol';

export type Verdict = 'pass' | 'warn' | 'fail';
export const VERDICTS: readonly Verdict[] = ['pass', 'warn', 'fail'];

export type SortKey = 'number' | 'name' | 'seconds' | 'rate_hz' | 'quality' | 'licence';

export interface LibraryWords {
  type: 'library'; version: number;
  /** Incremented when the index was read again. Numbers of clips belong to it. */
  revision: number;
  name: string; folder: string; clips: number;
  /** Number of sources that gave no clip. */
  failed: number;
  /** The reason why there is no list; empty: none. */
  trouble: string;
  /** Expression of the command line. */
  query: string;
}

export interface ClipRow {
  clip: number; clip_id: string; name: string; seconds: number; rate_hz: number;
  quality: Verdict; licence: string; subject: string; split: string;
  labels: string[]; found_labels: string[];
}

export interface ClipsWords {
  type: 'clips'; id: string; revision: number; offset: number;
  /** Number of clips that fulfil the query and have the wanted verdict. */
  found: number;
  /** Clips that fulfil the query, by verdict. */
  counts: Record<Verdict, number>;
  remarks: string[]; rows: ClipRow[];
}

/** Points of a posture in the order of BONES: x to the right of the hips and y above the
 *  floor by turns. [mm] */
export type PosePoints = number[];

export interface DrawingWords {clip: number; poses: PosePoints[] | null}

export interface DrawingsWords {
  type: 'drawings'; id: string; revision: number; drawings: DrawingWords[];
}

/** First and last frame, both included. */
export type ClipSpan = [number, number];

export interface FigureWords {
  name: string; value: number;
  /** null: only reported. */
  verdict: Verdict | null;
  joint: string; frames: ClipSpan | null;
  /** Kind of its problems. */
  kind: string;
  warn: number | null; fail: number | null;
}

export interface ProblemWords {frames: ClipSpan; kind: string; joint: string; value: number}
export interface LabelWords {
  start_s: number; end_s: number; text: string; by: string; certainty: number;
}
export interface EventWords {frame: number; name: string}

export interface ProvenanceWords {
  source_id: string; path: string; kind: string; licence: string; origin: string;
  commit: string; subject: string; attribution: string;
}

export interface NeighbourWords extends ClipRow {
  distance: number;
  /** The similar part. */
  start_s: number; end_s: number;
  /** The reason why its motion is not shown; empty: it is. */
  trouble: string;
}

export interface ClipWords {
  type: 'clip'; id: string; revision: number; row: ClipRow;
  /** In the source. */
  frames: ClipSpan;
  rate_by: string; body: string; object_key: string; duplicate_of: string; mirror_of: string;
  provenance: ProvenanceWords; figures: FigureWords[]; problems: ProblemWords[];
  labels: LabelWords[]; events: EventWords[];
  /** The clip and the neighbours that have motions; null: the clip has none. */
  scene: SceneWords | null;
  /** Frames of the clip from one frame of the scene to the next. */
  frame_step: number;
  trouble: string; mirrored: boolean;
  /** Length of the compared part, from the start of the clip. */
  compared_s: number;
  neighbours: NeighbourWords[]; neighbour_trouble: string;
}

export interface StoredWords {
  type: 'stored'; id: string; revision: number; about: string; file: string;
}
/** The request belongs to an older index. */
export interface OutdatedWords {type: 'outdated'; id: string; revision: number; about: string}

/** Messages that only the server of a library sends. */
export type LibraryServerWords = LibraryWords | ClipsWords | DrawingsWords | ClipWords |
  StoredWords | OutdatedWords;

export const LIBRARY_TYPES: readonly string[] = ['library', 'clips', 'drawings', 'clip',
  'stored', 'outdated'] satisfies LibraryServerWords['type'][];

/** A filtered and sorted list. */
export interface ListOrder {
  query: string;
  /** null: all. */
  quality: Verdict | null;
  sort: SortKey; descending: boolean;
}

export interface VerdictForm {
  clip_id: string; figure: string; frames: ClipSpan | null; verdict: Verdict; by: string;
  note: string;
}

export interface LabelForm {
  clip_id: string; start_s: number; end_s: number; label: string; by: string; sure: boolean;
}

interface Asked {id: string; revision: number}

/** Requests without the members that every request has. */
export type LibraryQuestion =
  | ({type: 'list'; offset: number; count: number} & ListOrder)
  | {type: 'poses'; clips: number[]}
  | {type: 'clip'; clip: number; mirrored: boolean}
  | ({type: 'verdict'} & VerdictForm)
  | ({type: 'label'} & LabelForm);

export type LibraryPageWords = LibraryQuestion & Asked;
