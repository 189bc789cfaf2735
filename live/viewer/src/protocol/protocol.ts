// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Messages between marey and its page, version 1 (docs/formats/page.md). The
// world is right-handed, Y up, in metres and seconds; quaternions are x y z w.

import type {RunAction, RunWords, TargetsWords} from './run_protocol';
import {RUN_TYPES} from './run_protocol';
import type {EditErrorWords, EditPageWords, EditWords} from './edit_protocol';
import {EDIT_TYPES} from './edit_protocol';
import type {LibraryPageWords, LibraryServerWords} from './library_protocol';
import {LIBRARY_TYPES} from './library_protocol';

export const PROTOCOL_VERSION = 1;

export type Vector = [number, number, number];
export type Quaternion = [number, number, number, number];
export type Source = 'measured' | 'repaired' | 'inferred';

/** Sources, indexed by the numbers in frames and point blocks. */
export const SOURCES: readonly Source[] = ['measured', 'repaired', 'inferred'];

/** Transform in the parent's frame (of a root: in the world). */
export interface Placement {p: Vector; q: Quaternion}

export interface JointWords {name: string; parent: number; bone: string; rest: Placement}

export interface SkinWords {
  media: string; format: string; nodes: string[]; node_index: number[]; unit_from_m: number;
  /** Rotation of the whole file into the scene's axes. */
  scene_from_file: Quaternion;
}

export interface SkeletonWords {
  name: string; kind: 'performer' | 'avatar' | 'motion'; joints: JointWords[];
  skin: SkinWords | null; offset_m: Vector; estimate: boolean;
}

export interface CameraWords {
  name: string; width_px: number; height_px: number; fx: number; fy: number; cx: number;
  cy: number; world_from_camera: Placement; rms_px: number | null;
}

export interface ConstraintWords {
  id: string; skeleton: number; kind: 'position' | 'distance' | 'box' | 'orientation' | 'support';
  active: boolean; p_in_world: Vector; draggable: boolean;
  /** Joint of its skeleton that it follows frame by frame; p_in_world is then unused. */
  joint?: number;
}

/** First and last frame, both included, in the recording's numbering, which starts at
 *  `first_frame`. */
export type Gap = [number, number, 'repaired' | 'inferred'];

export interface TrackWords {name: string; gaps: Gap[]}

export interface ContactWords {name: string; spans: [number, number][]}

export interface GraphWords {
  name: string; unit: string;
  values: (number | null)[];
}

/** Spans and notes use the recording's frame numbers, from `first_frame` on. */
export interface FileWords {
  frames: number; first_frame: number; block: string | null; points_block: string | null;
  tracks: TrackWords[]; contacts: ContactWords[]; graphs: GraphWords[];
  notes: {frame: number; text: string}[];
  /** Name of this trial in `trials`, or empty; a page may request another. */
  trial?: string;
  trials?: string[];
  /** Path of the report; empty: none. */
  report?: string;
}

export interface SceneWords {
  type: 'scene'; version: number; revision: number; title: string; mode: 'live' | 'file' | 'edit';
  rate_hz: number; skeletons: SkeletonWords[]; cameras: CameraWords[];
  points: {labels: string[]} | null; floor: {height_m: number} | null;
  constraints: ConstraintWords[]; file: FileWords | null; wizard: WizardWords | null;
  /** A scene of marey stage: its targets are the constraints, and `run` messages follow. */
  run?: boolean;
}

export interface StatusWords {
  type: 'status'; clock_s: number;
  subject: 'waiting' | 'tracked' | 'partly' | 'behind' | 'stopped' | 'lost';
  /** Faults of the subject's tracking. */
  warnings: string[];
  frame: number; rate_hz: number; latency_ms: {p50: number; p95: number} | null;
  stages: {name: string; p50_ms: number; p95_ms: number}[]; overload: string;
  cameras: {name: string; state: 'streaming' | 'silent' | 'lost'; frames: number; dropped: number;
    tags: number; detail: string}[];
  outputs: {name: string; sent: number; failed: number; detail: string}[];
  recording: {file: string; seconds: number; trouble: string} | null; clients: number;
  messages: string[];
}

export type WizardStep = 'idle' | 'stand' | 'move' | 'solve' | 'done' | 'failed';

export interface WizardWords {
  type: 'wizard'; step: WizardStep; title: string; text: string; progress: number;
  cameras: {name: string; coverage: number; grid: number[]; rms_px: number | null}[];
  quality: {name: string; value: string; good: boolean}[]; error: string;
}

export type ServerWords =
  | SceneWords
  | StatusWords
  | WizardWords
  | {type: 'constraints'; constraints: ConstraintWords[]}
  | RunWords
  | TargetsWords
  | EditWords
  | EditErrorWords
  | LibraryServerWords;

export type DragPhase = 'begin' | 'move' | 'end';
export type WizardAction = 'start' | 'next' | 'cancel' | 'accept';

export type PageWords =
  | {type: 'hello'; version: number}
  | {type: 'shown'; sent_s: number}
  | {type: 'drag'; id: string; p_in_world: Vector; phase: DragPhase; frame?: number}
  | {type: 'constraint'; id: string; active: boolean}
  | {type: 'wizard'; action: WizardAction}
  | {type: 'record'; on: boolean}
  | {type: 'thumbnails'; on: boolean}
  | {type: 'trial'; name: string}
  | {type: 'run'; action: RunAction}
  | EditPageWords
  | LibraryPageWords;

/** Parses a text of the server, or returns its error. Only the outline is checked: the
 *  server is marey, and another version is reported. */
export function readServerWords(text: string): ServerWords | {type: 'bad'; why: string} {
  let words: unknown;
  try {
    words = JSON.parse(text);
  } catch {
    return {type: 'bad', why: 'a message is not JSON'};
  }
  if (typeof words !== 'object' || words === null || !('type' in words)) {
    return {type: 'bad', why: 'a message has no type'};
  }
  const {type} = words;
  if (type === 'scene') return readScene(words as SceneWords);
  if (type === 'status' || type === 'wizard' || type === 'constraints' || type === 'error' ||
    RUN_TYPES.includes(String(type)) || EDIT_TYPES.includes(String(type)) || LIBRARY_TYPES.includes(String(type))) {
    return words as ServerWords;
  }
  return {type: 'bad', why: `a message has the unknown type ${String(type)}`};
}

function readScene(scene: SceneWords): ServerWords | {type: 'bad'; why: string} {
  if (scene.version !== PROTOCOL_VERSION) {
    return {type: 'bad', why: `marey uses version ${scene.version} of the page's protocol, ` +
      `this page version ${PROTOCOL_VERSION}: reload the page`};
  }
  for (const skeleton of scene.skeletons) {
    // Poses are computed in one pass, so parents must come first.
    const orphan = skeleton.joints.findIndex((joint, i) => joint.parent >= i);
    if (orphan >= 0) {
      return {type: 'bad', why: `${skeleton.name}: joint ${orphan} comes before its parent`};
    }
  }
  return scene;
}
