// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The floor: a grid of metres that fades with the distance.

import {Color, Mesh, PlaneGeometry, ShaderMaterial} from 'three';
import type {Colours} from './theme';

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
  // Where lines lie closer than pixels they become a tint.
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

export class Floor {
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
    // First of all, without depth: nothing flickers against it.
    this.object.renderOrder = -10;
    this.object.frustumCulled = false;
  }

  paint(colours: Colours): void {
    const {uniforms} = this.object.material;
    uniforms.backdrop.value.setStyle(colours.stage);
    uniforms.ground.value.setStyle(colours.floor);
    uniforms.grid.value.setStyle(colours.grid);
  }

  /** Around what is looked at. */
  place(x: number, z: number): void {
    this.object.position.set(x, this.height_m, z);
    const {centre} = this.object.material.uniforms;
    centre.value[0] = x;
    centre.value[1] = z;
  }
}
