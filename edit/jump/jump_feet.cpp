// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/jump/jump_feet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "edit/jump/foot_course.h"
#include "edit/state/plant_feet.h"
#include <glm/vec3.hpp>

#include "core/base/smooth_step.h"
#include "core/human/contacts.h"
#include "retarget/com/foot_goals.h"

namespace marey::edit {
namespace {

/// A foot that bears within this time of take-off or touch-down bears until then.
constexpr double kBearsWithin_s = 0.15;
/// Next to a flight a foot is held or free, without a fade. There the body is on its
/// captured place over the foot, so both are the same; a fade would bend straight knees.
constexpr double kFlightFade_s = 0.0;
/// Fade of the hold before and after other stances.
constexpr double kSwingFade_s = 0.16;
/// Time before and after a flight in which the centre of mass comes before the feet: it
/// is on its plan when the flight begins and ends.
constexpr double kGiveWay_s = 0.08;
/// Time after touch-down in which heels may still be up.
constexpr double kHeelDown_s = 0.15;

/// An interval in which a foot bears. [s]
struct Stance {
  double from_s = 0.0;
  double to_s = 0.0;
  double fade_before_s = kSwingFade_s;
  double fade_after_s = kSwingFade_s;
};

std::vector<Stance> stances_of(const FootContacts& foot,
                               double hz,
                               const dynamics::JumpPlan& plan) {
  const double takeoff_s = plan.takeoff().time_s;
  std::vector<Stance> out;
  for (const FrameRange& range : foot.stance) {
    Stance stance{range.first / hz, range.last / hz};
    if (stance.from_s < takeoff_s && stance.to_s > takeoff_s - kBearsWithin_s) {
      stance.to_s = takeoff_s;
      stance.fade_after_s = kFlightFade_s;
    }
    if (plan.touchdown()) {
      const double touchdown_s = plan.touchdown()->time_s;
      if (stance.to_s > touchdown_s && stance.from_s < touchdown_s + kBearsWithin_s) {
        stance.from_s = std::max(touchdown_s, takeoff_s);
        stance.fade_before_s = kFlightFade_s;
      }
    }
    out.push_back(stance);
  }
  return out;
}

double hold_at(const std::vector<Stance>& stances, double time_s) {
  double hold = 0.0;
  for (const Stance& stance : stances) {
    double share = 1.0;
    if ((time_s < stance.from_s && stance.fade_before_s <= 0.0) ||
        (time_s > stance.to_s && stance.fade_after_s <= 0.0)) {
      share = 0.0;
    } else if (time_s < stance.from_s) {
      share = smooth_step(1.0 - (stance.from_s - time_s) / stance.fade_before_s);
    } else if (time_s > stance.to_s) {
      share = smooth_step(1.0 - (time_s - stance.to_s) / stance.fade_after_s);
    }
    hold = std::max(hold, share);
  }
  return hold;
}

}  // namespace

std::array<std::vector<retarget::FootGoal>, 2> jump_feet(const EditState& captured,
                                                         std::span<const double> shown,
                                                         const EditState& state,
                                                         const dynamics::JumpPlan& plan) {
  const auto count = static_cast<std::size_t>(state.frame_count());
  const double hz = state.motion.rate.hz;
  const double takeoff_s = plan.takeoff().time_s;
  const double duration_s = state.duration_s();
  std::vector<glm::dvec3> displaced(count, glm::dvec3(0.0));
  std::vector<double> heel(count, 0.0);
  std::vector<double> gives_way(count, 1.0);
  for (std::size_t t = 0; t < count; ++t) {
    const double time_s = static_cast<double>(t) / hz;
    const double push_s = takeoff_s - plan.lowest_s();
    if (time_s <= takeoff_s) {
      heel[t] = smooth_step((time_s - plan.lowest_s()) / std::max(push_s, 1.0 / hz));
    } else {
      heel[t] = 1.0;
    }
    const double landing_s = plan.touchdown() ? plan.touchdown()->time_s : duration_s;
    gives_way[t] = time_s < takeoff_s ? smooth_step((takeoff_s - time_s) / kGiveWay_s)
                                      : smooth_step((time_s - landing_s) / kGiveWay_s);
    if (!plan.touchdown()) continue;
    const double touchdown_s = plan.touchdown()->time_s;
    displaced[t] = smooth_step((time_s - takeoff_s) / (touchdown_s - takeoff_s)) *
                   plan.landing_moved_m();
    if (time_s > touchdown_s) {
      heel[t] = 1.0 - smooth_step((time_s - touchdown_s) / kHeelDown_s);
    }
  }
  std::array<std::vector<retarget::FootGoal>, 2> out;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto stances = stances_of(state.contacts.feet[side], hz, plan);
    std::vector<double> hold(count, 0.0);
    for (std::size_t t = 0; t < count; ++t) {
      hold[t] = hold_at(stances, static_cast<double>(t) / hz);
    }
    out[side] = retarget::foot_goals(state.motion,
                                     state.map,
                                     static_cast<int>(side),
                                     {displaced, hold, heel, gives_way});
    const auto course = foot_course(foot_places(captured, static_cast<int>(side)), shown);
    for (std::size_t t = 0; t < count; ++t) {
      out[side][t].place = course[t];
      out[side][t].place.ankle_in_world += displaced[t];
    }
  }
  return out;
}

}  // namespace marey::edit
