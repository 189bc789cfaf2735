// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/constraint_kind.h"

#include <variant>

namespace marey::app {

live::PageConstraintKind page_kind(const Constraint& constraint) {
  const Goal& goal = constraint.goal;
  if (const auto* place = std::get_if<DistanceToPoint>(&goal)) {
    return place->distance_m > 0.0 ? live::PageConstraintKind::kDistance
                                   : live::PageConstraintKind::kPosition;
  }
  if (std::holds_alternative<Support>(goal)) return live::PageConstraintKind::kSupport;
  if (std::holds_alternative<SegmentOrientation>(goal)) {
    return live::PageConstraintKind::kOrientation;
  }
  const bool is_box = std::holds_alternative<AllowedSpace>(goal) ||
                      std::holds_alternative<ForbiddenSpace>(goal);
  return is_box ? live::PageConstraintKind::kBox : live::PageConstraintKind::kDistance;
}

bool is_draggable_place(const Constraint& constraint) {
  return std::holds_alternative<DistanceToPoint>(constraint.goal);
}

}  // namespace marey::app
