// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks decoded frames of VMC, independently of the decoder. Messages are objects
// { address, args }.
const REQUIRED = [
  'Hips', 'Spine', 'Head',
  ...['Left', 'Right'].flatMap((side) =>
    ['UpperLeg', 'LowerLeg', 'Foot', 'UpperArm', 'LowerArm', 'Hand'].map((b) => side + b)),
];

/// Follows the frames of one sender. Throws at the first incorrect message.
export class FrameJudge {
  frames = 0;
  bones = 0;
  #last = -1;

  take(messages) {
    const names = new Set();
    for (const { address, args } of messages) {
      if (address === '/VMC/Ext/T') this.#takeTime(args[0]);
      if (address !== '/VMC/Ext/Bone/Pos') continue;
      names.add(args[0]);
      this.#takeTransform(args);
    }
    for (const name of REQUIRED) {
      if (!names.has(name)) throw new Error(`frame ${this.frames} lacks ${name}`);
    }
    if (messages[0].address !== '/VMC/Ext/OK') throw new Error('OK is not the first');
    if (names.size !== 22) throw new Error(`frame ${this.frames} has ${names.size} bones`);
    ++this.frames;
  }

  #takeTime(time) {
    if (!(time > this.#last)) throw new Error(`T is ${time} after ${this.#last}`);
    this.#last = time;
  }

  #takeTransform([name, ...numbers]) {
    if (numbers.length !== 7 || !numbers.every(Number.isFinite)) {
      throw new Error(`${name} is at ${numbers}`);
    }
    const length = Math.hypot(...numbers.slice(3));
    if (Math.abs(length - 1) > 1e-5) throw new Error(`${name} turns by |q| = ${length}`);
    ++this.bones;
  }

  verdict(reader, count) {
    console.log(`${reader}: ${this.frames} of ${count} bundles, ${this.bones} bones`);
    return this.frames === count && this.bones === 22 * count ? 0 : 1;
  }
}
