// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The tool for the path: shows the way of the hips on the floor, and changes it by points
// that are dragged, by a turn, or by its length.

import type {EditView} from '../edit/edit_view';
import {pathOpWithPoints, pointsChange, pointsOf, shapeChange, shownShape} from './path_changes';
import type {PathShape, Place} from './path_changes';
import {CURVE_STEPS, PointDrag} from './point_drag';
import type {SkeletonWords} from '../protocol/protocol';
import {button, checkbox, el, keepRows, remember, remembered, setText} from '../base/elements';
import type {Theme} from '../base/theme';
import {fixed} from '../base/words';
import {
  curveThrough, equidistant, hipsPath, pointCount, reachOf, smoothed, waysOf,
} from '../scene/floor_path';
import type {FloorPath, MotionFrames} from '../scene/floor_path';
import {PathView} from '../scene/path_view';
import type {Stage} from '../scene/stage';

/** The edited body in the scene. */
const RESULT = 1;
/** Half of the time over which the sway of steps is removed from the first points. */
const SMOOTH_S = 0.5;
/** A body that travels less has no path; marey decides exactly, by the length of its legs. */
const MIN_TRAVEL_M = 0.35;
/** marey's limits for the length of a new path, and the tolerance of the page's estimate. */
const MIN_LENGTH = 0.7;
const MAX_LENGTH = 1.3;
const SLACK = 0.02;
const MIN_APART_M = 0.01;

export class PathTool {
  readonly element: HTMLElement;
  private readonly drawn = new PathView();
  private readonly drag: PointDrag;
  private readonly editing = button({'aria-pressed': 'false', title:
    'Drag points on the floor. Double-click on the curve adds one, Delete removes the selected',
    onclick: () => this.setOn(!this.drag.on)}, 'Edit points');
  private readonly length = el('input', {type: 'number', min: 70, max: 130, step: 1,
    value: 100, 'aria-label': 'Length in percent', onchange: () => this.stretch()});
  private readonly straight = button({title: 'Removes the turn of the path',
    onclick: () => this.shape(() => ({straight: true}))}, 'Straight');
  private readonly shapes: HTMLElement;
  private readonly list = el('ol', {class: 'points'});
  private readonly adding = button({onclick: () => this.addPoint()}, 'Add point');
  private readonly note = el('p', {class: 'note', role: 'status'});
  private path: FloorPath | null = null;
  private selectedOp: number | null = null;
  /** Revision that the note is about. */
  private toldAt = -1;

  /** `switched` is called when the points can be dragged, or no longer. */
  constructor(private readonly view: EditView, private readonly stage: Stage, theme: Theme,
    private readonly switched: (on: boolean) => void = () => {}) {
    const turn = (text: string, turn_deg: number): HTMLElement =>
      button({onclick: () => this.shape((shape) => ({turn_deg: shape.turn_deg + turn_deg}))},
        text);
    this.shapes = el('div', {class: 'row'}, turn('Turn 90° left', 90),
      turn('Turn 90° right', -90), this.straight,
      el('label', {class: 'row'}, 'Length ', this.length, ' %'));
    this.drawn.object.visible = remembered('edit.path') !== 'off';
    const shown = checkbox('Show path', this.drawn.object.visible, (on) => this.show(on), {title:
      'The way of the hips on the floor, with a mark each second'});
    this.element = el('div', {class: 'path-tool'}, el('div', {class: 'row'}, shown, this.editing),
      this.shapes, this.list, this.adding, this.note);
    stage.add(this.drawn);
    theme.onChange(() => this.drawn.paint(theme));
    this.drag = new PointDrag(stage, this.drawn, {
      moved: (points, ended) => this.moved(points, ended),
      cancelled: () => this.giveUp(), changed: (points) => this.commit(points),
      selected: () => this.showList()});
    this.update();
  }

  /** Sets the frames of the shown motion; null: none. `skeletons`: those of the scene. */
  setMotion(motion: MotionFrames | null, skeletons: readonly SkeletonWords[],
    rate_hz: number): void {
    const path = motion && skeletons[RESULT] && motion.frames > 0
      ? hipsPath(motion, skeletons, RESULT, rate_hz) : null;
    this.drawn.setPath(path, rate_hz, this.stage.floor_m);
    // A drag is measured on the motion that it began on, not on its previews.
    if (!this.drag.isDragging) this.path = path;
    this.drawn.setTime(this.view.time);
    this.update();
  }

