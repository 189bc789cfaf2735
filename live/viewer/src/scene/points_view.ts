// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Labelled points: dots in the colour of their source.

import {BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Points, PointsMaterial} from
  'three';
import type {PointBlock} from '../protocol/decode_blocks';
import {SOURCES} from '../protocol/protocol';
import type {Theme} from '../base/theme';

export class PointsView {
  readonly object: Points<BufferGeometry, PointsMaterial>;
  readonly labels: readonly string[];
  /** x y z of every point; NaN: absent. */
  readonly p_in_world: Float32Array;
  private readonly source: Uint8Array;
  private readonly drawn: BufferAttribute;
  private readonly tints: BufferAttribute;
  private readonly colours = [new Color(), new Color(), new Color()];

  constructor(labels: readonly string[]) {
    const count = labels.length;
    this.labels = labels;
    this.p_in_world = new Float32Array(3 * count).fill(NaN);
    this.source = new Uint8Array(count);
    this.drawn = new BufferAttribute(new Float32Array(3 * count), 3).setUsage(DynamicDrawUsage);
    this.tints = new BufferAttribute(new Float32Array(3 * count), 3).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.drawn);
    geometry.setAttribute('color', this.tints);
    this.object = new Points(geometry, new PointsMaterial({size: 6, sizeAttenuation: false,
      vertexColors: true}));
    this.object.frustumCulled = false;
  }

  /** Returns x and z of the centre of the visible points; null if there are none. */
  middle(): [number, number] | null {
    const {p_in_world: p} = this;
    let [x, z, count] = [0, 0, 0];
    for (let i = 0; i < p.length; i += 3) {
      if (Number.isNaN(p[i])) continue;
      x += p[i];
      z += p[i + 2];
      ++count;
    }
    return count > 0 ? [x / count, z / count] : null;
  }

  paint(theme: Theme): void {
    SOURCES.forEach((source, i) => this.colours[i].setStyle(theme.colour(source)));
  }

  update(block: PointBlock, frame: number): void {
    const {p_in_world: p} = this;
    block.read(frame, p, this.source);
    let count = 0;
    for (let i = 0; i < this.labels.length; ++i) {
      if (Number.isNaN(p[3 * i])) continue;
      this.drawn.setXYZ(count, p[3 * i], p[3 * i + 1], p[3 * i + 2]);
      const {r, g, b} = this.colours[this.source[i]];
      this.tints.setXYZ(count++, r, g, b);
    }
    this.object.geometry.setDrawRange(0, count);
    this.drawn.needsUpdate = true;
    this.tints.needsUpdate = true;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}
