// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/library/build/build_inputs.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// Adds to the records what depends on all clips together: labels and corrections by
/// people, duplicates, splits. `search` is the name of the folder of their rows.
/// Errors: those of the readers of labels and rows.
[[nodiscard]] Status relate_clips(const BuildInputs& inputs,
                                  const std::string& search,
                                  std::vector<ClipRecord>& records,
                                  std::vector<std::string>& remarks);

}  // namespace marey::app
