// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/pages/report.h"

namespace marey::app {

/// A body in motion as the page's viewer reads it (app/report/motion.js): points with
/// names and parents, then little-endian arrays in base64, frame by frame.
///
///   xyz     int16, three per point: origin_m + unit_m * value, in the world
///   turns   int16 / 32767, x y z w per joint: the rotation since the rest pose, in world
///           axes, so that turning +Z gives where a joint faces
///   source  uint8 per joint: 0 measured, 1 repaired, 2 inferred; subjects only
///   sigma   uint16 per joint, [0.1 mm]; subjects only
///
/// Joints come first, then tips. Hair, cloth and helpers of an avatar are left out: only
/// human bones and what hangs on the hands are kept, unless no joint is known to be
/// human. Precondition: every pose has one rotation per joint; the first joint is the
/// only root.
[[nodiscard]] nlohmann::ordered_json page_body(const ReportBody& body);

}  // namespace marey::app
