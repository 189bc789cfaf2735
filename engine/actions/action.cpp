// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/actions/action.h"

#include <algorithm>

#include "core/base/smooth_step.h"

namespace marey::engine {

float Action::leg_priority() const {
  return weight * std::max(priority[static_cast<std::size_t>(EditGroup::kLeftLeg)],
                           priority[static_cast<std::size_t>(EditGroup::kRightLeg)]);
}

double Action::fade(double time_s) const {
  if (!is_alive()) return 0.0;
  double share = 1.0;
  if (fade_in_s > 0.0) share = smooth_step((time_s - started_s) / fade_in_s);
  if (time_s <= stopped_s) return share;
  if (fade_out_s <= 0.0) return 0.0;
  return share * (1.0 - smooth_step((time_s - stopped_s) / fade_out_s));
}

}  // namespace marey::engine
