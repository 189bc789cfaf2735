// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The report on labelled markers. app/markers/marker_report.cpp writes its data.

import {Theme} from '../base/theme';
import {plural} from '../base/words';
import {byId, fillSection, mm, linkSections, paragraph, readData, reportStatus, trialChooser}
  from '../report/common';
import type {MarkersData} from '../report/data';
import {curvesSection} from '../report/marker_curves';
import {samplesSection} from '../report/marker_fates';
import {headSection, jointsSection, labelsSection, residualsSection}
  from '../report/marker_sections';
import {stillsSection} from '../report/marker_stills';
import {pageLink} from '../report/page_links';
import {Player} from '../report/player';

/** Sections that only a fit has. */
const FIT_SECTIONS = ['residuals', 'stills', 'joints'];

const data = readData<MarkersData>();
const {figures, fates} = data;
const isFit = data.kind === 'fit';
const player = new Player(new Theme());

function showTrial(chosen: number): void {
  const [trial, figure] = [data.trials[chosen], figures.trials[chosen]];
  player.load(figure.frames, figure.rate_hz, trial.first_frame);
  fillSection('samples', samplesSection(player, data, trial, figure));
  fillSection('curves', curvesSection(trial, figure, fates, player.theme));
  const about = [plural(figure.frames, 'frame'), `${Number(figure.rate_hz.toFixed(3))} Hz`];
  if (isFit) {
    fillSection('residuals', residualsSection(player, data, trial, figure));
    fillSection('stills', trial.stills.length > 0 ? stillsSection(data, trial, figure)
      : [paragraph('This trial was not solved.')]);
    about.push(figure.rms_mm === null ? 'not solved' : `RMS ${mm(figure.rms_mm)}`);
  }
  const link = isFit && figure.trial && figure.rms_mm !== null
    ? pageLink(figure.trial, null, 'on the page') : null;
  byId('trial-about').replaceChildren(`${about.join(', ')} `, link ?? '');
}

if (!isFit) FIT_SECTIONS.forEach((id) => byId(id).remove());
linkSections(data.marey_version);
headSection(data);
trialChooser(figures.trials.map(({trial, file}) => trial ?? file), showTrial);
if (isFit) fillSection('joints', jointsSection(data));
fillSection('labels', labelsSection(data));
reportStatus();
