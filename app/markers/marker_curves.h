// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <nlohmann/json_fwd.hpp>

#include "app/markers/marker_history.h"
#include "app/markers/repair_json.h"

namespace marey::app {

/// Returns the positions of markers around the most important repairs, before and after:
/// in turn the longest fill, the fill of the largest sigma, and the wrong samples that
/// were furthest off, one of each marker, at most `max_count` in all.
/// docs/formats/marker_pages.md. Each curve has at most a few
/// hundred instants.
[[nodiscard]] nlohmann::ordered_json repair_curves(const Repair& repair,
                                                   const MarkerHistory& history,
                                                   std::size_t max_count);

}  // namespace marey::app
