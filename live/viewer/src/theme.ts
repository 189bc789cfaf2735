// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Dark or light theme, and the colours of page.css that the canvas uses.

import {el, remember, remembered} from './elements';
import type {Source} from './protocol';
import {SOURCES} from './protocol';

export type Choice = 'system' | 'light' | 'dark';
const CHOICES: readonly Choice[] = ['system', 'light', 'dark'];

/** CSS colours, as rgb(...). */
export interface Colours {
  stage: string;
  floor: string;
  grid: string;
  line: string;
  shadow: string;
  ink: string;
  quiet: string;
  rule: string;
  card: string;
  accent: string;
  good: string;
  poor: string;
  none: string;
  subject: string;
  avatar: string;
  sources: [string, string, string];
}

export class Theme {
  choice: Choice = 'system';
  colours: Colours;
  private readonly probe = el('span', {hidden: true});
  private readonly listeners: (() => void)[] = [];

  constructor() {
    document.body.append(this.probe);
    const kept = remembered('theme') as Choice | null;
    if (kept && CHOICES.includes(kept)) this.choice = kept;
    this.apply();
    this.colours = this.read();
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

  private apply(): void {
    const {dataset} = document.documentElement;
    if (this.choice === 'system') delete dataset.theme;
    else dataset.theme = this.choice;
  }

  private changed(): void {
    this.colours = this.read();
    for (const then of this.listeners) then();
  }

  private colour(name: string): string {
    this.probe.style.color = `var(--${name})`;
    return getComputedStyle(this.probe).color;
  }

  private read(): Colours {
    return {
      stage: this.colour('stage'), floor: this.colour('stage-floor'),
      grid: this.colour('stage-grid'), line: this.colour('stage-line'),
      shadow: this.colour('stage-shadow'), ink: this.colour('ink'),
      quiet: this.colour('quiet'), rule: this.colour('rule'), card: this.colour('card'),
      accent: this.colour('accent'), good: this.colour('good'), poor: this.colour('poor'),
      none: this.colour('seen-none'), subject: this.colour('subject'),
      avatar: this.colour('avatar'),
      sources: SOURCES.map((source: Source) => this.colour(source)) as Colours['sources'],
    };
  }
}
