// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Drawings of clips: fetched for visible rows, and drawn on their canvases.

import type {Theme} from '../base/theme';
import type {DrawingWords, PosePoints} from '../protocol/library_protocol';
import {scaleOf, strokesOf} from './pose_strokes';
import type {StrokeSide} from './pose_strokes';
import type {Reply} from './questions';

const BATCH = 24;
const MAX_KEPT = 2000;
const COLOURS: Record<StrokeSide, string> = {behind: 'stage-line', trunk: 'ink', front: 'ink'};
const FLOOR_PX = 2;

export class Drawings {
  /** null: the clip has no motion. */
  private readonly kept = new Map<number, PosePoints[] | null>();
  private readonly asked = new Set<number>();
  private generation = 0;

  /** `arrived` is called when drawings have arrived. */
  constructor(private readonly ask: (clips: number[]) => Promise<Reply>,
    private readonly arrived: () => void) {}

  /** Forgets all drawings: the library was built again. */
  clear(): void {
    this.kept.clear();
    this.asked.clear();
    ++this.generation;
  }

  /** undefined: it is not here yet. */
  of(clip: number): PosePoints[] | null | undefined {
    return this.kept.get(clip);
  }

  /** Fetches the drawings of these clips that are missing. */
  want(clips: readonly number[]): void {
    const missing = clips.filter((clip) => !this.kept.has(clip) && !this.asked.has(clip));
    for (let i = 0; i < missing.length; i += BATCH) void this.load(missing.slice(i, i + BATCH));
  }

  private async load(clips: number[]): Promise<void> {
    const {generation} = this;
    for (const clip of clips) this.asked.add(clip);
    const reply = await this.ask(clips);
    if (generation !== this.generation) return;
    for (const clip of clips) this.asked.delete(clip);
    if (reply.kind !== 'answer' || reply.words.type !== 'drawings') return;
    this.take(reply.words.drawings);
    this.arrived();
  }

  private take(drawings: readonly DrawingWords[]): void {
    for (const {clip, poses} of drawings) this.kept.set(clip, poses);
    // The oldest come first.
    for (const clip of this.kept.keys()) {
      if (this.kept.size <= MAX_KEPT) break;
      this.kept.delete(clip);
    }
  }
}

/** Draws the postures side by side on the whole canvas; null: a dash. */
export function draw(canvas: HTMLCanvasElement, poses: readonly PosePoints[] | null | undefined,
  theme: Theme): void {
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const {clientWidth: width, clientHeight: height} = canvas;
  if (width === 0) return;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext('2d')!;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.lineCap = 'round';
  context.lineJoin = 'round';
  context.fillStyle = theme.colour('stage-grid');
  context.fillRect(0, height - FLOOR_PX, width, 1);
  if (!poses) {
    if (poses === null) drawMissing(context, width, height, theme);
    return;
  }
  const step = width / poses.length;
  const scale = scaleOf(poses, step, height - FLOOR_PX - 2);
  poses.forEach((points, i) => drawPose(context, theme,
    strokesOf(points, scale, {left: i * step, top: 1, width: step, height: height - FLOOR_PX - 1})));
}

function drawPose(context: CanvasRenderingContext2D, theme: Theme,
  {strokes, head}: ReturnType<typeof strokesOf>): void {
  const radius = Math.max(head.radius, 2);
  for (const {side, points} of strokes) {
    context.strokeStyle = theme.colour(COLOURS[side]);
    context.lineWidth = side === 'trunk' ? 2.2 : 1.7;
    context.beginPath();
    context.moveTo(points[0], points[1]);
    for (let i = 2; i < points.length; i += 2) context.lineTo(points[i], points[i + 1]);
    context.stroke();
  }
  context.fillStyle = theme.colour('ink');
  context.beginPath();
  context.arc(head.x, head.y, radius, 0, 2 * Math.PI);
  context.fill();
}

function drawMissing(context: CanvasRenderingContext2D, width: number, height: number,
  theme: Theme): void {
  context.fillStyle = theme.colour('quiet');
  context.font = '11px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText('motion missing', width / 2, height / 2);
}
