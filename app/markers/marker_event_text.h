// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "recordings/markers/labelled_markers.h"

namespace marey::app {

/// Returns an event's text, without the subject: "left.strike", "Left Foot Contact".
[[nodiscard]] std::string text_of_event(const recordings::MarkerEvent& event);

}  // namespace marey::app
