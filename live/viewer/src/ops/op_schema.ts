// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The operations of a recipe and their keys, as in docs/formats/edit_recipe.md. A test compares
// both.

import {choice, LIMITS, number, plain, points, rows, table, text, vector} from './op_fields';
import type {Field} from './op_fields';

export interface OpSchema {
  name: string;
  title: string;
  /** Its effect, in a line. */
  help: string;
  fields: readonly Field[];
  /** Keys of all operations that it can use, besides `off` and `why`. */
  common: readonly ('span' | 'groups' | 'blend')[];
  /** The span is its main key. */
  isOfSpan?: boolean;
}

export const GROUPS: readonly string[] = ['root', 'trunk', 'head', 'left_arm', 'right_arm',
  'left_leg', 'right_leg'];

export const BONES: readonly string[] = ['hips', 'spine', 'chest', 'upperChest', 'neck', 'head',
  'leftShoulder', 'leftUpperArm', 'leftLowerArm', 'leftHand', 'rightShoulder', 'rightUpperArm',
  'rightLowerArm', 'rightHand', 'leftUpperLeg', 'leftLowerLeg', 'leftFoot', 'leftToes',
  'rightUpperLeg', 'rightLowerLeg', 'rightFoot', 'rightToes'];

const need = {required: true};

/** Keys of all operations. */
export const COMMON: readonly Field[] = [
  plain('instant', 'from', 'From', {absent: 'the whole motion', help: 'Start of the span'}),
  plain('instant', 'to', 'To', {absent: 'the whole motion', help: 'End of the span'}),
  plain('groups', 'groups', 'Parts of the body', {absent: 'the whole body'}),
  number('blend_s', 'Fade', LIMITS.fade, {default: 0, help: 'Fade before and after the span'}),
  text('why', 'Why', {help: 'A remark for readers of the recipe'}),
];

const at = (label: string, rest = {}): Field => plain('instant', 'at', label, rest);

const bone = choice('bone', 'Bone', BONES, need);
const rotation = plain('rotation', 'rotation', 'Rotation',
  {help: 'Added to the bone, in the frame of its parent'});

const TIME: OpSchema[] = [
  {name: 'cut', title: 'Cut', help: 'Keeps the span and removes the rest', fields: [],
    common: ['span'], isOfSpan: true},
  {name: 'keep', title: 'Keep parts', help: 'Keeps several spans as motions of their own',
    fields: [rows('spans', 'Spans', 'span',
      [plain('instant', 'from', 'From', {absent: 'start'}),
        plain('instant', 'to', 'To', {absent: 'end'})], need)], common: []},
  {name: 'split', title: 'Split', help: 'Divides the motion into motions of their own',
    fields: [rows('instants', 'Instants', 'instant', [at('At', need)], need)], common: []},
  {name: 'retime', title: 'Retime', help: 'Changes speed, duration or frame rate', fields: [
    rows('knots', 'Knots', 'knot', [at('Instant', need),
      number('time_s', 'Time in the result', LIMITS.time, need)],
    {help: 'Each instant is at the given time in the result'}),
    number('speed', 'Speed', LIMITS.speed, {help: '2 is twice as fast'}),
    number('duration_s', 'Duration', LIMITS.duration, {help: 'Duration of the result'}),
    number('rate_hz', 'Frame rate', LIMITS.rate,
      {absent: 'as before', help: 'Frames per second of the result'}),
  ], common: []},
  {name: 'scale_time', title: 'Scale time', help: 'Changes the speed by a constant factor',
    fields: [number('speed', 'Speed', LIMITS.speed, {...need, help: '2 is twice as fast'})],
    common: []},
];

