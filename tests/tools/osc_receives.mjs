// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// node osc_receives.mjs SEND_VMC COUNT: has SEND_VMC send COUNT frames and reads them with
// npm's osc. Exit 1 when one is lost or incorrect; 77 without osc.
import { spawn } from 'node:child_process';
import { once } from 'node:events';

let osc;
let frames;
try {
  osc = (await import('osc')).default;
  frames = await import('./vmc_frames.mjs');
} catch {
  console.log('skipped: osc is missing; run `npm ci` in tests/tools');
  process.exit(77);
}

const [program, count] = process.argv.slice(2);
const judge = new frames.FrameJudge();
const port = new osc.UDPPort({ localAddress: '127.0.0.1', localPort: 0 });
port.on('error', (error) => {
  throw error;
});
port.on('bundle', ({ packets }) => judge.take(packets));
port.open();
await once(port, 'ready');
const sender = spawn(program, [port.socket.address().port, count], { stdio: 'inherit' });
const [code] = await once(sender, 'exit');
// The last packets have left the kernel's queue, but not node's.
await new Promise((resolve) => setTimeout(resolve, 100));
port.close();
process.exit(code === 0 ? judge.verdict('osc', Number(count)) : 1);
