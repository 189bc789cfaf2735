// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/plant_near.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/transform.h"
#include "core/base/smooth_step.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/feet/footprint.h"
#include "retarget/feet/plan_foot_path.h"

namespace marey::edit {
namespace {

using retarget::FootPlace;
using PlannedFeet = std::array<std::vector<std::optional<FootPlace>>, 2>;

// A swing shorter than this has no room for a fade. [s]
constexpr double kMinFade_s = 0.15;
// Fade of a foot that does not stand again. [s]
constexpr double kFreeFade_s = 0.4;
// Time round the zone in which a foot stays on its footprint, and the time over which its
// displacement then becomes constant. [s]
constexpr double kKept_s = 0.1;
constexpr double kHoldFade_s = 0.4;
// Time over which the change of a displacement is fitted, and over which it fades. [s]
constexpr double kRateFit_s = 0.04;
constexpr double kRateFade_s = 0.25;

bool overlaps(const FrameRange& a, const FrameRange& b) {
  return a.first <= b.last && b.first <= a.last;
}

// Returns the indices of the first and the last stance to plant; nullopt if there is
// none.
std::optional<std::pair<std::size_t, std::size_t>> stances_near(
    const std::vector<FrameRange>& stances, const FrameRange& zone, double min_gap) {
  std::optional<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t k = 0; k < stances.size(); ++k) {
    if (!overlaps(stances[k], zone)) continue;
    if (!out) out = {k, k};
    out->second = k;
  }
  if (!out) return out;
  const auto gap = [&](std::size_t k) { return stances[k + 1].first - stances[k].last; };
  while (out->first > 0 && gap(out->first - 1) < min_gap) --out->first;
  while (out->second + 1 < stances.size() && gap(out->second) < min_gap) ++out->second;
  return out;
}

std::vector<FrameRange> runs_within(const std::vector<FrameRange>& runs,
                                    const FrameRange& within) {
  std::vector<FrameRange> out;
  for (const FrameRange& run : runs) {
    if (overlaps(run, within)) out.push_back(run);
  }
  return out;
}

// Displacement of a foot at the edge of a stance, and its change per frame away from the
// stance. Rotations are vectors in world axes.
struct FootOffset {
  glm::dvec3 ankle{0.0};
  glm::dvec3 foot{0.0};
  glm::dvec3 toes{0.0};
};

glm::dvec3 turn_from(const glm::dquat& from, const glm::dquat& to) {
  return rotation_vector(to * glm::conjugate(from));
}

FootOffset offset_of(const FootPlace& from, const FootPlace& to) {
  return {to.ankle_in_world - from.ankle_in_world,
          turn_from(from.foot, to.foot),
          turn_from(from.toes, to.toes)};
}

FootOffset mixed_offset(const FootOffset& a, const FootOffset& b, double share) {
  return {glm::mix(a.ankle, b.ankle, share),
          glm::mix(a.foot, b.foot, share),
          glm::mix(a.toes, b.toes, share)};
}

FootPlace displaced_place(const FootPlace& place, const FootOffset& offset) {
  return {place.ankle_in_world + offset.ankle,
          glm::normalize(rotation_from_vector(offset.foot) * place.foot),
          glm::normalize(rotation_from_vector(offset.toes) * place.toes)};
}

// One foot over the whole motion: where it is, and where it stands in planted stances.
struct PlantedWay {
  const std::vector<FootPlace>& before;
  const std::vector<FootPlace>& planned;
  std::vector<std::optional<FootPlace>> out;

