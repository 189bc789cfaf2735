// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// node oscdump_receives.mjs SEND_VMC COUNT: has SEND_VMC send COUNT frames and parses the
// output of liblo's oscdump. Exit 1 when one is lost or incorrect; 77 without oscdump.
import { spawn, spawnSync } from 'node:child_process';
import dgram from 'node:dgram';
import { once } from 'node:events';
import { createInterface } from 'node:readline';
import { FrameJudge } from './vmc_frames.mjs';

if (spawnSync('oscdump', ['-h']).error) {
  console.log('skipped: oscdump is missing; apt-get install liblo-tools');
  process.exit(77);
}

/// A port that was free a moment ago.
async function freePort() {
  const socket = dgram.createSocket('udp4').bind(0, '127.0.0.1');
  await once(socket, 'listening');
  const { port } = socket.address();
  socket.close();
  return port;
}

/// "e4a5.3f10 /VMC/Ext/Bone/Pos sfffffff "Hips" 0.1 ...", as oscdump -L writes it.
function read(line) {
  const [, address, types = '', ...words] = line.trim().split(' ');
  const args = words.map((word, i) => (types[i] === 's' ? word.slice(1, -1) : Number(word)));
  return { address, args };
}

const [program, count] = process.argv.slice(2);
const port = await freePort();
const dump = spawn('oscdump', ['-L', port], { stdio: ['ignore', 'pipe', 'inherit'] });
const judge = new FrameJudge();
let frame = [];
createInterface({ input: dump.stdout }).on('line', (line) => {
  const message = read(line);
  // A bundle's messages come one after the other; each frame begins with OK.
  if (message.address === '/VMC/Ext/OK' && frame.length) judge.take(frame.splice(0));
  frame.push(message);
});
const sender = spawn(program, [port, count], { stdio: 'inherit' });
const [code] = await once(sender, 'exit');
dump.kill('SIGINT');
await once(dump, 'close');
judge.take(frame);
process.exit(code === 0 ? judge.verdict('oscdump', Number(count)) : 1);
