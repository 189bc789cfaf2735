// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Draws the scene without WebGL: every capsule is a thick line, distant ones first.

class LineDrawing {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
  }

  draw(scene) {
    const {context, canvas} = this;
    context.fillStyle = cssRgb(scene.theme.backdrop);
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.lineCap = 'round';
    this.#drawGrid(scene);
    this.#drawShadows(scene);
    this.#drawCapsules(scene);
    this.#drawLines(scene);
  }

  #at(scene, p) {
    return projected(scene.clipFromWorld, p, this.canvas.width, this.canvas.height);
  }

  #stroke(a, b, width, colour) {
    if (!a || !b) return;
    const {context} = this;
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(a.x, a.y);
    context.lineTo(b.x, b.y);
    context.stroke();
  }

  #drawGrid(scene) {
    const reach = 6;
    const [x, z] = [Math.round(scene.target[0]), Math.round(scene.target[2])];
    const colour = cssRgb(scene.theme.grid);
    for (let i = -reach; i <= reach; ++i) {
      // In pieces, so that only the pieces behind the eye are omitted.
      for (let k = -reach; k < reach; ++k) {
        this.#stroke(this.#at(scene, [x + i, 0, z + k]),
          this.#at(scene, [x + i, 0, z + k + 1]), 1, colour);
        this.#stroke(this.#at(scene, [x + k, 0, z + i]),
          this.#at(scene, [x + k + 1, 0, z + i]), 1, colour);
      }
    }
  }

  #capsules(scene) {
    const {values, count} = scene.capsules;
    return Array.from({length: count}, (_, i) => {
      const v = values.subarray(CAPSULE * i, CAPSULE * (i + 1));
      return {a: [v[0], v[1], v[2]], b: [v[3], v[4], v[5]], radius: (v[6] + v[7]) / 2,
        flatEnds: v[9] < 1, colour: [v[13], v[14], v[15]]};
    });
  }

  #drawShadows(scene) {
    const {context} = this;
    context.globalAlpha = 0.05 * scene.theme.shadow;
    for (const {a, b, radius} of this.#capsules(scene)) {
      const [p, q] = [a, b].map((end) => this.#at(scene, [end[0], 0, end[2]]));
      if (p && q) this.#stroke(p, q, scene.focal * this.canvas.height * radius / p.depth,
        '#000');
    }
    context.globalAlpha = 1;
  }

  #drawCapsules(scene) {
    const ends = this.#capsules(scene)
      .map((c) => ({...c, p: this.#at(scene, c.a), q: this.#at(scene, c.b)}))
      .filter(({p, q}) => p && q)
      .sort((one, other) => other.p.depth + other.q.depth - one.p.depth - one.q.depth);
    for (const {p, q, radius, flatEnds, colour} of ends) {
      const width = scene.focal * this.canvas.height * radius / ((p.depth + q.depth) / 2);
      // Outlines separate an arm from the trunk; the slices of the trunk have one outline.
      if (!flatEnds) this.#stroke(p, q, width + 2, cssRgb(scaled(colour, 0.5)));
      this.#stroke(p, q, width, cssRgb(colour));
    }
  }

  #drawLines(scene) {
    for (let i = 0; i + 11 < scene.lines.length; i += 12) {
      const v = scene.lines.subarray(i, i + 12);
      this.#stroke(this.#at(scene, v.subarray(0, 3)), this.#at(scene, v.subarray(6, 9)), 1.5,
        cssRgb([v[3], v[4], v[5]]));
    }
  }

  coloursDrawn() {
    const {context, canvas} = this;
    return countColours(context.getImageData(0, 0, canvas.width, canvas.height).data);
  }
}
