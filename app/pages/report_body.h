// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/pages/report.h"

namespace marey::app {

/// Returns a body in motion in the format of the page's viewer
/// (live/viewer/src/report/recorded_body.ts): points with names and parents, then
/// little-endian arrays in base64, frame by frame.
///
///   xyz     int16, three per point: origin_m + unit_m * value, in the world
///   turns   int16 / 32767, x y z w per joint: the rotation since the rest pose, in world
///           axes, so that turning +Z gives where a joint faces
///   source  uint8 per joint: 0 measured, 1 repaired, 2 inferred; subjects only
///   sigma   uint16 per joint, [0.1 mm]; subjects only
///
/// Joints come first, then tips. Only human bones of an avatar and the joints below its
/// hands are kept, without hair, cloth and helpers. If no joint is known to be human, all
/// joints are kept. Preconditions: every pose has one rotation per joint; the first joint
/// is the only root.
[[nodiscard]] nlohmann::ordered_json page_body(const ReportBody& body);

}  // namespace marey::app
