// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Data of the reports, as app/pages/ and app/markers/ write them (docs/formats/report.md).

import type {Vector} from '../protocol/protocol';

export interface ReportCamera {
  name: string; width_px: number; height_px: number;
  focal_px: [number, number]; focal_sigma_px: number; centre_px: [number, number];
  centre_in_world_m: Vector; centre_sigma_mm: number;
  right_in_world: Vector; down_in_world: Vector; forward_in_world: Vector;
  rms_px: number; p95_px: number; coverage_percent: number; views: number;
}

// --- Report of a session ---

interface Worst {trial: string; name: string | number; value: number}
interface Bridged {bridged_as: 'repaired' | 'inferred'}
export interface GapFigures extends Bridged {
  segment: string; first_frame: number; last_frame: number; duration_s: number;
}
export interface JointFigures {
  joint: string; median_sigma_mm: number; p95_sigma_mm: number;
  measured_percent: number; repaired_percent: number; inferred_percent: number;
}
export interface AvatarFigures {
  name: string; files: string[];
  slide_before_cm_per_s?: number; slide_after_cm_per_s?: number; penetration_mm?: number;
}
export interface TrialFigures {
  name: string; rate_hz: number; first_frame: number; frames: number; frames_solved: number;
  rms_px: number; joint_sigma_median_mm: number; files: string[]; gaps: GapFigures[];
  cameras: {name: string; rms_px: number; median_px: number; corners: number; offset_ms: number;
    clock: string}[];
  joints: JointFigures[]; avatars: AvatarFigures[];
}
export interface Summary {
  trials: number; frames: number; frames_solved: number; solved_percent: number;
  calibration_rms_px: number; solve_rms_px: number; joint_sigma_median_mm: number;
  worst: Record<'camera' | 'tag' | 'frame' | 'joint', Worst | null>; poor: string[];
  recorded_s: number; processing_s: number; times_real_time: number;
}
export interface SubjectFigures {
  name: string; stature_m: number; mass_kg: number | null; rms_px: number; limb_ratio: number;
  bones: {from: string; to: string; length_mm: number; sigma_mm: number}[];
  tags: {id: number; segment: string; size_mm: number; sigma_mm: number; sigma_deg: number;
    sightings: number}[];
  unplaced_tags: number[];
}
export interface CalibrationFigures {rms_px: number; cameras: ReportCamera[]}
export interface ReportFigures {
  session: string; marey_version: string; summary: Summary; warnings: string[];
  trials: TrialFigures[]; calibration: CalibrationFigures; subject: SubjectFigures | null;
  timings: {stage: string; seconds: number}[];
}
/** Arrays are base64 of little-endian numbers (app/pages/report_body.h). */
export interface BodyData {
  name: string; frames: number; joints: number;
  points: {name: string; parent: number; bone: string | null}[];
  unit_m: number; origin_m: Vector; xyz: string; turns: string; source?: string; sigma?: string;
}
export interface Picture {
  camera: string; frame: number; width_px: number; height_px: number; jpeg: string;
  bones: [number, number, number, number, number][];
  tags: {id: number; corners: [number, number][]}[];
}
export interface TrialData {
  frame_rms_px: number[]; pictures: Picture[]; bodies: BodyData[];
  tags: {id: number; segment: string; cameras: string}[];
}
export interface ReportData {figures: ReportFigures; trials: TrialData[]; calibration_page: boolean}

// --- Report of a calibration ---

