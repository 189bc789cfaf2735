// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/markers/marker_history.h"
#include "core/body.h"
#include "reconstruct/markers/solve_markers.h"

namespace marey::app {

/// Returns the skeleton and the markers at five instants spread over the frames with
/// markers, and in the frame where the markers are furthest from the body;
/// docs/formats/marker_pages.md. Precondition: `solved` is of
/// this body and these markers.
[[nodiscard]] nlohmann::ordered_json marker_stills(
    const Body& body,
    const reconstruct::SolvedMarkers& solved,
    const MarkerHistory& history);

/// Returns the bones of a still: indices of both ends (22 joints, then the tips), and the
/// joint whose `Source` applies.
[[nodiscard]] nlohmann::ordered_json still_bones(const Skeleton& skeleton);

}  // namespace marey::app
