// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The canvas and its renderer. Draws only on request.

import {
  Color, DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from 'three';
import {el} from './elements';
import {VIEW_ANGLE} from './orbit';
import type {Orbit} from './orbit';
import type {Vector} from './protocol';
import {Quality} from './quality';
import type {Colours} from './theme';

/** Names of software renderers: SwiftShader, llvmpipe and similar. */
function drawsInSoftware(): boolean {
  const gl = el('canvas').getContext('webgl2');
  if (!gl) return true;
  const about = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(about ? about.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class Renderer {
  readonly canvas = el('canvas', {tabindex: 0, 'aria-label':
    'The scene in three dimensions. Drag turns it, space plays, question mark: all keys.'});
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(VIEW_ANGLE * 180 / Math.PI, 1, 0.05, 120);
  readonly eye: Vector = [0, 0, 0];
  readonly software = drawsInSoftware();
  readonly quality = new Quality(window.devicePixelRatio || 1, this.software);
  width = 1;
  height = 1;
  private readonly gl: WebGLRenderer;
  private readonly sky = new HemisphereLight(0xffffff, 0x8a8580, 2.1);
  private readonly sun = new DirectionalLight(0xffffff, 1.7);
  private readonly ray = new Vector3();
  private asked = 0;

  /** Throws without WebGL 2. `draw` is called with the time of the picture. */
  constructor(private readonly draw: (now_ms: number) => void, resized: () => void) {
    this.gl = new WebGLRenderer({canvas: this.canvas, antialias: !this.software,
      powerPreference: 'high-performance', alpha: false, stencil: false});
    this.sun.position.set(0.5, 1.4, 0.8);
    this.scene.add(this.sky, this.sun);
    this.scene.background = new Color();
    new ResizeObserver(() => {
      this.resize();
      resized();
    }).observe(this.canvas);
    this.canvas.addEventListener('webglcontextrestored', () => this.invalidate());
  }

  /** Requests one picture, at the screen's next refresh. */
  invalidate(): void {
    if (this.asked !== 0) return;
    this.asked = requestAnimationFrame((now_ms) => {
      this.asked = 0;
      this.draw(now_ms);
    });
  }

  paint(colours: Colours): void {
    (this.scene.background as Color).setStyle(colours.stage);
    this.invalidate();
  }

  look(orbit: Orbit): void {
    orbit.eye(this.eye);
    this.camera.position.set(...this.eye);
    this.camera.lookAt(...orbit.target_in_world);
    // A large ratio of far to near depth costs precision.
    this.camera.near = Math.min(0.1, orbit.distance_m / 20);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  render(): void {
    this.gl.render(this.scene, this.camera);
  }

  /** Returns the direction from the eye through a place on the canvas, not normalised. */
  rayThrough(x_px: number, y_px: number): Vector {
    this.ray.set(2 * x_px / this.width - 1, 1 - 2 * y_px / this.height, 0.5)
      .unproject(this.camera).sub(this.camera.position);
    return [this.ray.x, this.ray.y, this.ray.z];
  }

  /** Returns the direction towards the eye. */
  facing(): Vector {
    this.camera.getWorldDirection(this.ray);
    return [-this.ray.x, -this.ray.y, -this.ray.z];
  }

  /** Returns the place on the canvas; null behind the eye. */
  pixelOf(p_in_world: Vector): [number, number] | null {
    this.ray.set(...p_in_world).project(this.camera);
    if (this.ray.z > 1) return null;
    return [(this.ray.x + 1) / 2 * this.width, (1 - this.ray.y) / 2 * this.height];
  }

  /** Called once a second with the numbers of due and drawn pictures. */
  adapt(due: number, drawn: number): void {
    if (this.quality.second(due, drawn, this.width * this.height)) this.resize();
  }

  /** Waits until every request is drawn. For measurements. */
  finish(): void {
    const gl = this.gl.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  private resize(): void {
    this.width = Math.max(1, this.canvas.clientWidth);
    this.height = Math.max(1, this.canvas.clientHeight);
    this.gl.setPixelRatio(this.quality.ratio);
    this.gl.setSize(this.width, this.height, false);
    this.camera.aspect = this.width / this.height;
    // Drawn at once, because a resized canvas is empty.
    if (this.asked !== 0) cancelAnimationFrame(this.asked);
    this.asked = 0;
    this.draw(performance.now());
  }
}