export interface CalibratedCamera extends ReportCamera {
  lens: string; inlier_rms_px: number; corners: number; outlier_corners: number;
  coverage_columns: number; coverage_corners: number[]; centre_covariance_mm2: number[][];
  clock_lag: {lag_ms: number; sigma_ms: number; explained_px: number} | null;
  parameters: {name: string; value: number; sigma: number; unit: string}[];
}
export interface Finding {
  severity: 'poor' | 'fair' | 'note'; where: string; cause: string; next: string;
}
export interface MapHeight {
  height: string; height_m: number; seen_percent: number;
  median_error_mm: number | null; p95_error_mm: number | null; error_mm: (number | null)[][];
}
export interface ErrorMap {x_from_m: number; z_from_m: number; step_m: number; heights: MapHeight[]}
export interface RigFigures {
  session: string; marey_version: string; target: string; verdict: 'good' | 'fair' | 'poor';
  findings: Finding[]; middle_error_mm: number | null; middle_in_world_m: Vector;
  limits: {error_mm: number[]; residual_px: number[]; coverage_percent: number[];
    shared_instants: number};
  distance_m: number; has_floor: boolean; board_on_floor: boolean; inlier_rms_px: number;
  sigma_factor: number; sightings: number; outliers: number; warp_mm: Vector | null;
  shared_views: number[][]; cameras: CalibratedCamera[]; error_map: ErrorMap;
  cross_validation: {seen_rms_px: number; held_out_rms_px: number; cameras: {name: string;
    centre_apart_mm: number; turn_apart_deg: number; focal_apart_px: number;
    held_out_median_px: number | null}[]} | null;
  outlier_frames: {camera: string; frame: number | null; left_out: number; of: number;
    median_error_px: number}[];
}
export interface SeenCorners {
  /** x, y, error x, error y [px]. */
  arrows: [number, number, number, number][]; strays: [number, number, number, number][];
  /** Tilt, azimuth [deg], distance [m]. */
  tilts: [number, number, number][];
}
export interface RigData {
  figures: RigFigures; cameras: SeenCorners[]; places: Vector[][]; floor_places: Vector[][];
}

// --- Report of labelled markers ---

export type Fate = 'measured' | 'swapped' | 'cluster' | 'structure' | 'spline' | 'predicted' |
  'left-empty';
/** First frame, count, fate, median and worst sigma [mm], markers it was filled from. */
export type FateRun = [number, number, number, number?, number?, number[]?];
/** First frame, count, kind, distance [mm], marker it was exchanged with. */
export type Fault = [number, number, string, number, number?];
export interface MarkerFates {label: string; counts: number[]; runs: FateRun[]; faults: Fault[]}
export interface MarkerCurve {
  marker: number; first: number; frames: number; at: number[]; fates: number[]; removed: number[];
  read_mm: (number | null)[][]; after_mm: (number | null)[][]; sigma_mm: (number | null)[];
}
export interface Still {
  frame: number; is_worst: boolean; rms_mm: number; facing: [number, number];
  joints_mm: Vector[]; sources: number[];
  /** Marker, fate, place, place on the body, distance [mm]. */
  markers: [number, number, Vector, (Vector | null)?, number?][];
}
export interface MarkerTrial {
  first_frame: number; markers: MarkerFates[]; curves: MarkerCurve[]; stills: Still[];
  residuals: {step: number; rms_mm: (number | null)[]; worst_mm: (number | null)[]} | null;
  notes: string[];
}
export interface MarkerTrialFigures {
  trial?: string; file: string; frames: number; rate_hz: number; frames_solved: number;
  frames_with_markers: number; rms_mm: number | null;
  by_marker: {marker: string; rms_mm: number; worst_mm: number; frames: number}[];
}
export interface Label {
  label: string; landmark: string | null; samples: number; use: string; why?: string;
  segment?: string | null; sigma_mm?: number; stray_mm?: number;
}
export interface MarkersData {
  kind: 'fit' | 'repair'; marey_version: string; fates: Fate[]; trials: MarkerTrial[];
  figures: {subject: string; stature_m: number; label_set: string; prefix: string;
    fit_rms_mm?: number; labels: Label[]; trials: MarkerTrialFigures[]; warnings: string[];
    joints: {joint: string; origin: string; sigma_mm: number; range_deg: number | null}[]};
  lengths: {joint: string; from: string; length_mm: number; sigma_mm: number}[];
  /** From joint, to joint, index into a still's sources. */
  bones: [number, number, number][];
}

