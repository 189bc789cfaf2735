// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/clip_travel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/clips/sample_clip.h"

namespace marey::engine {
namespace {

constexpr double kFullTurn_rad = 2.0 * 3.14159265358979323846;
// Phases below it are noise of the contacts. [s]
constexpr double kMinPhase_s = 0.04;
// See ClipTravel::travels.
constexpr double kMinTravelShare = 0.15;

bool stands_alone(const Phase& phase) {
  return phase.feet == PhaseClass::kLeft || phase.feet == PhaseClass::kRight;
}

// True if a foot bears in `after` that does not bear in `before`.
bool lands_between(PhaseClass before, PhaseClass after) {
  if (after == before || after == PhaseClass::kNone) return false;
  return before != PhaseClass::kBoth;
}

void append_phase(std::vector<Phase>& phases, const Phase& phase) {
  if (!phases.empty() && phases.back().feet == phase.feet) {
    phases.back().end_s = phase.end_s;
  } else {
    phases.push_back(phase);
  }
}

double phase_length_s(const Phase& phase) {
  return phase.end_s - phase.start_s;
}

// Phases of two cycles, across their seams; the first one starts at or after 0.
std::vector<Phase> phases_of_two_cycles(const MotionClip& clip) {
  const std::vector<Phase> once = phases_of(clip, kMinPhase_s);
  const double cycle_s = clip.duration_s();
  std::vector<Phase> all;
  for (const double offset_s : {-cycle_s, 0.0, cycle_s, 2.0 * cycle_s}) {
    for (const Phase& phase : once) {
      append_phase(all, {phase.feet, phase.start_s + offset_s, phase.end_s + offset_s});
    }
  }
  // A short phase at a seam joins the longer one of its neighbours.
  std::vector<Phase> joined;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Phase phase = all[i];
    if (phase_length_s(phase) < kMinPhase_s && i > 0 && i + 1 < all.size()) {
      const bool to_earlier = phase_length_s(all[i - 1]) >= phase_length_s(all[i + 1]);
      phase.feet = all[to_earlier ? i - 1 : i + 1].feet;
    }
    append_phase(joined, phase);
  }
  std::erase_if(joined, [&](const Phase& phase) {
    return phase.start_s < -1e-9 || phase.start_s >= 2.0 * cycle_s - 1e-9;
  });
  return joined;
}

std::vector<ClipStep> find_steps(const MotionClip& clip) {
  const std::vector<Phase> phases = phases_of_two_cycles(clip);
  const double cycle_s = clip.duration_s();
  std::vector<ClipStep> steps;
  for (std::size_t i = 0; i < phases.size() && phases[i].start_s < cycle_s - 1e-9; ++i) {
    if (!stands_alone(phases[i])) continue;
    std::size_t j = i + 1;
    while (j < phases.size() && !lands_between(phases[j - 1].feet, phases[j].feet)) ++j;
    if (j == phases.size()) continue;
    ClipStep step;
    step.stands = phases[i].feet;
    step.alone_start_s = phases[i].start_s;
    step.alone_end_s = phases[i].end_s;
    step.land_s = phases[j].start_s;
    // One landing ends one step: a foot that hops in between has landed itself.
    if (!steps.empty() && steps.back().land_s >= step.land_s) continue;
    steps.push_back(step);
  }
  return steps;
}

void measure_cycle(const MotionClip& clip, ClipTravel& travel) {
  const RootPlace first = path_at(clip, 0.0);
  const RootPlace cycle = relative(first, path_at(clip, travel.cycle_s));
  travel.distance_legs = std::hypot(cycle.x_m, cycle.z_m);
  travel.turn_rad = cycle.heading_rad;
  travel.speed_legs_s = travel.distance_legs / travel.cycle_s;
  double heading_sum_rad = 0.0;
  for (std::size_t i = 0; i + 1 < clip.path.size(); ++i) {
    heading_sum_rad += static_cast<double>(clip.path[i].heading_rad) - first.heading_rad;
  }
  const double mean_rad = heading_sum_rad / static_cast<double>(clip.path.size() - 1);
  travel.direction_rad =
      std::remainder(std::atan2(cycle.x_m, cycle.z_m) - mean_rad, kFullTurn_rad);
}

void measure_steps(const MotionClip& clip, ClipTravel& travel) {
  const std::size_t count = travel.steps.size();
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    ClipStep& step = travel.steps[i];
    const double from_s = i > 0 ? travel.steps[i - 1].land_s
                                : travel.steps[count - 1].land_s - travel.cycle_s;
    RootPlace from = path_at(clip, from_s);
    from.heading_rad += travel_direction(clip, travel, from_s);
    RootPlace to = path_at(clip, step.land_s);
    to.heading_rad += travel_direction(clip, travel, step.land_s);
    const RootPlace by = relative(from, to);
    step.along_legs = by.z_m;
    step.across_legs = by.x_m;
    // Half of it while the foot stands; a runner then still flies.
    step.passes_at =
        0.5 *
        std::clamp(
            (step.alone_end_s - from_s) / std::max(step.land_s - from_s, 1e-6), 0.0, 1.0);
    step.length_legs = std::hypot(by.x_m, by.z_m);
    step.turn_rad = std::remainder(by.heading_rad, kFullTurn_rad);
    step.sum_along_legs = along += by.z_m;
    step.sum_across_legs = across += by.x_m;
  }
}

