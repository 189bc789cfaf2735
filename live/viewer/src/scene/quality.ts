// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Resolution of the picture, reduced on slow machines. Has no clock: it gets the numbers of
// due and drawn pictures once a second.

/** Pixels of the picture per pixel of the page, in descending order. */
const RATIOS = [2, 1.5, 1, 0.75, 0.6];
const PATIENCE = 2; // Successive seconds of one kind before a change.
const CALM = 20; // Seconds without slow pictures before a finer ratio is tried.
/** Number of pixels below which a coarser picture is hardly faster. */
const MIN_PX = 200_000;

export class Quality {
  private level: number;
  private behind = 0;
  private fine = 0;
  private readonly finest: number;
  /** Ratios that were too slow once are not tried again. */
  private limit: number;

  /** `software`: there is no graphics processor. */
  constructor(pixelRatio: number, software: boolean) {
    const wanted = software ? 1 : pixelRatio;
    this.finest = Math.max(0, RATIOS.findIndex((ratio) => ratio <= Math.max(wanted, 0.6)));
    this.level = this.finest;
    this.limit = this.finest;
  }

  get ratio(): number {
    return RATIOS[this.level];
  }

  /** Evaluates one second: pictures due, pictures drawn, and their area on the page. Returns
   *  true if the ratio changed. */
  second(due: number, drawn: number, area_px: number): boolean {
    // Few pictures are no evidence: the page was hidden, or nothing moved.
    if (due < 10) return false;
    const slow = drawn < 0.85 * Math.min(due, 60);
    this.behind = slow ? this.behind + 1 : 0;
    this.fine = slow ? 0 : this.fine + 1;
    const coarser = RATIOS[this.level + 1];
    const worthIt = coarser !== undefined && coarser ** 2 * area_px >= MIN_PX;
    if (this.behind >= PATIENCE && worthIt) {
      this.limit = this.level + 1;
      return this.change(this.level + 1);
    }
    if (this.fine >= CALM && this.level > this.limit) return this.change(this.level - 1);
    return false;
  }

  private change(level: number): boolean {
    this.level = level;
    this.behind = 0;
    this.fine = 0;
    return true;
  }
}
