// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Messages of the mock: scenes, states, steps of a calibration.

import {JOINTS, sourceAt} from './walker.mjs';

/** Number of the first frame of the mock's recording. */
export const FIRST = 100;

/** Cameras in front, aside and behind, all looking at the middle. */
const CAMERAS = [['left', 2.2, 2.4], ['right', -2.2, 2.4], ['back', 0.3, -3]].map(
  ([name, x, z]) => {
    const yaw = Math.atan2(-x, -z);
    // Camera: x right, y down, z forward: half a turn about z after turning to the middle.
    return {name, width_px: 1280, height_px: 720, fx: 900, fy: 900, cx: 639.5, cy: 359.5,
      world_from_camera: {p: [x, 1.5, z], q: [Math.sin(yaw / 2), 0, Math.cos(yaw / 2), 0]},
      rms_px: 0.31};
  });

const skeleton = (name, kind, offset_m, skin) => ({name, kind, joints: JOINTS, skin, offset_m,
  estimate: kind !== 'avatar'});

function bodies(kind, avatar) {
  const performer = skeleton('performer', kind, [0, 0, 0], null);
  if (!avatar) return [performer];
  const words = avatar.words ?? {format: 'glb', nodes: JOINTS.map(({name}) => name),
    node_index: JOINTS.map((_, i) => i + 1), unit_from_m: 1,
    scene_from_file: [0, 0, 0, 1]};
  const dressed = skeleton('mannequin', 'avatar', [1.2, 0, 0], {media: '/media/1', ...words});
  if (avatar.rest) {
    dressed.joints = JOINTS.map((joint, i) => ({...joint, rest: avatar.rest[i]}));
  }
  return [performer, dressed];
}

const constraint = (id, kind, p_in_world, active = true) =>
  ({id, skeleton: 0, kind, active, p_in_world, draggable: true});

const common = (mode, rate_hz, avatar) => ({
  type: 'scene', version: 1, revision: 1, mode, rate_hz,
  skeletons: bodies(mode === 'live' ? 'performer' : 'motion', avatar),
  cameras: CAMERAS, points: null, floor: {height_m: 0},
  constraints: [constraint('left hand', 'position', [0.42, 0.95, 0.2]),
    constraint('right hand', 'position', [-0.42, 0.95, 0.2]),
    constraint('left foot', 'support', [0.1, 0.02, 0.05]),
    constraint('gaze', 'orientation', [0, 1.7, 0.4], false)],
  wizard: null,
});

export function liveScene(rate_hz, avatar) {
  return {...common('live', rate_hz, avatar), title: 'studio', file: null};
}

/** A scene of marey stage: bodies in rows of eight, two targets in front of them. */
export function stageScene(rate_hz, count) {
  return {...common('live', rate_hz, false), title: 'forty', run: true, file: null, cameras: [],
    skeletons: Array.from({length: count}, (_, i) =>
      skeleton(`crowd.${i + 1}`, 'avatar', [1.2 * (i % 8), 0, -1.5 * Math.floor(i / 8)], null)),
    constraints: targetsAt(0, {}).p_in_world.map((p, i) =>
      ({...constraint(['left', 'right'][i], 'position', p, false), draggable: i === 0}))};
}

/** Places of the targets; `held`: places by index of the held ones. */
export function targetsAt(time_s, held) {
  return {type: 'targets', held: [0, 1].map((i) => i in held), p_in_world: [0, 1].map((i) =>
    held[i] ?? [4.5 - i + 0.1 * Math.sin(time_s), 1.2, 0.6])};
}

export function runAt(state, time_s) {
  return {type: 'run', state, time_s, duration_s: 60, messages: [], figures: [
    {name: 'wrist_error', unit: 'mm', value: 0.4, bound: '≤ 1', passed: true},
    {name: 'feet_slide', unit: 'mm', value: null, bound: '≤ 0.1', passed: null}]};
}

