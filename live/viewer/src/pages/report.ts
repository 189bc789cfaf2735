// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The report of a session. app/pages/report_html.cpp writes its data.

import {Theme} from '../base/theme';
import {fixed, plural} from '../base/words';
import {BodyViewer} from '../report/body_viewer';
import {byId, fillSection, linkSections, paragraph, readData, reportStatus, trialChooser}
  from '../report/common';
import type {ReportData} from '../report/data';
import {pageLink} from '../report/page_links';
import {picturesSection} from '../report/pictures';
import {Player} from '../report/player';
import {drawnStatus} from '../report/report_cameras';
import {camerasSection} from '../report/room';
import {avatarsSection, headSection, subjectSection, timingsSection}
  from '../report/session_sections';
import {jointsSection, reprojectionSection, tagsSection} from '../report/trial_sections';

function showTrial({figures, trials, calibration_page}: ReportData, viewer: BodyViewer,
  player: Player, chosen: number): void {
  const [trial, figure] = [trials[chosen], figures.trials[chosen]];
  viewer.load(trial, figure);
  fillSection('pictures', picturesSection(player, trial, figure));
  fillSection('reprojection', reprojectionSection(player, trial, figure));
  fillSection('tags', tagsSection(player, trial, figure));
  fillSection('joints', jointsSection(figure));
  fillSection('cameras', camerasSection(figures.calibration, trial, calibration_page));
  byId('trial-about').replaceChildren(`${figure.frames_solved} of ` +
    `${plural(figure.frames, 'frame')} solved, ${fixed(figure.rms_px, 2)} px, ` +
    `joints ± ${fixed(figure.joint_sigma_median_mm, 1)} mm `,
  pageLink(figure.name, null, 'on the page') ?? '');
}

/** Plays while the viewer is visible, unless reduced motion is set. */
function playWhenSeen(viewer: BodyViewer, player: Player): void {
  if (matchMedia('(prefers-reduced-motion: reduce)').matches) return;
  let wasPlaying = true;
  let started = false;
  new IntersectionObserver(([{isIntersecting}]) => {
    if (isIntersecting === started) return;
    if (!isIntersecting) wasPlaying = player.playback.playing;
    started = isIntersecting;
    player.play(started && wasPlaying);
  }, {threshold: 0.15}).observe(viewer.stage.element);
}

const data = readData<ReportData>();
const {figures} = data;
linkSections(figures.marey_version);
headSection(figures);
if (figures.subject) fillSection('subject', subjectSection(figures.subject));
fillSection('avatars', avatarsSection(figures.trials));
fillSection('time', timingsSection(figures));
if (data.trials.length === 0) {
  fillSection('cameras', camerasSection(figures.calibration, null, data.calibration_page));
  for (const name of ['motion', 'pictures', 'reprojection', 'tags', 'joints']) {
    fillSection(name, [paragraph('No trial was solved.')]);
  }
  reportStatus();
} else {
  const player = new Player(new Theme());
  const viewer = new BodyViewer(player, figures.calibration.cameras);
  fillSection('motion', [viewer.root]);
  trialChooser(figures.trials.map(({name}) => name), (i) => showTrial(data, viewer, player, i));
  playWhenSeen(viewer, player);
  viewer.stage.draw();
  reportStatus(drawnStatus(viewer.stage.renderer));
}
