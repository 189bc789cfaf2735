// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_collector.h"

namespace marey::calib {

/// Appends findings about too few or too similar views. For each camera: instants with
/// the moving target (fair below 10, poor below 4); the covered share of its image (fair
/// below 30 %, poor below 6.25 %) or of one half of it (below 15 % with 40 % of the other
/// half); the 90 % quantile of the board's tilt (fair below 15 degrees; boards only). For
/// pairs of cameras on the strongest spanning tree of shared views: fewer than
/// kFairShared instants (fair).
void assess_target_views(FindingCollector& list);

}  // namespace marey::calib
