// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A server with marey's protocol and without cameras, to develop, test and measure the
// page.

import {readFileSync, existsSync} from 'node:fs';
import {createServer} from 'node:http';
import {avatarFile} from './avatar_file.mjs';
import {fileScene, FIRST, liveScene, runAt, stageScene, statusAt, targetsAt, wizardAt} from './scenes.mjs';
import {pageFolder} from './installed.mjs';
import {PageSocket} from './socket.mjs';
import {encodeFrame} from './walker.mjs';
import {thumbnail} from './thumbnail.mjs';

const KINDS = {html: 'text/html; charset=utf-8', js: 'text/javascript', css: 'text/css',
  svg: 'image/svg+xml'};
/** The policy that marey sends; the page must work with it. */
const POLICY = "default-src 'self'; img-src 'self' blob: data:; connect-src 'self'; " +
  "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

export class MockServer {
  /** Options: mode ('live', 'file' or 'stage', with the number `stage` of bodies), rate_hz, avatar (true, or the bytes of a file and its
   *  skeleton: {bytes, words}), frames, clock_s(), which returns the values of sent_s. */
  constructor({mode = 'live', rate_hz = 30, avatar = true, frames = 300, clock_s = null,
    stage = 40} = {}) {
    Object.assign(this, {mode, rate_hz, frames});
    this.clock_s = clock_s ?? (() => performance.now() / 1000);
    this.pages = new Set();
    /** All messages from pages. */
    this.heard = [];
    this.media = new Map();
    this.frame = 0;
    this.recording = null;
    /** The reason why takes fail; empty if they succeed. */
    this.recordingTrouble = '';
    this.wizard = null;
    /** State of a scene of marey stage, and the places of its targets that a page holds. */
    this.run = 'playing';
    this.held = {};
    this.scene = mode === 'live' ? liveScene(rate_hz, avatar)
      : mode === 'stage' ? stageScene(rate_hz, stage) : fileScene(rate_hz, frames, avatar);
    this.bodies = this.scene.skeletons.map(({estimate, kind}) =>
      ({estimate, balance: kind === 'performer', tracking: kind === 'performer', droop: kind === 'avatar' ? avatar.droop : 0}));
    if (avatar && mode !== 'stage') this.media.set('/media/1', avatar.bytes ?? avatarFile());
    if (mode === 'file') this.media.set('/media/2', this.#block());
  }

  #block() {
    const head = Buffer.alloc(16);
    head.write('MRMB');
    head.writeUInt32LE(1, 4);
    head.writeUInt32LE(this.frames, 8);
    head.writeUInt32LE(this.bodies.length, 12);
    return Buffer.concat([head, ...Array.from({length: this.frames}, (_, i) =>
      encodeFrame(this.bodies, i + FIRST, (i + FIRST) / this.rate_hz, 0))]);
  }

  /** Returns the address. */
  async start(port = 0) {
    this.server = createServer((request, response) => this.#answer(request, response));
    this.server.on('upgrade', (request, socket) => this.#connect(request, socket));
    await new Promise((done) => this.server.listen(port, '127.0.0.1', done));
    this.port = this.server.address().port;
    if (this.mode !== 'file') this.#goOn();
    return `http://127.0.0.1:${this.port}/`;
  }

  async stop() {
    for (const timer of this.timers ?? []) clearInterval(timer);
    for (const page of this.pages) page.close();
    this.server.closeAllConnections();
    await new Promise((done) => this.server.close(done));
  }

  say(words) {
    const text = JSON.stringify(words);
    for (const page of this.pages) page.send(text);
  }

  #answer(request, response) {
    const path = new URL(request.url, 'http://mock').pathname;
    const media = this.media.get(path);
    const name = path === '/' ? 'index.html' : path.slice(1);
    const file = /^[a-z]+\.(html|js|css|svg)$/.test(name) && existsSync(pageFolder + name)
      ? readFileSync(pageFolder + name) : null;
    const body = media ?? file;
    response.writeHead(body ? 200 : 404, {
      'Content-Type': file ? KINDS[name.split('.').pop()] : 'application/octet-stream',
      'Content-Security-Policy': POLICY, 'X-Content-Type-Options': 'nosniff',
      'Cache-Control': 'no-store'});
    response.end(body ?? 'not here');
  }

  #connect(request, socket) {
    if (!request.url.startsWith('/live')) {
      socket.destroy();
      return;
    }
    const page = new PageSocket(request, socket, (text) => this.#hear(page, text),
      () => this.pages.delete(page));
    this.pages.add(page);
    page.send(JSON.stringify(this.scene));
    if (this.mode === 'live') page.send(JSON.stringify(statusAt(this)));
    if (this.wizard) page.send(JSON.stringify(wizardAt(this.wizard)));
  }

