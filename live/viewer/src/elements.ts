// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Short constructors for elements of the page.

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined |
  ((event: never) => void)>;

/** Attributes that begin with "on" are listeners; null, undefined and false leave one out. */
export function el<K extends keyof HTMLElementTagNameMap>(name: K, attributes: Attributes = {},
  ...children: Child[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') {
      made.addEventListener(key.slice(2), value as (event: Event) => void);
    } else if (value !== null && value !== undefined && value !== false) {
      made.setAttribute(key, value === true ? '' : String(value));
    }
  }
  made.append(...children.filter((child): child is Node | string =>
    child !== null && child !== undefined && child !== false));
  return made;
}

/** Sets the text only if it differs, so that a screen reader does not repeat it. */
export function setText(node: HTMLElement, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

/** Reuses the elements of rows that are rewritten often. */
export function keepRows<T>(parent: HTMLElement, items: readonly T[],
  make: () => HTMLElement, write: (row: HTMLElement, item: T, index: number) => void): void {
  while (parent.childElementCount > items.length) parent.lastElementChild!.remove();
  items.forEach((item, i) => {
    const row = (parent.children[i] as HTMLElement | undefined) ?? parent.appendChild(make());
    write(row, item, i);
  });
}

/** Returns the value stored in this browser, if storage is available. */
export function remembered(key: string): string | null {
  try {
    return localStorage.getItem(`marey.${key}`);
  } catch {
    return null;
  }
}

export function remember(key: string, value: string): void {
  try {
    localStorage.setItem(`marey.${key}`, value);
  } catch {
    // Private windows may refuse storage; it is optional.
  }
}
