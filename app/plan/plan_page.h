// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/plan/plan_json.h"

namespace marey::app {

/// Returns plan.html, one file that loads no other. It shows the joints of the body and
/// their errors on the floor, the table of heights, and, for every height, the floor from
/// above with the cameras, the places where two cameras see single tags, and the errors
/// of the tags.
[[nodiscard]] std::string plan_page(const PlanReport& report);

}  // namespace marey::app
