// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/library/clip_record.h"

namespace marey::testing {

struct SimulatedRecordsOptions {
  int clips = 100;
  int figures = 20;  ///< Per clip, 4 to 20.
  int labels = 10;   ///< Per clip, 2 or more: half by a table, half by marey.
  std::uint64_t seed = 1;
};

/// Returns records of a library of walks, runs, jumps and other motions, as a build makes
/// them: names, labels and figures fit together. Ten actors, files of one to five clips.
/// The first two labels are "content:WORD" and "style:WORD", and a figure is "speed_m_s"
/// (0 to 3). Same options, same records.
[[nodiscard]] std::vector<ClipRecord> simulated_records(
    const SimulatedRecordsOptions& options = {});

}  // namespace marey::testing
