// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Short constructors for elements of the page.

export type Child = Node | string | null | undefined | false;
export type Attributes = Record<string, string | number | boolean | null | undefined |
  ((event: never) => void)>;

function fill<E extends Element>(node: E, attributes: Attributes, children: Child[]): E {
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') {
      node.addEventListener(key.slice(2), value as (event: Event) => void);
    } else if (value !== null && value !== undefined && value !== false) {
      node.setAttribute(key, value === true ? '' : String(value));
    }
  }
  node.append(...children.filter((child): child is Node | string =>
    child !== null && child !== undefined && child !== false));
  return node;
}

/** Attributes that begin with "on" are listeners; null, undefined and false leave one out.
 *  Text is never parsed as markup: names come from untrusted files. */
export function el<K extends keyof HTMLElementTagNameMap>(name: K, attributes: Attributes = {},
  ...children: Child[]): HTMLElementTagNameMap[K] {
  return fill(document.createElement(name), attributes, children);
}

export function svg<K extends keyof SVGElementTagNameMap>(name: K, attributes: Attributes = {},
  ...children: Child[]): SVGElementTagNameMap[K] {
  return fill(document.createElementNS('http://www.w3.org/2000/svg', name), attributes, children);
}

export function button(attributes: Attributes, ...children: Child[]): HTMLButtonElement {
  return el('button', {type: 'button', ...attributes}, ...children);
}

export function checkbox(label: string, checked: boolean, changed: (on: boolean) => void,
  attributes: Attributes = {}): HTMLLabelElement {
  const box = el('input', {type: 'checkbox', checked, onchange: () => changed(box.checked)});
  return el('label', attributes, box, ` ${label}`);
}

/** Returns a chooser of [value, text] pairs. */
export function chooser(options: readonly (readonly [string | number, string])[],
  chosen: string | number, changed: (value: string) => void,
  attributes: Attributes = {}): HTMLSelectElement {
  const made = el('select', {...attributes, onchange: () => changed(made.value)},
    ...options.map(([value, text]) => el('option', {value, selected: value === chosen}, text)));
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
