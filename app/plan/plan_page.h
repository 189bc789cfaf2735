// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/plan/plan_figures.h"

namespace marey::app {

/// plan.html: the body's joints and how well it is known where it stands; then the table
/// of heights, and for every height the floor from above, with the cameras, where single
/// tags are seen by two, and how well. One file, nothing fetched.
[[nodiscard]] std::string plan_page(const PlanReport& report);

}  // namespace marey::app
