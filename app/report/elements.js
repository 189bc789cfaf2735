// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Elements and words. Text is always set as text: names in a report come from untrusted
// files and are never parsed as markup.

function fillElement(node, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) {
      node.addEventListener(key.slice(2), value);
    } else if (value !== null && value !== undefined && value !== false) {
      node.setAttribute(key, value === true ? '' : value);
    }
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

function el(tag, attributes = {}, ...children) {
  return fillElement(document.createElement(tag), attributes, children);
}

function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  return fillElement(node, attributes, children);
}

/** `columns`: {title, number?, cell(row)}; a cell is text or an element. */
function table(columns, rows, caption) {
  const kind = (column) => (column.number ? 'number' : null);
  return el('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption},
    el('table', {},
      el('caption', {class: 'unseen'}, caption),
      el('thead', {}, el('tr', {},
        ...columns.map((c) => el('th', {class: kind(c), scope: 'col'}, c.title)))),
      el('tbody', {}, ...rows.map((row) => el('tr', {},
        ...columns.map((c, i) =>
          el(i === 0 ? 'th' : 'td', {class: kind(c), scope: i === 0 ? 'row' : null},
            c.cell(row))))))));
}

/** Formats a number with a minus sign. */
/** Formats a number; a dash if nothing was measured. */
const fixed = (value, decimals) =>
  (value === null ? '–' : value.toFixed(decimals).replace('-', '−'));
const plural = (count, one, many) => `${count} ${count === 1 ? one : many}`;

/** Formats a duration in words: "0.43 s", "41 s", "3 min 20 s". */
function duration(seconds) {
  if (seconds < 10) return `${fixed(seconds, 2)}\u00a0s`;
  if (seconds < 120) return `${fixed(seconds, 0)}\u00a0s`;
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)}\u00a0min ${whole % 60}\u00a0s`;
}

/** Converts "leftUpperArm" to "left upper arm"; other names are unchanged. */
function boneWords(name) {
  return /^[a-z]+([A-Z][a-z]+)*$/.test(name)
    ? name.replace(/[A-Z]/g, (letter) => ` ${letter.toLowerCase()}`)
    : name;
}

/** Returns a link to a file next to the report, with any name. Under `marey view`, which
 *  serves no files, returns the name only. */
function fileLink(path) {
  if (location.protocol === 'http:') return el('span', {class: 'file'}, path.split('/').pop());
  const address = `./${path.split('/').map(encodeURIComponent).join('/')}`;
  return el('a', {href: address, class: 'file'}, path.split('/').pop());
}

