// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: what each joint centre of a bundle was found from.

#include <span>
#include <vector>

#include "reconstruct/fit_markers.h"
#include "reconstruct/marker_bundle.h"
#include "reconstruct/marker_instants.h"

namespace marey::reconstruct {

/// Of every bone but the hips, after adjust() with sigmas. `exact` tells of each marker
/// of the bundle whether its name says where it is.
[[nodiscard]] std::vector<JointEvidence> joint_evidence(
    const MarkerBundle& bundle,
    std::span<const Snapshot> snapshots,
    const Proportions& average,
    const std::vector<bool>& exact);

}  // namespace marey::reconstruct