  /** Selects an operation of the recipe; null: none. */
  select(op: number | null): void {
    this.selectedOp = op;
    this.update();
  }

  /** Called when the shown motion or the recipe has changed. */
  update(): void {
    if (this.drag.isDragging) return;
    const travels = this.travels;
    for (const control of this.shapes.querySelectorAll('button, input')) {
      (control as HTMLButtonElement).disabled = !travels;
    }
    this.editing.disabled = !travels && !this.drag.on;
    const {length} = shownShape(this.view.document.ops, this.view.until);
    if (document.activeElement !== this.length) this.length.value = String(
      Math.round(1000 * length) / 10);
    this.setPoints(this.drag.on ? this.currentPoints() : []);
    if (!travels && this.path) {
      this.tell('The body stays in place, so there is no path to change. Use the operation ' +
        'place to move it.');
    } else if (this.toldAt !== (this.view.document.revision?.revision ?? 0)) this.tell('');
  }

  /** Called when the shown instant has changed. */
  setTime(time: number): void {
    this.drawn.setTime(time);
  }

  setOn(on: boolean): void {
    this.drag.on = on;
    this.editing.setAttribute('aria-pressed', String(on));
    this.drawn.selected = -1;
    this.drawn.held = -1;
    this.stage.renderer.canvas.classList.remove('over-point');
    if (on) this.drawn.object.visible = true;
    else this.show(remembered('edit.path') !== 'off');
    this.switched(on);
    this.update();
  }

  private show(on: boolean): void {
    remember('edit.path', on ? 'on' : 'off');
    this.drawn.object.visible = on || this.drag.on;
    this.stage.refresh();
  }

  private get travels(): boolean {
    return this.path !== null && reachOf(this.path.xz) >= MIN_TRAVEL_M;
  }

  // --- Points ---

  private get op(): number | null {
    return pathOpWithPoints(this.view.document.ops, this.view.until, this.selectedOp);
  }

  private currentPoints(): Place[] {
    const {op, path} = this;
    const given = op === null ? null : pointsOf(this.view.document.ops[op].keys);
    if (given || !path || path.xz.length < 4) return given ?? [];
    const reach = Math.round(SMOOTH_S * (this.view.output?.rate_hz ?? 30) / path.every);
    const smooth = smoothed(path.xz, reach);
    const ways = waysOf(smooth);
    return equidistant(smooth, pointCount(ways[ways.length - 1]));
  }

  private setPoints(points: Place[]): void {
    this.drawn.setPoints(points, curveThrough(points, CURVE_STEPS));
    this.drawn.selected = Math.min(this.drawn.selected, points.length - 1);
    this.showList();
    this.stage.refresh();
  }

  /** Returns why marey would refuse this path; empty: it may accept it. */
  private fault(points: readonly Place[]): string {
    const near = points.findIndex(([x, z], i) => i > 0 &&
      Math.hypot(x - points[i - 1][0], z - points[i - 1][1]) < MIN_APART_M);
    if (near > 0) return `Points ${near} and ${near + 1} are closer than 1 cm.`;
    const before_m = this.lengthBefore();
    const share = this.lengthOf(points) / before_m;
    if (before_m > 0 && (share < MIN_LENGTH - SLACK || share > MAX_LENGTH + SLACK)) {
      return `The new path has ${fixed(100 * share, 0)} % of the length. ` +
        '70 to 130 % are possible with the same steps.';
    }
    return '';
  }

  private lengthOf(points: readonly Place[]): number {
    const ways = waysOf(curveThrough(points, CURVE_STEPS));
    return ways[ways.length - 1] ?? 0;
  }

  /** Length of the path that the operation receives; 0: unknown. [m] */
  private lengthBefore(): number {
    const {op, path} = this;
    if (op !== null) {
      const report = this.view.document.rendered?.reports.find((one) => one.op === op);
      return report?.figures.length_m ?? 0;
    }
    if (!path) return 0;
    const reach = Math.round(SMOOTH_S * (this.view.output?.rate_hz ?? 30) / path.every);
    const ways = waysOf(smoothed(path.xz, reach));
    return ways[ways.length - 1] ?? 0;
  }

