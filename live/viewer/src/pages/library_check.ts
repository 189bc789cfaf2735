// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The page of a library's check. app/library/check/check_page.cpp writes its data.

import {byId, fillSection, linkSections, readData, reportStatus} from '../report/common';
import {ClipTable} from '../report/library_clips';
import {clipOf} from '../report/library_data';
import type {LibraryData} from '../report/library_data';
import {figureCharts} from '../report/library_figures';
import {headSection, problemsSection, sourcesSection} from '../report/library_sections';

const data = readData<LibraryData>();
const {summary} = data;
const clips = data.clips.map((row, i) => clipOf(row, summary, i));
const table = new ClipTable(clips, data);

headSection(data);
fillSection('figures', figureCharts(clips, summary.figures, (column) => {
  table.chooseFigure(column);
  byId('clips').scrollIntoView();
}));
fillSection('clips', table.elements);
fillSection('problems', problemsSection(summary, (kind) => {
  table.chooseKind(kind);
  byId('clips').scrollIntoView();
}));
fillSection('sources', sourcesSection(summary.failed));
for (const [id, isEmpty] of [['figures', clips.length === 0],
  ['problems', summary.kinds.length === 0], ['sources', summary.failed.length === 0]] as const) {
  if (isEmpty) byId(id).remove();
}
linkSections(summary.marey_version);
reportStatus({clips: String(clips.length), rows: String(table.shownRows)});