double sum_of_lengths(const ClipTravel& travel) {
  double sum_legs = 0.0;
  for (const ClipStep& step : travel.steps) sum_legs += step.length_legs;
  return sum_legs;
}

}  // namespace

Result<ClipTravel> travel_of_clip(const MotionClip& clip) {
  const auto refuse = [&](const char* cause) {
    return bad_input("clip " + clip.name, cause, "take a loop of steps (edit cyclify)");
  };
  if (!clip.loops) return refuse("the clip does not loop, so it cannot be steered");
  if (std::all_of(clip.contacts.begin(), clip.contacts.end(), [](const auto& spans) {
        return spans.empty();
      })) {
    return refuse("the clip has no contacts, so its steps are unknown");
  }
  ClipTravel travel;
  travel.cycle_s = clip.duration_s();
  travel.steps = find_steps(clip);
  if (travel.steps.empty()) return refuse("no foot ever stands alone in the clip");
  measure_cycle(clip, travel);
  measure_steps(clip, travel);
  travel.travels =
      travel.distance_legs > std::max(kMinTravelShare * sum_of_lengths(travel), 1e-3);
  // Without a direction the steps are relative to the heading instead.
  if (travel.travels) {
    measure_steps(clip, travel);
  } else {
    travel.direction_rad = 0.0;
  }
  const auto count = static_cast<double>(travel.steps.size());
  travel.mean_step_legs = sum_of_lengths(travel) / count;
  const double mean_along_legs = travel.steps.back().sum_along_legs / count;
  travel.is_even =
      std::all_of(travel.steps.begin(), travel.steps.end(), [&](const ClipStep& step) {
        return std::abs(step.along_legs - mean_along_legs) <= 0.5 * mean_along_legs;
      });
  for (const ClipStep& step : travel.steps) {
    travel.mean_alone_s += (step.alone_end_s - step.alone_start_s) / count;
  }
  return travel;
}

double travel_direction(const MotionClip& clip, const ClipTravel& travel, double clip_s) {
  if (!travel.travels) return 0.0;
  const double cycle_s = travel.cycle_s;
  // In the first cycles the path of a clip is found without summing up cycles.
  const double time_s = clip_s - std::floor(clip_s / cycle_s) * cycle_s;
  const RootPlace back = relative(path_at(clip, time_s), path_at(clip, time_s - cycle_s));
  return std::atan2(-back.x_m, -back.z_m);
}

}  // namespace marey::engine
