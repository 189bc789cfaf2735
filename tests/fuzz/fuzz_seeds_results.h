// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/motion.h"

namespace marey::fuzz {

/// Writes seeds of results and settings: npz, report, calibration, labels, settings,
/// take, vrma. False when one cannot be written.
[[nodiscard]] bool write_result_seeds(const std::filesystem::path& folder,
                                      const Motion& motion);

}  // namespace marey::fuzz
