// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/library/build/build_inputs.h"
#include "app/library/build/source_outcome.h"

namespace marey::app {

/// Writes failed/SOURCE.txt for every source that gave nothing: its place, the cause and
/// the next step. Removes the files of other sources. Errors (kDevice): the disk.
[[nodiscard]] Status write_failed_sources(const BuildInputs& inputs,
                                          const std::vector<SourceOutcome>& outcomes);

}  // namespace marey::app
