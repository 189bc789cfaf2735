// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The connection to marey. Reconnects automatically, at once when the page becomes visible.

import type {PageWords, ServerWords} from './protocol';
import {PROTOCOL_VERSION, readServerWords} from './protocol';

const RETRY_MS = 500;
/** A connection that neither opens nor fails, as after a network change. */
const OPENING_MS = 3000;

export interface Listener {
  words(words: ServerWords): void;
  binary(buffer: ArrayBuffer): void;
  state(state: 'open' | 'lost'): void;
  trouble(text: string): void;
}

export class Connection {
  private socket: WebSocket | null = null;
  private timer = 0;
  private received_ms = 0;
  private readonly address: string;
  private readonly listener: Listener;

  constructor(listener: Listener) {
    const {protocol, host, search} = window.location;
    // The token in the address is used once; a cookie replaces it.
    this.address = `${protocol === 'https:' ? 'wss' : 'ws'}://${host}/live${search}`;
    this.listener = listener;
    document.addEventListener('visibilitychange', () => {
      if (!document.hidden && !this.socket) this.open();
    });
    window.addEventListener('online', () => {
      if (!this.socket) this.open();
    });
    this.open();
  }

  /** Replaces a connection that has received nothing for this time. */
  renewAfter(silence_ms: number): void {
    if (this.socket?.readyState !== WebSocket.OPEN) return;
    if (performance.now() - this.received_ms > silence_ms) this.drop(this.socket);
  }

  send(words: PageWords): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(words));
    return true;
  }

  private open(): void {
    window.clearTimeout(this.timer);
    const socket = new WebSocket(this.address);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    const patience = window.setTimeout(() => this.drop(socket), OPENING_MS);
    socket.onopen = () => {
      window.clearTimeout(patience);
      this.received_ms = performance.now();
      this.send({type: 'hello', version: PROTOCOL_VERSION});
      this.listener.state('open');
    };
    socket.onmessage = ({data}) => {
      if (this.socket !== socket) return;
      this.received_ms = performance.now();
      if (typeof data === 'string') this.read(data);
      else this.listener.binary(data as ArrayBuffer);
    };
    socket.onclose = () => {
      window.clearTimeout(patience);
      this.drop(socket);
    };
  }

  /** Abandons a connection that does not close in time and opens another. */
  private drop(socket: WebSocket): void {
    if (this.socket !== socket) return;
    this.socket = null;
    socket.close();
    this.listener.state('lost');
    this.timer = window.setTimeout(() => this.open(), RETRY_MS);
  }

  private read(text: string): void {
    const words = readServerWords(text);
    if (words.type === 'bad') this.listener.trouble(words.why);
    else this.listener.words(words);
  }
}
