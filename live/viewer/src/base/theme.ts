// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Dark or light theme, and the colours of styles/colours.css that canvases use.

import {el, remember, remembered} from './elements';

export type Choice = 'system' | 'light' | 'dark';
const CHOICES: readonly Choice[] = ['system', 'light', 'dark'];

export class Theme {
  choice: Choice = 'system';
  private readonly probe = el('span', {hidden: true});
  private readonly listeners: (() => void)[] = [];
  private readonly known = new Map<string, string>();

  constructor() {
    document.body.append(this.probe);
    const kept = remembered('theme') as Choice | null;
    if (kept && CHOICES.includes(kept)) this.choice = kept;
    this.apply();
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
      this.changed();
    });
  }

  onChange(then: () => void): void {
    this.listeners.push(then);
  }

  /** True if the dark theme is active, by choice or by the system. */
  get dark(): boolean {
    if (this.choice !== 'system') return this.choice === 'dark';
    return window.matchMedia('(prefers-color-scheme: dark)').matches;
  }

  choose(choice: Choice): void {
    this.choice = choice;
    remember('theme', choice);
    this.apply();
    this.changed();
  }

  /** Returns the colour --`name`, or a CSS function of colours, as the browser computes it. */
  colour(name: string): string {
    let colour = this.known.get(name);
    if (colour === undefined) {
      this.probe.style.color = name.includes('(') ? name : `var(--${name})`;
      colour = getComputedStyle(this.probe).color;
      this.known.set(name, colour);
    }
    return colour;
  }

  private apply(): void {
    const {dataset} = document.documentElement;
    if (this.choice === 'system') delete dataset.theme;
    else dataset.theme = this.choice;
  }

  private changed(): void {
    this.known.clear();
    for (const then of this.listeners) then();
  }
}

// Cividis (Nunez, Anderton, Renslow 2018), which looks the same to colour-blind readers.
const CIVIDIS = [[0, 0.135, 0.305], [0.2, 0.27, 0.43], [0.42, 0.42, 0.445], [0.65, 0.6, 0.47],
  [0.87, 0.78, 0.37], [1, 0.92, 0.27]];

/** Returns the colour of an error or uncertainty; `share` 0 is none, 1 the end of the scale. */
export function scaleColour(share: number): string {
  const place = Math.min(Math.max(share, 0), 1) * (CIVIDIS.length - 1);
  const i = Math.min(Math.floor(place), CIVIDIS.length - 2);
  const parts = CIVIDIS[i].map((low, k) => low + (place - i) * (CIVIDIS[i + 1][k] - low));
  return `rgb(${parts.map((part) => Math.round(255 * part)).join(', ')})`;
}

/** Returns the CSS value of the whole scale. */
export function scaleGradient(): string {
  const stops = CIVIDIS.map((_, i) => scaleColour(i / (CIVIDIS.length - 1)));
  return `linear-gradient(to right, ${stops.join(', ')})`;
}
