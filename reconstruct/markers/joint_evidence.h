// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: source of each joint centre of a bundle.

#include <span>
#include <vector>

#include "reconstruct/markers/marker_bundle.h"
#include "reconstruct/markers/marker_instants.h"
#include "reconstruct/markers/markers_fit.h"

namespace marey::reconstruct {

/// Returns the evidence of every bone except the hips. `exact` states for each marker of
/// the bundle whether its name determines its place. Precondition: adjust() with sigmas.
[[nodiscard]] std::vector<JointEvidence> joint_evidence(
    const MarkerBundle& bundle,
    std::span<const Snapshot> snapshots,
    const Proportions& average,
    const std::vector<bool>& exact);

}  // namespace marey::reconstruct