  private tell(text: string, isFault = false): void {
    this.toldAt = this.view.document.revision?.revision ?? 0;
    setText(this.note, text);
    this.note.classList.toggle('error', isFault);
  }

  private tellLength(points: readonly Place[]): void {
    const fault = this.fault(points);
    const before_m = this.lengthBefore();
    const length_m = this.lengthOf(points);
    this.tell(fault || `New length ${fixed(length_m, 2)} m` + (before_m > 0
      ? `, ${fixed(100 * length_m / before_m, 0)} % of before.` : '.'), fault !== '');
  }

  private moved(points: Place[], ended: boolean): void {
    this.drawn.setPoints(points, curveThrough(points, CURVE_STEPS));
    this.showList();
    this.tellLength(points);
    if (ended) this.commit(points);
    else if (!this.fault(points)) this.view.preview(this.change(points));
  }

  private change(points: readonly Place[]): ReturnType<typeof pointsChange> {
    return pointsChange(points, this.view.until, this.selectedOp);
  }

  private commit(points: Place[]): void {
    const fault = this.fault(points);
    if (fault) {
      this.giveUp();
      this.showList(true);
      this.tell(fault, true);
      return;
    }
    this.setPoints(points);
    void this.view.commit(this.change(points)).then((done) => {
      if (!done) this.update();
    });
  }

  private giveUp(): void {
    this.view.cancel();
    this.update();
  }

  // --- Fields ---

  /** `all`: a field that is being edited, too. */
  private showList(all = false): void {
    const points = this.drawn.points;
    this.list.hidden = points.length === 0;
    this.adding.hidden = points.length === 0;
    keepRows(this.list, points, () => this.row(), (row, [x, z], i) => {
      row.classList.toggle('selected', i === this.drawn.selected);
      row.querySelectorAll('input').forEach((field, c) => {
        if (all || document.activeElement !== field) field.value = (c === 0 ? x : z).toFixed(2);
        field.setAttribute('aria-label', `Point ${i + 1}, ${'xz'[c]} in metres`);
      });
      const remove = row.querySelector('button')!;
      remove.setAttribute('aria-label', `Remove point ${i + 1}`);
      remove.disabled = points.length <= 2;
    });
  }

  private row(): HTMLElement {
    const index = (): number => [...this.list.children].indexOf(made);
    const field = (c: number): HTMLElement => {
      const input = el('input', {type: 'number', step: '0.05', onchange: () => {
        const points = this.drawn.points.map(([x, z]): Place => [x, z]);
        if (input.value === '' || !Number.isFinite(Number(input.value))) return;
        points[index()][c] = Number(input.value);
        this.commit(points);
      }, onfocus: () => {
        this.drawn.selected = index();
        this.stage.refresh();
      }});
      return input;
    };
    const made: HTMLElement = el('li', {}, 'x ', field(0), ' z ', field(1), ' m ',
      button({class: 'icon', onclick: () => this.drag.remove(index())}, '×'));
    return made;
  }

  /** Adds a point in the middle of the longest part of the curve. */
  private addPoint(): void {
    const points = this.drawn.points.map(([x, z]): Place => [x, z]);
    if (points.length < 2) return;
    const curve = curveThrough(points, CURVE_STEPS);
    const ways = waysOf(curve);
    let longest = 0;
    const part = (i: number): number => ways[(i + 1) * CURVE_STEPS] - ways[i * CURVE_STEPS];
    for (let i = 1; i + 1 < points.length; ++i) if (part(i) > part(longest)) longest = i;
    const middle = longest * CURVE_STEPS + CURVE_STEPS / 2;
    points.splice(longest + 1, 0, [curve[2 * middle], curve[2 * middle + 1]]);
    this.drawn.selected = longest + 1;
    this.commit(points);
  }

  // --- Turn and length ---

  private shape(shaped: (shape: PathShape) => Partial<PathShape>): void {
    void this.view.commit(shapeChange(shaped, this.view.until));
  }

  private stretch(): void {
    const percent = Number(this.length.value);
    if (this.length.value === '' || !(percent >= 70 && percent <= 130)) {
      this.tell('The length must be 70 to 130 %.', true);
      return;
    }
    this.tell('');
    this.shape(() => ({length: percent / 100}));
  }
}
