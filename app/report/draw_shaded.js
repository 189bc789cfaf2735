// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Draws a scene with WebGL 2: shaded capsules, a floor with a grid and soft shadows,
// lines. A scene is the result of Stage.scene() in stage.js.

const SHADOW_SIZE = 384;
const LIGHT = unit([-0.38, -1, -0.3]);

/** Returns the corner values of the instanced capsule: two half balls of rings. */
function capsuleMesh() {
  const around = 22;
  const rings = 5;
  const rows = [];
  for (let end = 0; end < 2; ++end) {
    for (let i = 0; i <= rings; ++i) {
      const angle = (end === 0 ? i - rings : i) / rings * Math.PI / 2;
      rows.push([Math.sin(angle), end]);
    }
  }
  const corners = rows.flatMap(([level, end]) => Array.from({length: around}, (_, k) => {
    const angle = 2 * Math.PI * k / around;
    return [Math.cos(angle), Math.sin(angle), level, end];
  }).flat());
  const triangles = [];
  for (let row = 0; row + 1 < rows.length; ++row) {
    for (let k = 0; k < around; ++k) {
      const [a, b] = [row * around + k, row * around + (k + 1) % around];
      triangles.push(a, b, a + around, b, b + around, a + around);
    }
  }
  return {corners: new Float32Array(corners), triangles: new Uint16Array(triangles)};
}

class ShadedDrawing {
  /** Returns null without WebGL 2. */
  static on(canvas) {
    const gl = canvas.getContext('webgl2', {antialias: true, alpha: false});
    return gl ? new ShadedDrawing(canvas, gl) : null;
  }

  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.capsule = this.#program(CAPSULE_VERTEX, CAPSULE_FRAGMENT);
    this.caster = this.#program(CAPSULE_VERTEX, SHADOW_FRAGMENT);
    this.blur = this.#program(QUAD_VERTEX, BLUR_FRAGMENT);
    this.floor = this.#program(FLOOR_VERTEX, FLOOR_FRAGMENT);
    this.line = this.#program(LINE_VERTEX, LINE_FRAGMENT);
    this.#makeCapsule();
    this.quad = this.#array([['corner', 2]], [-1, -1, 1, -1, -1, 1, 1, 1]);
    this.lines = this.#array([['at', 3], ['colour', 3]], []);
    this.shadows = [this.#picture(), this.#picture()];
  }