const SHAPE: OpSchema[] = [
  {name: 'filter', title: 'Filter', help: 'Removes noise', fields: [
    choice('method', 'Method', ['gcv', 'butterworth'], {default: 'gcv',
      help: 'Smoothing spline with cross-validation, or a low-pass filter without phase'}),
    choice('order', 'Order', [2, 3], {default: 2, help: '2: cubic spline, 3: quintic spline'}),
    choice('cutoff', 'Cut-off rule', ['winter', 'yu', 'given'], {default: 'winter'}),
    number('cutoff_hz', 'Cut-off', LIMITS.frequency),
    plain('boolean', 'keep_contacts', 'Standing feet stay in place', {default: true}),
  ], common: ['span', 'groups', 'blend']},
  {name: 'exaggerate', title: 'Exaggerate',
    help: 'Amplifies the movement between two frequencies', fields: [
      number('gain', 'Gain', LIMITS.gain, {default: 1.5,
        help: '1: unchanged, above: more movement, below: less'}),
      number('low_hz', 'Lowest frequency', LIMITS.band, {default: 0}),
      number('high_hz', 'Highest frequency', LIMITS.band,
        {default: 0, absent: 'no limit', help: '0: no limit'}),
    ], common: ['span', 'groups', 'blend']},
  {name: 'pose', title: 'Pose key', help: 'Displaces a bone around one instant', fields: [
    at('At', need), bone, rotation,
    vector('moved_m', 'Moved by', 'xyz',
      {help: 'Displacement of a hand, a foot or the hips in the world'}),
    number('width_s', 'Width', LIMITS.duration,
      {default: 0.5, help: 'Fade before and after the instant'}),
  ], common: []},
  {name: 'offset', title: 'Offset', help: 'Adds a constant rotation or displacement', fields: [
    bone, rotation, vector('moved_m', 'Moved by', 'xyz',
      {help: 'Displacement of a hand, a foot or the hips'}),
  ], common: ['span', 'blend']},
  {name: 'jump', title: 'Jump', help: 'Makes one jump higher, longer or different', fields: [
    number('jump', 'Number of the jump', LIMITS.jump, {default: 1, help: 'Within the span'}),
    number('apex_by_m', 'Higher by', LIMITS.rise,
      {default: 0, help: 'Added to the highest point of the centre of mass'}),
    number('apex_m', 'Highest point', LIMITS.apex, {absent: 'as captured',
      help: 'Height of the centre of mass above the floor of the take-off'}),
    number('airtime_s', 'Time in the air', LIMITS.flight, {absent: 'as captured'}),
    number('length_m', 'Length', LIMITS.distance, {absent: 'by the captured horizontal velocity',
      help: 'Distance of the feet between take-off and landing'}),
    number('box_m', 'Onto a box', LIMITS.box, {absent: 'as captured',
      help: 'Height of the floor of the landing above that of the take-off'}),
    vector('land_m', 'Landing', 'xyz', {absent: 'by the captured horizontal velocity',
      help: 'Place of the feet, in the world'}),
    number('push_s', 'Duration of the push', LIMITS.push, {absent: 'as captured'}),
    plain('instant', 'push_start', 'Start of the push', {absent: 'detected'}),
    choice('law', 'Law', ['force', 'thesis'], {default: 'force', help: 'Force: the captured ' +
      'push with the smallest correction. Thesis: a polynomial of degree 7'}),
    table('lowest', 'Lowest point', [
      number('at', 'Share of the push', LIMITS.share, need),
      number('height_m', 'Height', LIMITS.place, need)], {at: 0.6, height_m: 0.7},
    {absent: 'as captured', help: 'Lowest point of the centre of mass during the push'}),
    number('strength_g', 'Largest push', LIMITS.strength,
      {absent: '1.3 times the captured peak, at least 2.5'}),
    number('gravity_m_s2', 'Gravity', LIMITS.gravity, {default: 9.81}),
    plain('boolean', 'ballistic', 'The captured flight becomes a parabola', {default: false}),
    plain('boolean', 'keep_momentum', 'Constant angular momentum in flight', {default: true}),
  ], common: ['span']},
  {name: 'mirror', title: 'Mirror', help: 'Exchanges left and right', fields: [], common: []},
];

const PLACE: OpSchema[] = [
  {name: 'place', title: 'Place', help: 'Moves and turns the whole motion on the floor',
    fields: [vector('position_xz_m', 'Position', 'xz', {help: 'Position of the root'}),
      number('heading_deg', 'Heading', LIMITS.turn,
        {help: 'Direction of travel: 0 is +Z, 90 is +X'}),
      at('At', {absent: 'first frame'})], common: ['span']},
  {name: 'path', title: 'Path', help: 'Bends the path of the root, with its footprints',
    fields: [points('points_xz_m', 'Points', 'xz'),
      number('turn_deg', 'Turn', LIMITS.turn,
        {default: 0, help: 'The end turns against the start, positive to the left'}),
      number('length', 'Length', LIMITS.factor, {default: 1, help: 'Factor of the length'}),
      plain('boolean', 'straight', 'Remove the turn first', {default: false})],
    common: ['span']},
  {name: 'level', title: 'Level', help: 'Makes the floor under the feet level', fields: [
    plain('boolean', 'tilt', 'Rotate the motion', {default: true,
      help: 'Off: the motion is moved only'}),
    number('floor_height_m', 'Height of the floor', LIMITS.place, {default: 0}),
  ], common: ['span']},
];

const JOIN: OpSchema[] = [
  {name: 'splice', title: 'Splice', help: 'Joins another source to the end', fields: [
    {...choice('source', 'Source', [], need), supply: 'sources'},
    at('Leave at', {absent: 'best frame'}),
    plain('instant', 'enter_at', 'Enter at', {absent: 'best frame'}),
    number('overlap_s', 'Overlap', LIMITS.fade, {absent: 'chosen',
      help: '0: both are displaced towards each other'}),
    plain('boolean', 'align', 'Turn and move the source so that it fits', {default: true}),
  ], common: ['span', 'blend']},
  {name: 'cyclify', title: 'Loop', help: 'Makes a loop of the best cycle', fields: [
    number('min_period_s', 'Shortest cycle', LIMITS.duration, {absent: 'detected'}),
    number('max_period_s', 'Longest cycle', LIMITS.duration, {absent: 'detected'}),
    plain('instant', 'cycle_from', 'Cycle from', {absent: 'best pair'}),
    plain('instant', 'cycle_to', 'Cycle to', {absent: 'best pair'}),
    choice('drift', 'Travel', ['straight', 'keep', 'none'], {default: 'straight',
      help: 'Straight: without its turn. Keep: with its turn. None: in place'}),
    number('cycles', 'Copies', LIMITS.cycles, {default: 1}),
    plain('boolean', 'force', 'Accept a motion that is not cyclic', {default: false}),
  ], common: ['span']},
];

