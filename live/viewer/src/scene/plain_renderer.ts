// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Draws a scene without WebGL: lines, and bones as thick lines, distant ones first.

import {Color, InstancedMesh, LineSegments, Matrix4, Vector3} from 'three';
import type {BufferAttribute, Camera, LineBasicMaterial, Scene} from 'three';

interface Stroke {
  from: Vector3; to: Vector3;
  /** Width on the canvas; 1.5 pixels for a line without a width in the world. */
  width: number;
  colour: string; order: number;
}

/** Depths at which a point is in front of the eye, after the projection. */
const isInFront = ({z}: Vector3): boolean => z > -1 && z < 1;

export class PlainRenderer {
  private readonly context: CanvasRenderingContext2D;
  private readonly matrix = new Matrix4();
  private ratio = 1;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.context = canvas.getContext('2d')!;
  }

  setPixelRatio(ratio: number): void {
    this.ratio = ratio;
  }

  setSize(width: number, height: number, _style: boolean): void {
    this.canvas.width = Math.round(this.ratio * width);
    this.canvas.height = Math.round(this.ratio * height);
  }

  render(scene: Scene, camera: Camera): void {
    const {context, canvas: {width, height}} = this;
    scene.updateMatrixWorld();
    context.fillStyle = (scene.background as Color).getStyle();
    context.fillRect(0, 0, width, height);
    context.lineCap = 'round';
    const strokes: Stroke[] = [];
    scene.traverseVisible((object) => {
      if (object instanceof LineSegments) this.lines(object, camera, strokes);
      else if (object instanceof InstancedMesh) this.bones(object, camera, strokes);
    });
    const depth = ({from, to}: Stroke): number => from.z + to.z;
    strokes.sort((a, b) => a.order - b.order || depth(b) - depth(a));
    for (const {from, to, width: thick, colour} of strokes) {
      context.strokeStyle = colour;
      context.lineWidth = thick;
      context.beginPath();
      context.moveTo((from.x + 1) / 2 * width, (1 - from.y) / 2 * height);
      context.lineTo((to.x + 1) / 2 * width, (1 - to.y) / 2 * height);
      context.stroke();
    }
  }

  pixels(): Uint8ClampedArray {
    return this.context.getImageData(0, 0, this.canvas.width, this.canvas.height).data;
  }

  private lines(object: LineSegments, camera: Camera, strokes: Stroke[]): void {
    const at = object.geometry.attributes.position as BufferAttribute | undefined;
    const tints = object.geometry.attributes.color as BufferAttribute | undefined;
    const plain = (object.material as LineBasicMaterial).color;
    const end = (i: number): Vector3 => new Vector3().fromBufferAttribute(at!, i)
      .applyMatrix4(object.matrixWorld).project(camera);
    for (let i = 0; i + 1 < (at?.count ?? 0); i += 2) {
      const [from, to] = [end(i), end(i + 1)];
      if (!isInFront(from) || !isInFront(to)) continue;
      const colour = tints ? new Color().fromBufferAttribute(tints, i) : plain;
      strokes.push({from, to, width: 1.5 * this.ratio, colour: colour.getStyle(),
        order: object.renderOrder});
    }
  }

  /** The y axis of an instance is its length, the x axis its radius. */
  private bones(mesh: InstancedMesh, camera: Camera, strokes: Stroke[]): void {
    const [material] = [mesh.material].flat();
    if (material.transparent) return;
    for (let i = 0; i < mesh.count; ++i) {
      mesh.getMatrixAt(i, this.matrix);
      const e = this.matrix.premultiply(mesh.matrixWorld).elements;
      const from = new Vector3(e[12], e[13], e[14]);
      const beside = from.clone().add(new Vector3().setFromMatrixColumn(camera.matrixWorld, 0)
        .setLength(Math.hypot(e[0], e[1], e[2]))).project(camera);
      const to = from.clone();
      if (mesh.userData.long) to.add(new Vector3(e[4], e[5], e[6]));
      from.project(camera);
      to.project(camera);
      if (!isInFront(from) || !isInFront(to)) continue;
      const colour = new Color();
      if (mesh.instanceColor) mesh.getColorAt(i, colour);
      else colour.copy((material as LineBasicMaterial).color);
      strokes.push({from, to, width: Math.abs(beside.x - from.x) * this.canvas.width,
        colour: colour.getStyle(), order: mesh.renderOrder});
    }
  }
}