  /** Frames at their rate, status twice a second, pictures four times. Timers of a few
   *  milliseconds, as node's timers are 1 ms late. */
  #goOn() {
    const start = performance.now();
    const send = () => {
      const due = Math.floor((performance.now() - start) / 1000 * this.rate_hz);
      if (due <= this.frame) return;
      this.frame = due;
      if (this.silent) return;
      const bytes = encodeFrame(this.bodies, due, due / this.rate_hz, this.clock_s());
      for (const page of this.pages) page.send(bytes);
      if (this.mode === 'stage') this.say(targetsAt(due / this.rate_hz, this.held));
    };
    const tell = () => {
      if (this.silent) return;
      this.say(this.mode === 'stage' ? runAt(this.run, this.frame / this.rate_hz)
        : statusAt(this));
    };
    const show = () => {
      for (const page of this.pages) {
        if (page.wantsPictures && !this.silent) page.send(thumbnail(this.frame));
      }
    };
    this.timers = [setInterval(send, 2), setInterval(tell, 500), setInterval(show, 250)];
  }

  #hear(page, text) {
    const words = JSON.parse(text);
    this.heard.push(words);
    if (words.type === 'thumbnails') page.wantsPictures = words.on;
    if (words.type === 'record') this.recording = words.on ? performance.now() : null;
    if (words.type === 'wizard') this.#wizard(words.action);
    if (words.type === 'run') this.run = words.action === 'pause' ? 'paused' : 'playing';
    if (words.type === 'run') this.say(runAt(this.run, this.frame / this.rate_hz));
    if (this.mode === 'stage') this.#hold(words);
    else if (words.type === 'constraint') this.#constraint(words.id, {active: words.active});
    else if (words.type === 'drag') this.#drag(page, words);
    if (words.type === 'record') this.say(statusAt(this));
  }

  #hold({type, id, p_in_world, active}) {
    const i = this.scene.constraints.findIndex((one) => one.id === id);
    if (type === 'drag') this.held[i] = p_in_world;
    if (type === 'constraint' && !active) delete this.held[i];
  }

  #constraint(id, change) {
    this.scene.constraints = this.scene.constraints.map((constraint) =>
      (constraint.id === id ? {...constraint, ...change} : constraint));
    this.say({type: 'constraints', constraints: this.scene.constraints});
  }

  #drag(page, {id, p_in_world, phase, frame}) {
    if (this.mode === 'live') {
      if (phase !== 'begin') this.#constraint(id, {p_in_world});
      return;
    }
    // The whole body rises by the same distance as the hand.
    const raised = this.bodies.map((body) => ({...body, raise: 0.1}));
    page.send(encodeFrame(raised, frame, frame / this.rate_hz, 0));
  }

  #wizard(action) {
    const next = {start: 'stand', cancel: 'idle', accept: 'idle',
      next: {stand: 'move', move: 'done'}[this.wizard] ?? 'idle'};
    this.wizard = next[action];
    this.say(wizardAt(this.wizard));
  }
}
