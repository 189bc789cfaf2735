// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The picture of each camera with its detected tags.

import type {Thumbnail} from '../protocol/decode_thumbnail';
import {el, setText} from '../base/elements';
import {Section} from './panels';
import type {CameraWords, StatusWords} from '../protocol/protocol';

const STATES = {streaming: '', silent: 'silent', lost: 'lost'};

interface Picture {
  canvas: HTMLCanvasElement; caption: HTMLElement; state: HTMLElement;
  /** A picture is being decoded; the newest one received meanwhile is kept. */
  busy: boolean;
  next: Thumbnail | null;
}

export class CamerasPanel {
  readonly section: Section;
  private pictures: Picture[] = [];
  private wanted = false;
  private live = false;

  /** `want` is called with true while pictures are visible. */
  constructor(private readonly want: (on: boolean) => void) {
    this.section = new Section('cameras', 'Cameras', true, () => this.ask());
    document.addEventListener('visibilitychange', () => this.ask());
  }

  load(cameras: readonly CameraWords[], live: boolean): void {
    this.live = live;
    this.section.hidden = cameras.length === 0;
    this.section.tell(String(cameras.length));
    this.pictures = cameras.map((camera) => {
      const canvas = el('canvas', {width: 0, height: 0, role: 'img',
        'aria-label': `Picture of ${camera.name}`});
      canvas.style.aspectRatio = `${camera.width_px} / ${camera.height_px}`;
      canvas.hidden = !live;
      return {canvas, busy: false, next: null, state: el('span', {class: 'state'}),
        caption: el('figcaption', {}, el('b', {}, camera.name), ` ${sizeWords(camera)}, `)};
    });
    this.section.body.replaceChildren(el('div', {class: 'pictures'},
      ...this.pictures.map(({canvas, caption, state}) => {
        caption.append(state);
        return el('figure', {}, canvas, caption);
      })));
    this.ask();
  }

  /** Repeats the request for pictures after a reconnection. */
  repeat(): void {
    this.want(this.wanted);
  }

  ask(): void {
    const wanted = this.live && this.section.open && !document.hidden &&
      !document.body.classList.contains('without-panels');
    if (wanted === this.wanted) return;
    this.wanted = wanted;
    this.want(wanted);
  }

  status(cameras: StatusWords['cameras']): void {
    cameras.forEach((camera, i) => {
      const picture = this.pictures[i];
      if (!picture) return;
      const state = STATES[camera.state] ?? camera.state;
      setText(picture.state, state || `${camera.tags} tags`);
      picture.state.className = `state state-${camera.state}`;
      picture.state.title = camera.detail;
    });
  }

  show(thumbnail: Thumbnail): void {
    const picture = this.pictures[thumbnail.camera];
    if (!picture || !this.wanted) return;
    if (picture.busy) picture.next = thumbnail;
    else void this.paint(picture, thumbnail);
  }

  private async paint(picture: Picture, thumbnail: Thumbnail): Promise<void> {
    picture.busy = true;
    try {
      const bitmap = await createImageBitmap(new Blob([thumbnail.jpeg], {type: 'image/jpeg'}));
      const {canvas} = picture;
      if (canvas.width !== bitmap.width) canvas.width = bitmap.width;
      if (canvas.height !== bitmap.height) canvas.height = bitmap.height;
      const context = canvas.getContext('2d')!;
      context.drawImage(bitmap, 0, 0);
      bitmap.close();
      drawTags(context, thumbnail, canvas.width / Math.max(thumbnail.width_px, 1));
    } catch {
      // A picture that cannot be decoded is skipped; the next one arrives soon.
    }
    picture.busy = false;
    const {next} = picture;
    picture.next = null;
    if (next) void this.paint(picture, next);
  }
}

function sizeWords(camera: CameraWords): string {
  const error = camera.rms_px === null ? '' : `, ${camera.rms_px.toFixed(2)} px off`;
  return `${camera.width_px} × ${camera.height_px}${error}`;
}

/** Draws outlines and ids. Yellow with a dark edge is visible on any background. */
function drawTags(context: CanvasRenderingContext2D, {tags}: Thumbnail, scale: number): void {
  // Line widths are in pixels of the page, independent of the picture's size.
  const fine = context.canvas.width / Math.max(context.canvas.clientWidth, 1);
  context.font = `600 ${(11 * fine).toFixed(1)}px system-ui, sans-serif`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  for (const {id, corners_px: c} of tags) {
    context.beginPath();
    for (let i = 0; i < 8; i += 2) context.lineTo((c[i] + 0.5) * scale, (c[i + 1] + 0.5) * scale);
    context.closePath();
    context.lineWidth = 3 * fine;
    context.strokeStyle = 'rgb(0 0 0 / 60%)';
    context.stroke();
    context.lineWidth = 1.4 * fine;
    context.strokeStyle = '#ffe45c';
    context.stroke();
    const x = (c[0] + c[2] + c[4] + c[6]) / 4 * scale;
    const y = (c[1] + c[3] + c[5] + c[7]) / 4 * scale;
    context.lineWidth = 3 * fine;
    context.strokeStyle = 'rgb(0 0 0 / 75%)';
    context.strokeText(String(id), x, y);
    context.fillStyle = '#ffe45c';
    context.fillText(String(id), x, y);
  }
}