const CONTACT: OpSchema[] = [
  {name: 'contacts', title: 'Contacts', help: 'Detects foot contacts again, or changes them',
    fields: [plain('boolean', 'detect', 'Detect again', {default: false}),
      rows('edits', 'Changes by hand', 'change', [
        choice('do', 'Change', ['set', 'clear', 'move_start', 'move_end'], need),
        choice('foot', 'Foot', ['left', 'right'], need),
        choice('part', 'Part', ['heel', 'ball'], need),
        number('from_s', 'From', LIMITS.time, need), number('to_s', 'To', LIMITS.time, need),
      ])], common: []},
  {name: 'plant', title: 'Plant feet', help: 'Makes the feet stand still during contacts',
    fields: [], common: ['span', 'blend']},
  {name: 'constrain', title: 'Constrain', help: 'Adds constraints, or adapts the motion to them',
    fields: [
      choice('detect', 'Detect', ['supports', 'touches'],
        {help: 'Adds the constraints that the motion shows'}),
      rows('objects', 'Objects', 'box', [text('name', 'Name', need),
        vector('min_m', 'Lower corner', 'xyz', need),
        vector('max_m', 'Upper corner', 'xyz', need)], {help: 'Boxes that hands can touch'}),
      {...plain('boolean', 'constraint', 'Constraint'), kind: 'constraint'},
      rows('changes', 'Changes by hand', 'change', [text('name', 'Name', need),
        plain('instant', 'start', 'Start'), plain('instant', 'stop', 'Stop'),
        number('start_duration_s', 'Fade-in', LIMITS.time),
        number('stop_duration_s', 'Fade-out', LIMITS.time),
        vector('position_m', 'Position', 'xyz')]),
      plain('boolean', 'adapt', 'Adapt the motion now', {default: false}),
    ], common: ['span', 'blend']},
  {name: 'balance', title: 'Balance', help: 'Keeps the centre of mass over the feet', fields: [
    choice('mode', 'Mode', ['horizontal', 'zmp'], {default: 'horizontal', help: 'Horizontal: the ' +
      'centre of mass of a standing body. Zmp: the zero moment point of the whole motion'})],
  common: ['span', 'blend']},
];

const NOTES: OpSchema[] = [
  {name: 'tag', title: 'Tag', help: 'Adds an annotation over the span',
    fields: [text('text', 'Text', need)], common: ['span'], isOfSpan: true},
  {name: 'event', title: 'Event', help: 'Adds an annotation at an instant',
    fields: [text('text', 'Text', need), at('At', need)], common: []},
  {name: 'curve', title: 'Curve', help: 'Adds a number per frame, linear between keys', fields: [
    text('name', 'Name', need),
    rows('keys', 'Keys', 'key', [at('At', need), number('value', 'Value', LIMITS.value, need)],
      need)], common: []},
];

const OUTPUT: OpSchema[] = [
  {name: 'retarget', title: 'Retarget', help: 'Puts the motion on an avatar; comes last',
    fields: [{...choice('avatar', 'Avatar', [], need), supply: 'avatars'},
      plain('boolean', 'keep_world', 'Keep metres of the path', {default: false})], common: []},
];

/** Sections of the menu that adds an operation. */
export const OP_MENU: readonly (readonly [string, readonly OpSchema[]])[] = [
  ['Time', TIME], ['Shape', SHAPE], ['Place', PLACE], ['Join', JOIN], ['Contact', CONTACT],
  ['Notes', NOTES], ['Output', OUTPUT],
];

/** All operations. */
export const OPS: readonly OpSchema[] = OP_MENU.flatMap(([, ops]) => ops);

const BY_NAME = new Map(OPS.map((op) => [op.name, op]));

/** Returns the table of cut@1 and the like. An unknown operation has a table without keys. */
export function schemaOf(op: {do: string}): OpSchema {
  const name = op.do.split('@')[0];
  return BY_NAME.get(name) ??
    {name, title: name, help: 'This page does not know the operation', fields: [], common: []};
}

/** Returns the common keys that the operation can use, in their order. */
export function commonFields(op: OpSchema): Field[] {
  return COMMON.filter(({key}) => key === 'why' ||
    (op.common.includes('span') && (key === 'from' || key === 'to')) ||
    (op.common.includes('groups') && key === 'groups') ||
    (op.common.includes('blend') && key === 'blend_s'));
}