  [[nodiscard]] FootOffset offset(int frame) const {
    const auto t = static_cast<std::size_t>(frame);
    return offset_of(before[t], planned[t]);
  }
  // Returns the change of the offset per frame at the end of `count` frames that lead to
  // the edge, by a line fit.
  [[nodiscard]] FootOffset rate(int edge, int step, int count) const {
    FootOffset sum;
    double square = 0.0;
    for (int k = 0; k < count; ++k) {
      const double x = 0.5 * (count - 1) - k;
      const FootOffset at = offset(edge - k * step);
      sum = {sum.ankle + x * at.ankle, sum.foot + x * at.foot, sum.toes + x * at.toes};
      square += x * x;
    }
    if (square == 0.0) return {};
    return {sum.ankle / square, sum.foot / square, sum.toes / square};
  }
  // Adds the offset of a stance's edge to the frames beyond, falling to 0 over `length`
  // frames: quintics in the offset and its rate. The rate has less time: noise of it
  // would lead far away.
  void fade(const FrameRange& stance, int step, int length, double hz) {
    const int edge = step < 0 ? stance.first : stance.last;
    const FootOffset value = offset(edge);
    const int fitted = std::max(2, static_cast<int>(std::lround(kRateFit_s * hz)));
    const FootOffset change =
        rate(edge, step, std::min(fitted, stance.last - stance.first + 1));
    const double rate_length = std::min(1.0 * length, kRateFade_s * hz);
    for (int k = 1; k < length; ++k) {
      const int frame = edge + k * step;
      if (frame < 0 || frame >= static_cast<int>(before.size())) return;
      const auto t = static_cast<std::size_t>(frame);
      const double keep = 1.0 - smooth_step(static_cast<double>(k) / length);
      const double x = std::min(1.0, k / rate_length);
      const double x3 = x * x * x;
      const double go = rate_length * (x - 6.0 * x3 + 8.0 * x3 * x - 3.0 * x3 * x * x);
      if (!out[t]) out[t] = before[t];
      FootPlace& place = *out[t];
      place.ankle_in_world += keep * value.ankle + go * change.ankle;
      place.foot = glm::normalize(
          rotation_from_vector(keep * value.foot + go * change.foot) * place.foot);
      place.toes = glm::normalize(
          rotation_from_vector(keep * value.toes + go * change.toes) * place.toes);
    }
  }
};

// Places the foot in its planted stances and in the swings round them.
std::vector<std::optional<FootPlace>> place_stances(
    const std::vector<FrameRange>& stances,
    const std::pair<std::size_t, std::size_t>& chosen,
    double hz,
    PlantedWay way) {
  const int free_fade = static_cast<int>(std::ceil(kFreeFade_s * hz));
  way.out.resize(way.before.size());
  const auto [first, last] = chosen;
  for (std::size_t k = first; k <= last; ++k) {
    const FrameRange& run = stances[k];
    for (int frame = run.first; frame <= run.last; ++frame) {
      const auto t = static_cast<std::size_t>(frame);
      way.out[t] = way.planned[t];
    }
    way.fade(run, -1, k > 0 ? run.first - stances[k - 1].last : free_fade, hz);
    way.fade(run,
             +1,
             k + 1 < stances.size() ? stances[k + 1].first - run.last : free_fade,
             hz);
  }
  return way.out;
}

// The planar move that brings one footprint onto another one.
RigidTransform print_move(const retarget::Footprint& from,
                          const retarget::Footprint& to) {
  const glm::dquat turn = glm::normalize(to.heading * glm::conjugate(from.heading));
  return {turn, to.ankle_in_world - turn * from.ankle_in_world};
}

// Keeps the footprint of each stance within the zone as it is in the first frame there;
// the rest of the stance moves along.
void hold_prints(const std::vector<FootPlace>& level,
                 const FootContacts& contacts,
                 const FrameRange& zone,
                 const retarget::FootMap& shape,
                 FrameRate rate,
                 std::vector<FootPlace>& planned) {
  const auto heel = retarget::frame_marks(contacts.heel, level.size());
  const auto ball = retarget::frame_marks(contacts.ball, level.size());
  for (const FrameRange& run : contacts.stance) {
    if (!overlaps(run, zone)) continue;
    const auto prints = retarget::footprints({level, heel, ball}, run, shape, rate);
    const auto print = [&](int frame) {
      return prints[static_cast<std::size_t>(frame - run.first)];
    };
    const int held = std::max(run.first, zone.first);
    for (int frame = held + 1; frame <= run.last; ++frame) {
      const RigidTransform move =
          print_move(print(std::min(frame, zone.last)), print(held));
      FootPlace& place = planned[static_cast<std::size_t>(frame)];
      place.ankle_in_world = move * place.ankle_in_world;
      place.foot = move.rotation * place.foot;
      place.toes = move.rotation * place.toes;
    }
  }
}

// Beyond the zone a long stance is displaced as a whole: the foot moves on its footprint
// as it did before, because the legs of a captured motion fit that. From `start` on, in
// the direction of `step`, the displacement becomes that of the frame `fade` frames
// later.
void hold_displacement(const std::vector<FootPlace>& before,
                       const FrameRange& run,
                       int start,
                       int step,
                       int fade,
                       std::vector<FootPlace>& planned) {
  const int end = start + step * fade;
  if (start < run.first || start > run.last || end < run.first || end > run.last) return;
  const auto at = [](int frame) { return static_cast<std::size_t>(frame); };
  const FootOffset held = offset_of(before[at(end)], planned[at(end)]);
  for (int t = start; t >= run.first && t <= run.last; t += step) {
    const double share =
        smooth_step(static_cast<double>(std::abs(t - start)) / fade);
    const FootOffset own = offset_of(before[at(t)], planned[at(t)]);
    planned[at(t)] = displaced_place(before[at(t)], mixed_offset(own, held, share));
  }
}

// Returns one foot on its footprints in the stances near the zone.
std::vector<std::optional<FootPlace>> planted_foot(const EditState& state,
                                                   int side,
                                                   const FrameRange& zone,
                                                   const std::vector<FootPlace>& feet,
                                                   double rise_m) {
  const auto foot = static_cast<std::size_t>(side);
  FootContacts contacts = state.contacts.feet[foot];
  const std::vector<FrameRange> stances = contacts.stance;
  const double hz = state.motion.rate.hz;
  const auto chosen = stances_near(stances, zone, kMinFade_s * hz);
  if (!chosen) return std::vector<std::optional<FootPlace>>(feet.size());
  const FrameRange planted{stances[chosen->first].first, stances[chosen->second].last};
  for (auto* runs :
       {&contacts.heel, &contacts.ball, &contacts.stance, &contacts.heel_up}) {
    *runs = runs_within(*runs, planted);
  }
  const std::vector<FootPlace> before = foot_places(state, side);
  std::vector<FootPlace> level = before;
  for (const FrameRange& run : contacts.stance) {
    std::copy(
        feet.begin() + run.first, feet.begin() + run.last + 1, level.begin() + run.first);
  }
  for (FootPlace& place : level) place.ankle_in_world.y += rise_m;
  auto planned = retarget::plan_foot_path(
      level, contacts, state.map.feet[foot], state.map.leg_length_m, state.motion.rate);
  hold_prints(level, contacts, zone, state.map.feet[foot], state.motion.rate, planned);
  for (FootPlace& place : planned) place.ankle_in_world.y -= rise_m;
  const int kept = std::max(1, static_cast<int>(std::lround(kKept_s * hz)));
  const int fade = std::max(1, static_cast<int>(std::lround(kHoldFade_s * hz)));
  for (const FrameRange& run : contacts.stance) {
    hold_displacement(before, run, zone.last + kept, +1, fade, planned);
    hold_displacement(before, run, zone.first - kept, -1, fade, planned);
  }
  return place_stances(stances, *chosen, hz, {before, planned, {}});
}

FrameRange changed_frames(const PlannedFeet& feet) {
  FrameRange out{0, -1};
  for (const auto& path : feet) {
    for (std::size_t t = 0; t < path.size(); ++t) {
      if (!path[t]) continue;
      const int frame = static_cast<int>(t);
      out = out.last < out.first
                ? FrameRange{frame, frame}
                : FrameRange{std::min(out.first, frame), std::max(out.last, frame)};
    }
  }
  return out;
}

}  // namespace

PlantNearReport plant_feet_near(EditState& state,
                                const FrameRange& zone,
                                const FootWays& feet) {
  MAREY_ASSERT(zone.first >= 0 && zone.first <= zone.last &&
               zone.last < state.frame_count());
  PlantNearReport report;
  const double rise_m =
      retarget::standing_rise_m(state.map, state.contacts, state.map, 1.0);
  PlannedFeet planned;
  for (int side = 0; side < 2; ++side) {
    const auto& way = feet[static_cast<std::size_t>(side)];
    MAREY_ASSERT(static_cast<int>(way.size()) == state.frame_count());
    planned[static_cast<std::size_t>(side)] =
        planted_foot(state, side, zone, way, rise_m);
  }
  report.changed = changed_frames(planned);
  if (report.changed.first <= report.changed.last) {
    report.plant = set_feet(state, planned, {{}, true});
  }
  return report;
}

PlantNearReport plant_feet_near(EditState& state, const FrameRange& zone) {
  return plant_feet_near(state, zone, {foot_places(state, 0), foot_places(state, 1)});
}

}  // namespace marey::edit
