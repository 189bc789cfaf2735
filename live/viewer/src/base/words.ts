// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Numbers, durations and names as words.

/** Formats a number with a minus sign; a dash if nothing was measured. */
export function fixed(value: number | null | undefined, decimals: number): string {
  return value === null || value === undefined ? '–' : value.toFixed(decimals).replace('-', '−');
}

export function plural(count: number, one: string, many = `${one}s`): string {
  return `${count} ${count === 1 ? one : many}`;
}

/** Formats a duration: "0.43 s", "41 s", "3 min 20 s". */
export function duration(seconds: number): string {
  if (seconds < 10) return `${fixed(seconds, 2)}\u00a0s`;
  if (seconds < 120) return `${fixed(seconds, 0)}\u00a0s`;
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)}\u00a0min ${whole % 60}\u00a0s`;
}

export function percent(share: number): string {
  const value = 100 * share;
  // 100 % is shown only for all, and 0 % only for none.
  if (value > 99.9 && share < 1) return '> 99.9\u00a0%';
  if (value < 0.1 && share > 0) return '< 0.1\u00a0%';
  return `${fixed(value, value === 0 || value === 100 ? 0 : 1)}\u00a0%`;
}

/** Converts "leftUpperArm" to "left upper arm"; other names are unchanged. */
export function boneWords(name: string): string {
  return /^[a-z]+([A-Z][a-z]+)*$/.test(name)
    ? name.replace(/[A-Z]/g, (letter) => ` ${letter.toLowerCase()}`) : name;
}

export function short(value: number): string {
  const size = Math.abs(value);
  return size >= 100 ? value.toFixed(0) : size >= 10 ? value.toFixed(1) : value.toFixed(2);
}

export function capitalized(text: string): string {
  return text && text[0].toUpperCase() + text.slice(1);
}

/** 1.2 ms, 13 ms */
export function milliseconds(value: number): string {
  return `${value < 9.95 ? value.toFixed(1) : value.toFixed(0)} ms`;
}