export function fileScene(rate_hz, frames, avatar) {
  const tracks = JOINTS.filter(({bone}) => bone).map(({name}) => {
    const joint = JOINTS.findIndex((other) => other.name === name);
    const gaps = [];
    for (let i = 0; i < frames; ++i) {
      const source = ['', 'repaired', 'inferred'][sourceAt(joint, i + FIRST)];
      const last = gaps[gaps.length - 1];
      if (source && last && last[1] === i - 1 && last[2] === source) last[1] = i;
      else if (source) gaps.push([i, i, source]);
    }
    return {name, gaps: gaps.map(([a, b, source]) => [a + FIRST, b + FIRST, source])};
  });
  const spans = (shift) => Array.from({length: Math.ceil(frames / 33)}, (_, i) =>
    [33 * i + shift + FIRST, Math.min(33 * i + shift + 18, frames - 1) + FIRST]);
  return {...common('file', rate_hz, avatar), title: 'walk', file: {frames, first_frame: FIRST,
    block: '/media/2', points_block: null, tracks,
    contacts: [{name: 'left heel', spans: spans(0)}, {name: 'right heel', spans: spans(16)}],
    graphs: [{name: 'reprojection', unit: 'px', values: Array.from({length: frames}, (_, i) =>
      (i % 97 === 0 ? null : 0.3 + 0.12 * Math.sin(i / 9) + (i % 120 < 25 ? 0.4 : 0)))}],
    notes: [{frame: 60 + FIRST, text: 'arm behind the back'}]}};
}

export function statusAt({frame, rate_hz, recording, recordingTrouble, pages}) {
  const stage = (name, p50_ms, p95_ms) => ({name, p50_ms, p95_ms});
  return {type: 'status', clock_s: frame / rate_hz, subject: 'tracked', warnings: [], frame, rate_hz: 29.9,
    latency_ms: {p50: 21.4, p95: 29.8},
    stages: [stage('detect left', 7.2, 9.9), stage('detect right', 7, 9.6),
      stage('track pose', 1.6, 2.3), stage('adapt', 0.2, 0.3), stage('send', 0.1, 0.2)],
    overload: 'none', cameras: CAMERAS.map(({name}, i) => ({name, state: i === 2 ? 'silent'
      : 'streaming', frames: frame, dropped: 2 * i, tags: 5 - i, detail: i === 2
      ? 'no frame for 0.4 s' : ''})),
    outputs: [{name: 'VMC 127.0.0.1:39539', sent: 3 * frame, failed: 0, detail: ''}],
    recording: recording === null ? null : {file: 'take-003', seconds:
      (performance.now() - recording) / 1000, trouble: recordingTrouble},
    clients: pages.size, messages: frame > 60 ? ['camera back: no frame for 0.4 s'] : []};
}

const STEPS = {
  idle: ['Not calibrated here', 'Finds where the tags sit on the body.', 0],
  stand: ['Stand still', 'Feet apart, arms a little away from the body, for three seconds.', 0.4],
  move: ['Move every joint', 'Bend elbows and knees, turn wrists, lean to all sides.', 0.7],
  done: ['Done', 'Accept it, or cancel to keep the earlier one.', 1],
};

export function wizardAt(step) {
  const [title, text, progress] = STEPS[step];
  const seen = step === 'move' || step === 'done';
  const grid = (k) => Array.from({length: 48}, (_, i) =>
    Math.max(0, 1 - Math.hypot(i % 8 - 3.5 - k, Math.floor(i / 8) - 2.5) / 4));
  return {type: 'wizard', step, title, text, progress,
    cameras: seen ? CAMERAS.map(({name}, k) => ({name, coverage: 0.7 - 0.2 * k, grid: grid(k),
      rms_px: step === 'done' ? 0.3 + 0.1 * k : null})) : [],
    quality: step === 'done' ? [{name: 'left forearm', value: '24.1 cm ± 0.3', good: true},
      {name: 'right shin', value: '40.9 cm ± 2.8', good: false}] : [],
    error: ''};
}
