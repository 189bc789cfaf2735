// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/markers/marker_state.h"

#include "app/edit/marker_edit_inputs.h"
#include "recordings/markers/labelled_markers.h"

namespace marey::app {

/// Returns the annotations that are events as events of a C3D, on the clock of the
/// tracks. `known` are the events of the source: one that is still at its time is
/// returned as it is, in the source's order; others take label, side and subject from the
/// event of the same text, or the text as label. New events follow, by time.
[[nodiscard]] std::vector<recordings::MarkerEvent> marker_events_of(
    const edit::MarkerState& state, const std::vector<MarkerEditEvent>& known);

}  // namespace marey::app
