// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/live_stance.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {

double LiveStance::Contact::speed_legs_per_s(const glm::dvec3& p_legs,
                                             double since_last_s,
                                             const LiveStanceOptions& options) {
  if (is_known) {
    const double share = 1.0 - std::exp(-since_last_s / options.speed_filter_s);
    const glm::dvec3 now_legs_per_s = (p_legs - before_legs) / since_last_s;
    velocity_legs_per_s += share * (now_legs_per_s - velocity_legs_per_s);
  }
  is_known = true;
  before_legs = p_legs;
  return glm::length(velocity_legs_per_s);
}

// `height_legs` is above its resting height.
bool LiveStance::Contact::rests(double height_legs, const DetectContactsOptions& o) {
  const double speed = glm::length(velocity_legs_per_s);
  is_resting =
      is_resting ? speed < o.keep_speed_legs_per_s && height_legs < o.keep_height_legs
                 : speed < o.start_speed_legs_per_s && height_legs < o.start_height_legs;
  return is_resting;
}

// `height_legs` is the height of the foot's lower joint above its resting height. A
// raised heel with the ball down does not increase it.
void LiveStance::estimate_floor(std::size_t side,
                                double height_legs,
                                double speed_legs_per_s,
                                double since_last_s) {
  const DetectContactsOptions& o = options_.contacts;
  if (speed_legs_per_s > o.start_speed_legs_per_s ||
      std::abs(height_legs) > o.uneven_legs) {
    return;
  }
  // Down at once, since no foot is below a floor; up slowly, since a foot may be in the
  // air.
  constexpr double kSinks_s = 0.05;
  constexpr double kRises_s = 0.5;
  const double above = height_legs - floor_offsets_legs_[side];
  const double time_s = above < 0.0 ? kSinks_s : kRises_s;
  floor_offsets_legs_[side] += above * (1.0 - std::exp(-since_last_s / time_s));
}

void LiveStance::step(const BodyMap& map,
                      std::span<const RigidTransform> world_from_joint,
                      double since_last_s) {
  MAREY_ASSERT(since_last_s > 0.0);
  const double leg_m = map.leg_length_m;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    const FootMap& foot = map.feet[s];
    const glm::dvec3 ankle =
        world_from_joint[index(map.leg(side).end)].translation / leg_m;
    const double ankle_height = ankle.y - foot.ankle_height_m / leg_m;
    double speed = contacts_[s].speed_legs_per_s(ankle, since_last_s, options_);
    double lower = ankle_height;
    const auto toes = map.joint_of[index(toes_bone(side))];
    double ball_height = 0.0;
    if (toes) {
      const glm::dvec3 ball = world_from_joint[index(*toes)].translation / leg_m;
      ball_height = ball.y - foot.ball_height_m / leg_m;
      lower = std::min(lower, ball_height);
      speed = std::min(speed,
                       contacts_[s + 2].speed_legs_per_s(ball, since_last_s, options_));
    }
    estimate_floor(s, lower, speed, since_last_s);
    const double floor = floor_offsets_legs_[s];
    standing_[s].heel = contacts_[s].rests(ankle_height - floor, options_.contacts);
    standing_[s].ball =
        toes ? contacts_[s + 2].rests(ball_height - floor, options_.contacts)
             : standing_[s].heel;
  }
}

}  // namespace marey::retarget
