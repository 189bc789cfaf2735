// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "reconstruct/tracks/check_tracks.h"
#include "reconstruct/tracks/repair_gaps.h"

namespace marey::app {

/// One trial of markers, as it came and as it was repaired.
struct Repair {
  std::string name;  ///< Of the file.
  MarkerTracks as_read;
  reconstruct::CheckedTracks checked;
  reconstruct::RepairedTracks repaired;
};

/// What OUT.repair.json holds; docs/formats/README.md has the keys.
[[nodiscard]] nlohmann::ordered_json repair_figures(const Repair& repair);

/// OUT.repair.csv: `frame,time,marker,method,sigma`, a row for every sample that is not
/// as it was read; the method of a gap, or the fault that was put right or taken out.
/// Sigma in metres, empty where there is none.
[[nodiscard]] std::string repair_table(const Repair& repair);

}  // namespace marey::app
