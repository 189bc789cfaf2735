// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/check_jump_wish.h"

#include <array>
#include <cmath>
#include <optional>

#include <glm/vec3.hpp>

#include "core/base/format_text.h"

namespace marey::dynamics {
namespace {

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check_jump_numbers(const JumpWish& wish,
                          const JumpTraits& traits,
                          const PlanJumpOptions& options) {
  struct Named {
    const char* name;
    std::optional<double> value;
    double low;
    double high;
  };
  const std::optional<LowestPoint>& lowest = options.lowest;
  const std::array<Named, 12> numbers{{
      {"apex_m", wish.apex_m, -100.0, 100.0},
      {"apex_by_m", wish.apex_by_m, -100.0, 100.0},
      {"airtime_s", wish.airtime_s, kShortestFlight_s, 20.0},
      {"length_m", wish.length_m, 0.0, 100.0},
      {"box_m", wish.box_m, -20.0, 20.0},
      {"push_s", wish.push_s, 0.05, 10.0},
      {"strength_g", traits.strength_g, 0.5, 100.0},
      {"gravity_m_s2", options.gravity_m_s2, 0.5, 30.0},
      {"deepest_m", traits.deepest_m, -100.0, 100.0},
      {"friction", traits.friction, 0.0, 100.0},
      {"lowest.at", lowest ? std::optional(lowest->at) : std::nullopt, 0.001, 0.999},
      {"lowest.height_m",
       lowest ? std::optional(lowest->height_m) : std::nullopt,
       -100.0,
       100.0},
  }};
  for (const Named& number : numbers) {
    if (!number.value) continue;
    if (std::isfinite(*number.value) && *number.value >= number.low &&
        *number.value <= number.high) {
      continue;
    }
    return bad_input(number.name,
                     "is " + format_text("%g", *number.value),
                     "choose " + format_text("%g", number.low) + " to " +
                         format_text("%g", number.high));
  }
  if (wish.landing_in_world && !is_finite(*wish.landing_in_world)) {
    return bad_input("land_m", "is not finite", "state three finite numbers");
  }
  return Done{};
}

Status check_jump_conflicts(const JumpReference& reference, const JumpWish& wish) {
  const Jump& jump = reference.jump();
  if (wish.apex_m && wish.apex_by_m) {
    return bad_input(
        "apex_by_m", "is stated together with apex_m", "leave one of the two out");
  }
  if (wish.landing_in_world && (wish.length_m || wish.box_m)) {
    return bad_input("land_m",
                     "is stated together with length_m or box_m, which it includes",
                     "leave those out");
  }
  const bool on_landing =
      wish.airtime_s || wish.length_m || wish.landing_in_world || wish.box_m;
  if (!jump.touchdown && on_landing) {
    return bad_input("jump",
                     "is cut by the end of the clip in flight, so its landing cannot "
                     "be changed",
                     "use a clip that ends after the landing, or wish for an apex only");
  }
  if (jump.touchdown && reference.landing() == nullptr) {
    const double after_s = reference.end_s() - jump.touchdown->time_s;
    if (jump.rest) {
      return bad_input("jump",
                       "has a captured landing whose force does not lead to its rest",
                       "filter the motion before");
    }
    return bad_input("jump",
                     "has no complete landing: the clip ends " +
                         format_text("%.3f s", after_s) + " after touch-down",
                     "use a clip that lasts until the body stands");
  }
  return Done{};
}

}  // namespace

Status check_jump_wish(const JumpReference& reference,
                       const JumpWish& wish,
                       const JumpTraits& traits,
                       const PlanJumpOptions& options) {
  if (const Status ok = check_jump_numbers(wish, traits, options); !ok) return ok;
  return check_jump_conflicts(reference, wish);
}

}  // namespace marey::dynamics