  #program(vertex, fragment) {
    const {gl} = this;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    // An attribute has the same location in every program.
    ['shape', 'a', 'b', 'girth', 'side', 'colour', 'corner', 'at'].forEach((name, i) => {
      gl.bindAttribLocation(program, i, name);
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new Error(`the viewer's shader: ${gl.getProgramInfoLog(program)}`);
    }
    const set = {};
    const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < count; ++i) {
      const {name, type} = gl.getActiveUniform(program, i);
      const at = gl.getUniformLocation(program, name);
      set[name] = (value) => {
        if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(at, false, value);
        else if (type === gl.FLOAT_VEC3) gl.uniform3fv(at, value);
        else if (type === gl.FLOAT_VEC2) gl.uniform2fv(at, value);
        else if (type === gl.SAMPLER_2D) gl.uniform1i(at, value);
        else gl.uniform1f(at, value);
      };
    }
    return {
      place: (name) => gl.getAttribLocation(program, name),
      use(values) {
        gl.useProgram(program);
        for (const [name, value] of Object.entries(values)) set[name]?.(value);
      },
    };
  }

  #describe(places, layout, divisor) {
    const {gl} = this;
    const stride = 4 * layout.reduce((sum, [, size]) => sum + size, 0);
    let offset = 0;
    for (const [name, size] of layout) {
      const place = places[name];
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
      gl.vertexAttribDivisor(place, divisor);
      offset += 4 * size;
    }
  }

  #array(layout, values) {
    const {gl} = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
    this.#describe({corner: 6, at: 7, colour: 5}, layout, 0);
    return {array, buffer};
  }

  #makeCapsule() {
    const {gl} = this;
    const mesh = capsuleMesh();
    const places = {shape: 0, a: 1, b: 2, girth: 3, side: 4, colour: 5};
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, mesh.corners, gl.STATIC_DRAW);
    this.#describe(places, [['shape', 4]], 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles, gl.STATIC_DRAW);
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    this.#describe(places,
      [['a', 3], ['b', 3], ['girth', 4], ['side', 3], ['colour', 3]], 1);
    this.mesh = {array, buffer, size: mesh.triangles.length};
  }

  #picture() {
    const {gl} = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, SHADOW_SIZE, SHADOW_SIZE, 0, gl.RGBA,
      gl.UNSIGNED_BYTE, null);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return {texture, frame};
  }

  draw(scene) {
    const {gl, canvas} = this;
    gl.bindVertexArray(this.mesh.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.mesh.buffer);
    gl.bufferData(gl.ARRAY_BUFFER,
      scene.capsules.values.subarray(0, CAPSULE * scene.capsules.count), gl.DYNAMIC_DRAW);
    this.#drawShadow(scene);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.clearColor(...scene.theme.backdrop, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.#drawFloor(scene);
    this.capsule.use({clip_from_world: scene.clipFromWorld, eye: scene.eye, light: LIGHT,
      sky: scene.theme.sky, ground: scene.theme.bounce});
    this.#drawCapsules(scene);
    this.#drawLines(scene);
  }

  #drawCapsules(scene) {
    const {gl} = this;
    gl.bindVertexArray(this.mesh.array);
    gl.drawElementsInstanced(gl.TRIANGLES, this.mesh.size, gl.UNSIGNED_SHORT, 0,
      scene.capsules.count);
  }

  #drawShadow(scene) {
    const {gl} = this;
    const {centre, half} = scene.shadow;
    gl.viewport(0, 0, SHADOW_SIZE, SHADOW_SIZE);
    gl.disable(gl.DEPTH_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadows[0].frame);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendEquation(gl.MAX);
    this.caster.use({clip_from_world: shadowFromWorld(centre, half, LIGHT)});
    this.#drawCapsules(scene);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(this.quad.array);
    // Blur widths in metres, independent of the area.
    const tight = 0.006 / half;
    const wide = 0.016 / half;
    for (const [from, to, x, y] of [[0, 1, 1, 0], [1, 0, 0, 1]]) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadows[to].frame);
      gl.bindTexture(gl.TEXTURE_2D, this.shadows[from].texture);
      this.blur.use({shadow: 0, step_tight: [x * tight, y * tight],
        step_wide: [x * wide, y * wide]});
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }

  #drawFloor(scene) {
    const {gl} = this;
    gl.bindTexture(gl.TEXTURE_2D, this.shadows[0].texture);
    gl.bindVertexArray(this.quad.array);
    const {theme, shadow} = scene;
    this.floor.use({clip_from_world: scene.clipFromWorld, target: scene.target, reach: 14,
      backdrop: theme.backdrop, ground_colour: theme.ground, line_colour: theme.grid,
      shadow_area: [shadow.centre[0], shadow.centre[2], shadow.half],
      shadow_depth: theme.shadow, shadow: 0});
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  #drawLines(scene) {
    if (scene.lines.length === 0) return;
    const {gl} = this;
    gl.bindVertexArray(this.lines.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lines.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, scene.lines, gl.DYNAMIC_DRAW);
    this.line.use({clip_from_world: scene.clipFromWorld});
    gl.drawArrays(gl.LINES, 0, scene.lines.length / 6);
  }

  /** Returns the number of different colours of the last drawing, on a coarse grid of pixels.
   *  Only valid before the browser has shown it. */
  coloursDrawn() {
    const {gl, canvas} = this;
    const pixels = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return countColours(pixels);
  }
}

function countColours(pixels) {
  const seen = new Set();
  for (let i = 0; i < pixels.length; i += 4 * 7) {
    seen.add((pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2]);
  }
  return seen.size;
}
