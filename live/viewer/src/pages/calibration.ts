// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The report of a calibration. app/pages/calibration_html.cpp writes its data.

import {checksSection, headSection, outliersSection, parametersSection, togetherSection}
  from '../report/calibration_sections';
import {picturesSection} from '../report/camera_pictures';
import {fillSection, linkSections, readData, reportStatus} from '../report/common';
import type {RigData} from '../report/data';
import {errorsSection} from '../report/error_map';
import {drawnStatus} from '../report/report_cameras';
import {layoutSection, RigViewer} from '../report/rig_viewer';

const data = readData<RigData>();
const {figures} = data;
linkSections(figures.marey_version);
headSection(figures);
const viewer = new RigViewer(data);
fillSection('layout', layoutSection(figures, viewer));
fillSection('errors', errorsSection(figures));
fillSection('pictures', picturesSection(data));
fillSection('together', togetherSection(figures));
fillSection('checks', checksSection(figures));
fillSection('parameters', parametersSection(figures));
fillSection('outliers', outliersSection(figures));
viewer.stage.draw();
reportStatus(drawnStatus(viewer.stage.renderer));
