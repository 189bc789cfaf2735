// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The canvas and its renderer. Draws only on request.

import {
  Color, DirectionalLight, HemisphereLight, Scene, Vector3, WebGLRenderer,
} from 'three';
import type {PerspectiveCamera} from 'three';
import {el} from '../base/elements';
import {Orbit} from './orbit';
import {PlainRenderer} from './plain_renderer';
import type {Vector} from '../protocol/protocol';
import {Quality} from './quality';
import type {Theme} from '../base/theme';

/** Kinds of drawing: on a graphics processor, by a software renderer (SwiftShader, llvmpipe
 *  and similar), without WebGL. */
export type Drawing = 'fast' | 'software' | 'lines';

export function drawingOfBrowser(): Drawing {
  const gl = el('canvas').getContext('webgl2');
  if (!gl) return 'lines';
  const about = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(about ? about.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name) ? 'software' : 'fast';
}

export interface RendererOptions {
  drawing: Drawing;
  /** Text of the canvas for screen readers. */
  label: string;
  /** The canvas is part of a page that scrolls. */
  scrolled?: boolean;
}

export class Renderer {
  readonly canvas: HTMLCanvasElement;
  readonly scene = new Scene();
  readonly orbit: Orbit;
  readonly camera: PerspectiveCamera;
  readonly quality: Quality;
  width = 1;
  height = 1;
  private readonly gl: WebGLRenderer | PlainRenderer;
  private readonly sky = new HemisphereLight(0xffffff, 0x8a8580, 2.1);
  private readonly sun = new DirectionalLight(0xffffff, 1.7);
  private readonly ray = new Vector3();
  private asked = 0;

  /** `draw` is called with the time of the picture. */
  constructor(private readonly draw: (now_ms: number) => void, resized: () => void,
    readonly options: RendererOptions) {
    this.canvas = el('canvas', {tabindex: 0, 'aria-label': options.label});
    this.orbit = new Orbit(this.canvas, () => this.invalidate(), options.scrolled);
    this.camera = this.orbit.camera;
    this.quality = new Quality(window.devicePixelRatio || 1, this.software);
    this.gl = options.drawing === 'lines' ? new PlainRenderer(this.canvas)
      : new WebGLRenderer({canvas: this.canvas, antialias: options.scrolled || !this.software,
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

  paint(theme: Theme): void {
    (this.scene.background as Color).setStyle(theme.colour('stage'));
    this.invalidate();
  }

  /** Pixels are costly. */
  get software(): boolean {
    return this.options.drawing !== 'fast';
  }

  get eye(): Vector {
    return this.camera.position.toArray();
  }

  render(): void {
    // A large ratio of far to near depth costs precision.
    this.camera.near = Math.min(0.1, this.orbit.distance_m / 20);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
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

  /** Returns the pixels of the last picture, until the browser has shown it. Waits until
   *  every request is drawn. */
  pixels(): Uint8Array | Uint8ClampedArray {
    if (this.gl instanceof PlainRenderer) return this.gl.pixels();
    const gl = this.gl.getContext();
    const {drawingBufferWidth: width, drawingBufferHeight: height} = gl;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return pixels;
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
