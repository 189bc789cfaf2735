// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: cameras whose place has a second reading.

#include <optional>

#include "calib/calibrated_rig.h"
#include "calib/rig_model.h"

namespace marey::calib {

/// A flat board seen from afar reads two ways. Tests each camera that shares at most
/// eight instants with the others: whether the other reading of a shared view puts it
/// elsewhere and explains all its shared views as well. nullopt where none has a second
/// place. Cost: milliseconds for each such camera.
[[nodiscard]] std::optional<AmbiguousCamera> ambiguous_camera(const RigModel& model);

}  // namespace marey::calib
