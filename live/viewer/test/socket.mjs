// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The part of WebSocket (RFC 6455) that the mock server needs: no fragments, no extensions.

import {createHash} from 'node:crypto';

const MAGIC = '258EAFA5-E914-47DA-95CA-C5AB0DC85B11';

/** Answers the handshake; `on_text(text)` receives the messages of the page. */
export class PageSocket {
  constructor(request, socket, on_text, closed) {
    const accept = createHash('sha1').update(request.headers['sec-websocket-key'] + MAGIC)
      .digest('base64');
    socket.write('HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n' +
      `Connection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`);
    socket.setNoDelay(true);
    this.socket = socket;
    this.waiting = Buffer.alloc(0);
    socket.on('data', (data) => {
      this.waiting = Buffer.concat([this.waiting, data]);
      for (let text = this.#next(); text !== null; text = this.#next()) {
        if (text !== '') on_text(text);
      }
    });
    socket.on('error', () => socket.destroy());
    socket.on('close', closed);
  }

  /** A text, or bytes. Dropped while much is unsent, as only the newest frame matters. */
  send(message) {
    const text = typeof message === 'string';
    if (!text && this.socket.writableLength > 1 << 20) return;
    const body = text ? Buffer.from(message) : message;
    const long = body.length > 65535;
    const head = Buffer.alloc(body.length < 126 ? 2 : long ? 10 : 4);
    head[0] = text ? 0x81 : 0x82;
    if (body.length < 126) head[1] = body.length;
    else if (long) {
      head[1] = 127;
      head.writeBigUInt64BE(BigInt(body.length), 2);
    } else {
      head[1] = 126;
      head.writeUInt16BE(body.length, 2);
    }
    this.socket.write(Buffer.concat([head, body]));
  }

  close() {
    this.socket.destroy();
  }

  /** Returns the next complete text, '' for other messages, null if no complete message
   *  remains. */
  #next() {
    const {waiting: data} = this;
    if (data.length < 2) return null;
    let length = data[1] & 127;
    let at = 2;
    if (length === 126) {
      if (data.length < 4) return null;
      length = data.readUInt16BE(2);
      at = 4;
    } else if (length === 127) {
      throw new Error('the message of the page is too long');
    }
    if (data.length < at + 4 + length) return null;
    const mask = data.subarray(at, at + 4);
    const body = Buffer.from(data.subarray(at + 4, at + 4 + length));
    for (let i = 0; i < length; ++i) body[i] ^= mask[i % 4];
    this.waiting = data.subarray(at + 4 + length);
    const kind = data[0] & 15;
    if (kind === 8) this.socket.end();
    return kind === 1 ? body.toString() : '';
  }
}
