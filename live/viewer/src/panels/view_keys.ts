// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Keys that all pages with a scene and a timeline have.

import type {Help} from './help';
import type {Panels} from './panels';
import type {Stage} from '../scene/stage';
import type {Playback} from '../timeline/playback';
import type {Transport} from '../timeline/transport';

export interface KeyParts {
  playback: Playback; transport: Transport; stage: Stage; panels: Panels; help: Help;
  /** Shows a frame. */
  seek(frame: number): void;
}

export function viewKeys({playback, transport, stage, panels, help, seek}: KeyParts):
  Record<string, (event: KeyboardEvent) => void> {
  const stride = (event: KeyboardEvent): number =>
    (event.shiftKey ? Math.max(1, Math.round(playback.rate_hz)) : 1);
  return {
    ' ': () => transport.toggle(),
    ArrowLeft: (event) => transport.step(-stride(event)),
    ArrowRight: (event) => transport.step(stride(event)),
    Home: () => seek(playback.first),
    End: () => seek(playback.last),
    l: () => transport.setLoop(!playback.loop),
    f: () => stage.frameBodies(),
    1: () => stage.viewFrom('front'),
    2: () => stage.viewFrom('left'),
    3: () => stage.viewFrom('above'),
    '+': () => stage.orbit.zoom(0.9),
    '-': () => stage.orbit.zoom(1 / 0.9),
    d: () => transport.toggleFold(),
    p: () => panels.set(!panels.shown),
    '?': () => help.toggle(),
  };
}
