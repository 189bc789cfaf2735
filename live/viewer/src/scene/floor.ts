// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The floor: a grid of metres that fades with distance.

import {
  BufferGeometry, Color, Float32BufferAttribute, LineBasicMaterial, LineSegments, Mesh,
  PlaneGeometry, ShaderMaterial,
} from 'three';
import type {Object3D} from 'three';
import type {Theme} from '../base/theme';

const REACH_M = 16;

const VERTEX = `
varying vec3 p_in_world;
void main() {
  p_in_world = (modelMatrix * vec4(position, 1.0)).xyz;
  gl_Position = projectionMatrix * viewMatrix * vec4(p_in_world, 1.0);
}`;
const FRAGMENT = `
uniform vec3 backdrop, ground, grid;
uniform vec2 centre;
uniform float reach;
varying vec3 p_in_world;
// Share of this pixel that lines of this spacing cover.
float lines(vec2 at, float width) {
  vec2 step_size = fwidth(at);
  vec2 off = abs(fract(at - 0.5) - 0.5);
  vec2 cover = clamp((width + step_size - off) / max(step_size, 1e-6), 0.0, 1.0);
  // Lines closer than pixels become a tint.
  cover *= clamp(0.5 / max(step_size, 1e-6) - 0.5, 0.0, 1.0);
  return max(cover.x, cover.y);
}
void main() {
  float far = length(p_in_world.xz - centre) / reach;
  float fade = clamp(1.0 - far, 0.0, 1.0);
  float line = max(lines(p_in_world.xz, 0.006), 0.45 * lines(2.0 * p_in_world.xz, 0.004));
  vec3 colour = mix(backdrop, mix(ground, grid, line), fade * fade);
  gl_FragColor = vec4(colour, 1.0);
  #include <colorspace_fragment>
}`;

/** The floor of the scene. */
export interface Floor {
  readonly object: Object3D;
  height_m: number;
  paint(theme: Theme): void;
  /** Centre of the drawn area: the target of the view. */
  place(x: number, z: number): void;
}

/** `lined`: pixels are costly, so the floor consists of lines only. */
export function makeFloor(lined: boolean): Floor {
  return lined ? new LinedFloor() : new ShadedFloor();
}

class ShadedFloor implements Floor {
  readonly object: Mesh<PlaneGeometry, ShaderMaterial>;
  height_m = 0;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      depthWrite: false,
      uniforms: {
        backdrop: {value: new Color()}, ground: {value: new Color()},
        grid: {value: new Color()}, centre: {value: [0, 0]}, reach: {value: REACH_M},
      },
    });
    this.object = new Mesh(new PlaneGeometry(2 * REACH_M, 2 * REACH_M).rotateX(-Math.PI / 2),
      material);
    // Drawn first and without depth, to avoid flicker.
    this.object.renderOrder = -10;
    this.object.frustumCulled = false;
  }

  paint(theme: Theme): void {
    const {uniforms} = this.object.material;
    uniforms.backdrop.value.setStyle(theme.colour('stage'));
    uniforms.ground.value.setStyle(theme.colour('stage-floor'));
    uniforms.grid.value.setStyle(theme.colour('stage-grid'));
  }

  place(x: number, z: number): void {
    this.object.position.set(x, this.height_m, z);
    const {centre} = this.object.material.uniforms;
    centre.value[0] = x;
    centre.value[1] = z;
  }
}

const LINED_REACH_M = 8;

class LinedFloor implements Floor {
  readonly object: LineSegments<BufferGeometry, LineBasicMaterial>;
  height_m = 0;
  private readonly fades: number[] = [];

  constructor() {
    const ends: number[] = [];
    const reach = LINED_REACH_M;
    for (let line = -reach; line <= reach; ++line) {
      // In pieces of two metres, because colour is interpolated linearly per piece.
      for (let along = -reach; along < reach; along += 2) {
        for (const [x, z] of [[along, line], [along + 2, line], [line, along],
          [line, along + 2]]) {
          ends.push(x, 0, z);
          this.fades.push(Math.max(1 - Math.hypot(x, z) / reach, 0));
        }
      }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute(ends, 3));
    geometry.setAttribute('color', new Float32BufferAttribute(ends.length, 3));
    this.object = new LineSegments(geometry, new LineBasicMaterial({vertexColors: true,
      depthWrite: false}));
    this.object.renderOrder = -10;
    this.object.frustumCulled = false;
  }

  paint(theme: Theme): void {
    const [far, near] = ['stage', 'stage-grid'].map((name) => new Color(theme.colour(name)));
    const mixed = new Color();
    const tints = this.object.geometry.attributes.color;
    this.fades.forEach((fade, i) => {
      const {r, g, b} = mixed.lerpColors(far, near, fade);
      tints.setXYZ(i, r, g, b);
    });
    tints.needsUpdate = true;
  }

  /** Moves in whole metres, so that lines stay fixed in the world. */
  place(x: number, z: number): void {
    this.object.position.set(Math.round(x), this.height_m, Math.round(z));
  }
}
