// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/constraint.h"
#include "live/page/page_scene.h"

namespace marey::app {

/// Returns the kind of a constraint in the messages of the page.
[[nodiscard]] live::PageConstraintKind page_kind(const Constraint& constraint);

/// Returns true if a page may move the constraint's position.
[[nodiscard]] bool is_draggable_place(const Constraint& constraint);

}  // namespace marey::app
