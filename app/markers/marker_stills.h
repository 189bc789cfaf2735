// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/markers/marker_history.h"
#include "core/body.h"
#include "reconstruct/markers/solve_markers.h"

namespace marey::app {

/// The skeleton and the markers at five instants spread over the frames that show
/// markers, and in the frame where they are furthest from the body; docs/formats/README.md, "The
/// pages of labelled markers". Precondition: `solved` is of this body and these markers.
[[nodiscard]] nlohmann::ordered_json marker_stills(
    const Body& body,
    const reconstruct::SolvedMarkers& solved,
    const MarkerHistory& history);

/// The bones of a still: from which of its places to which, 22 joints and then the tips,
/// and which joint says where it comes from.
[[nodiscard]] nlohmann::ordered_json still_bones(const Skeleton& skeleton);

}  // namespace marey::app
