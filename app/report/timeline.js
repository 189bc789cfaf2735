// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Visibility of tags over time, and the bridged gaps.

const ROW_PX = 13;
const GROUP_GAP_PX = 5;

/** Returns rows of tags, grouped by segment, in the order of the session. */
function groupTags(tags) {
  const groups = new Map();
  for (const tag of tags) {
    if (!groups.has(tag.segment)) groups.set(tag.segment, []);
    groups.get(tag.segment).push({id: tag.id, cameras: bytesOf(tag.cameras)});
  }
  return groups;
}

/** Returns the maximum number of cameras that saw one of the tags at once. */
function mostSeeing(groups) {
  let most = 1;
  for (const tag of [...groups.values()].flat()) {
    for (const count of tag.cameras) most = Math.max(most, count);
  }
  return most;
}

/** Returns the shade for a number of cameras. */
function seenColour(count, most) {
  const [none, all] = [rgb('seen-none'), rgb('seen-all')];
  return cssRgb(mix(none, all, count === 0 ? 0 : 0.3 + 0.7 * count / Math.max(most, 1)));
}

function tagMatrix(player, groups, cameras, firstFrame) {
  const rows = [];
  const labels = [];
  let top = 0;
  for (const [segment, members] of groups) {
    labels.push(el('span', {style: `top: ${top}px`, class: 'segment'}, boneWords(segment)));
    for (const tag of members) {
      labels.push(el('span', {style: `top: ${top}px`, class: 'tag'}, String(tag.id)));
      rows.push({...tag, segment, top});
      top += ROW_PX;
    }
    top += GROUP_GAP_PX;
  }
  const paint = (context, width) => {
    const shades = Array.from({length: cameras + 1}, (_, i) => seenColour(i, cameras));
    const cell = width / player.frames;
    for (const row of rows) {
      context.fillStyle = shades[0];
      context.fillRect(0, row.top, width, ROW_PX - 1);
      row.cameras.forEach((count, frame) => {
        if (count === 0) return;
        context.fillStyle = shades[Math.min(count, cameras)];
        // A little wider than the cell, to avoid visible seams.
        context.fillRect(frame * cell, row.top, cell + 0.4, ROW_PX - 1);
      });
    }
  };
  const canvas = paintedCanvas(Math.max(top, 1), paint, {role: 'img',
    'aria-label': 'Rows are tags, columns are frames, shade is the number of cameras'});
  const readout = (frame, event) => {
    const y = event.clientY - canvas.getBoundingClientRect().top;
    const row = rows.find((r) => y >= r.top && y < r.top + ROW_PX + GROUP_GAP_PX);
    return row ? `tag ${row.id}, frame ${frame + firstFrame}: ${
      plural(row.cameras[frame] ?? 0, 'camera', 'cameras')}` : '';
  };
  return el('div', {class: 'graph'},
    el('div', {class: 'gutter', style: `height: ${top}px`}, ...labels),
    overFrames(player, canvas, readout),
    el('div', {class: 'gutter'}), frameAxis(player, firstFrame));
}

function seenLegend(cameras) {
  return el('ul', {class: 'legend'}, ...Array.from({length: cameras + 1}, (_, i) =>
    el('li', {}, el('span', {class: 'swatch', style: `background: color-mix(in srgb, ` +
      `var(--seen-all) ${i === 0 ? 0 : 30 + 70 * i / cameras}%, var(--seen-none))`}),
    i === 0 ? ' unseen' : ` ${plural(i, 'camera', 'cameras')}`)));
}

/** Draws one row per segment with gaps: their frames and their repair. */
function gapRows(player, gaps, firstFrame) {
  const segments = [...new Set(gaps.map((gap) => gap.segment))];
  const height = 20;
  const labels = segments.map((segment, i) =>
    el('span', {style: `top: ${i * height}px`, class: 'segment'}, boneWords(segment)));
  const bars = gaps.map((gap) => {
    const left = 100 * (gap.first_frame - firstFrame) / player.frames;
    const width = 100 * (gap.last_frame - gap.first_frame + 1) / player.frames;
    return el('span', {class: `bar fill-${gap.bridged_as}`, style:
      `left: ${left}%; width: ${width}%; top: ${segments.indexOf(gap.segment) * height}px`});
  });
  const content = el('div', {class: 'bars', style: `height: ${segments.length * height}px`},
    ...bars);
  const readout = (frame, event) => {
    const y = event.clientY - content.getBoundingClientRect().top;
    const segment = segments[Math.floor(y / height)];
    const gap = gaps.find((g) => g.segment === segment &&
      frame + firstFrame >= g.first_frame && frame + firstFrame <= g.last_frame);
    return gap ? `${boneWords(segment)}: ${gap.bridged_as}, ${duration(gap.duration_s)}` : '';
  };
  return el('div', {class: 'graph'},
    el('div', {class: 'gutter', style: `height: ${segments.length * height}px`}, ...labels),
    overFrames(player, content, readout),
    el('div', {class: 'gutter'}), frameAxis(player, firstFrame));
}

function gapTable(gaps, trial) {
  const longestFirst = [...gaps].sort((a, b) => b.duration_s - a.duration_s);
  return table([
    {title: 'Segment', cell: (gap) => boneWords(gap.segment)},
    {title: 'Frames', number: true, cell: (gap) => {
      const words = `${gap.first_frame} – ${gap.last_frame}`;
      return pageLink(trial, gap.first_frame, words) ?? words;
    }},
    {title: 'Length', number: true, cell: (gap) => `${fixed(gap.duration_s, 2)} s`},
    {title: 'Bridged as', cell: (gap) =>
      el('span', {class: `chip chip-${gap.bridged_as}`}, gap.bridged_as)},
  ], longestFirst, 'Gaps, the longest first');
}

function tagsSection(player, trial, figures) {
  const {gaps, first_frame: first} = figures;
  const groups = groupTags(trial.tags);
  const most = mostSeeing(groups);
  const lost = gaps.reduce((sum, gap) => sum + gap.duration_s, 0);
  return [
    el('p', {class: 'lead'}, 'Every row is a tag, every column a frame. The darker, the ' +
      'more cameras saw it: two or more fix a tag well, one still does, none leaves a gap.'),
    seenLegend(most),
    tagMatrix(player, groups, most, first),
    el('h3', {}, 'Gaps'),
    ...(gaps.length === 0
      ? [el('p', {}, 'None: every segment was seen in every frame.')]
      : [el('p', {class: 'lead'}, `${plural(gaps.length, 'time', 'times')} a segment with ` +
          `tags was out of sight, ${duration(lost)} in all. What was not seen is marked so ` +
          'in every file that marey writes.'),
        sourceLegend(false, SOURCES.slice(1)), gapRows(player, gaps, first),
        el('details', {}, el('summary', {}, 'All gaps as a table'),
          gapTable(gaps, figures.name))]),
  ];
}
