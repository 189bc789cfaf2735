// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "reconstruct/tracks/find_marker_faults.h"
#include "reconstruct/tracks/repair_gaps.h"

namespace marey::app {

/// A trial of markers, as read and as repaired.
struct Repair {
  std::string name;  ///< Name of the file.
  MarkerTracks as_read;
  reconstruct::CheckedTracks checked;
  reconstruct::RepairedTracks repaired;
};

/// Returns the content of OUT.repair.json; docs/formats/repair.md has the keys.
[[nodiscard]] nlohmann::ordered_json repair_json(const Repair& repair);

/// Returns OUT.repair.csv: `frame,time,marker,method,sigma`, one row for every changed
/// sample. `method` is that of the gap, or the fault that was corrected or removed. Sigma
/// is in metres, empty if there is none.
[[nodiscard]] std::string repair_table(const Repair& repair);

}  // namespace marey::app
