// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/bridge_stances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "edit/state/plant_feet.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/transform.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

using retarget::FootPlace;

// Time before and after a join without an overlap in which a foot changes its tilt. [s]
constexpr double kTiltFade_s = 0.15;

// A turn about the vertical through a point of the foot, and a shift on the floor.
struct FootMove {
  glm::dvec3 pivot_in_world{0.0};
  double turn_rad = 0.0;
  glm::dvec3 shift_m{0.0};

  [[nodiscard]] FootPlace moved(const FootPlace& place) const {
    const glm::dquat turn = glm::angleAxis(turn_rad, glm::dvec3(0.0, 1.0, 0.0));
    return {pivot_in_world + turn * (place.ankle_in_world - pivot_in_world) + shift_m,
            turn * place.foot,
            turn * place.toes};
  }
};

// The point between ankle and toe joint.
glm::dvec3 sole_of(const FootPlace& place, const retarget::FootMap& foot) {
  return place.ankle_in_world + 0.5 * (place.foot * foot.ball_from_ankle_in_t_pose);
}

bool stands_at(const FootContacts& foot, int frame) {
  return std::any_of(foot.stance.begin(), foot.stance.end(), [&](const FrameRange& run) {
    return run.first <= frame && frame <= run.last;
  });
}

bool stands_within(const FootContacts& foot, const FrameRange& frames) {
  return std::any_of(foot.stance.begin(), foot.stance.end(), [&](const FrameRange& run) {
    return std::max(run.first, frames.first) <= std::min(run.last, frames.last);
  });
}

double turn_between(const glm::dquat& a, const glm::dquat& b) {
  const glm::dquat turn = twist_about(b * glm::conjugate(a), glm::dvec3(0.0, 1.0, 0.0));
  return 2.0 * std::atan2(turn.y, turn.w);
}

// One foot of both motions in the overlap.
struct OverlapFeet {
  std::vector<FootPlace> first;   // One per frame of the first motion.
  std::vector<FootPlace> second;  // Place in the second motion.
  const retarget::FootMap& shape;
};

struct BridgeMoves {
  FootMove first;
  FootMove second;
};

// The moves of both sides that bring their mean places in the overlap together.
BridgeMoves halves_of_gap(const OverlapFeet& feet,
                          const std::vector<std::size_t>& entries,
                          const JoinFrames& frames) {
  glm::dvec3 a(0.0);
  glm::dvec3 b(0.0);
  double turn = 0.0;
  for (const std::size_t k : entries) {
    const FootPlace& from = feet.first[static_cast<std::size_t>(frames.start) + k];
    const FootPlace& to = feet.second[k];
    a += sole_of(from, feet.shape);
    b += sole_of(to, feet.shape);
    const double whole = 6.283185307179586477;
    turn += std::remainder(turn_between(from.foot, to.foot), whole);
  }
  const auto count = static_cast<double>(entries.size());
  a /= count;
  b /= count;
  turn /= count;
  const glm::dvec3 half = 0.5 * glm::dvec3(b.x - a.x, 0.0, b.z - a.z);
  return {{a, 0.5 * turn, half}, {b, -0.5 * turn, -half}};
}

// Entries of the overlap in which the foot bears in both motions; the join if there are
// none.
std::vector<std::size_t> common_entries(const FootContacts& first,
                                        const FootContacts& second,
                                        const JoinFrames& frames) {
  std::vector<std::size_t> out;
  for (int k = frames.body.first; k <= frames.body.last; ++k) {
    if (stands_at(first, frames.start + k) && stands_at(second, k)) {
      out.push_back(static_cast<std::size_t>(k));
    }
  }
  if (out.empty()) out.push_back(static_cast<std::size_t>(frames.join - frames.start));
  return out;
}

FootPlace mixed_place(const FootPlace& a, const FootPlace& b, double share) {
  return {glm::mix(a.ankle_in_world, b.ankle_in_world, share),
          glm::normalize(glm::slerp(a.foot, b.foot, share)),
          glm::normalize(glm::slerp(a.toes, b.toes, share))};
}

// Place of the foot in a stance across an overlap.
void bridge_overlap(const OverlapFeet& feet,
                    const BridgeMoves& moves,
                    const FrameRange& stance,
                    const JoinFrames& frames,
                    std::vector<FootPlace>& way) {
  const int start = frames.start + frames.body.first;
  const int end = frames.start + frames.body.last;
  for (int t = stance.first; t <= stance.last; ++t) {
    FootPlace& place = way[static_cast<std::size_t>(t)];
    if (t < start) {
      place = moves.first.moved(feet.first[static_cast<std::size_t>(t)]);
      continue;
    }
    const auto k = static_cast<std::size_t>(t - frames.start);
    place = moves.second.moved(feet.second[k]);
    if (t > end) continue;
    place = mixed_place(moves.first.moved(feet.first[static_cast<std::size_t>(t)]),
                        place,
                        frames.weight[k]);
  }
}

// Place of the foot in a stance across a join without an overlap. The rest of the
// gap after the moves on the floor, height and tilt, fades on both sides, half of it
// each.
void bridge_gap(const OverlapFeet& feet,
                const BridgeMoves& moves,
                const FrameRange& stance,
                const JoinFrames& frames,
                double fade_frames,
                std::vector<FootPlace>& way) {
  const FootPlace a =
      moves.first.moved(feet.first[static_cast<std::size_t>(frames.join)]);
  const FootPlace b = moves.second.moved(feet.second.front());
  const FootPlace middle = mixed_place(a, b, 0.5);
  for (int t = stance.first; t <= stance.last; ++t) {
    const bool is_first = t <= frames.join;
    const FootPlace own =
        is_first
            ? moves.first.moved(feet.first[static_cast<std::size_t>(t)])
            : moves.second.moved(feet.second[static_cast<std::size_t>(t - frames.start)]);
    const FootPlace& at_join = is_first ? a : b;
    const double share =
        1.0 - smooth_step(std::abs(t - frames.join) / fade_frames);
    const auto tilt = [&](const glm::dquat& from, const glm::dquat& to) {
      return rotation_from_vector(share * rotation_vector(to * glm::conjugate(from)));
    };
    FootPlace& place = way[static_cast<std::size_t>(t)];
    place.ankle_in_world =
        own.ankle_in_world + share * (middle.ankle_in_world - at_join.ankle_in_world);
    place.foot = glm::normalize(tilt(at_join.foot, middle.foot) * own.foot);
    place.toes = glm::normalize(tilt(at_join.toes, middle.toes) * own.toes);
  }
}

void place_foot(const OverlapFeet& feet,
                const std::array<const FootContacts*, 2>& own,
                const std::vector<FrameRange>& stances,
                const JoinFrames& frames,
                double hz,
                std::vector<FootPlace>& way) {
  for (const FrameRange& stance : stances) {
    // A stance of one motion may reach a little beyond the join (join_contacts()).
    const bool is_first =
        stands_within(*own[0], {stance.first, std::min(stance.last, frames.join)});
    const bool is_second =
        stands_within(*own[1],
                      {std::max(stance.first, frames.join + 1) - frames.start,
                       stance.last - frames.start});
    if (is_first && is_second) {
      const auto entries = common_entries(*own[0], *own[1], frames);
      const BridgeMoves moves = halves_of_gap(feet, entries, frames);
      if (frames.weight.size() > 1) {
        bridge_overlap(feet, moves, stance, frames, way);
      } else {
        bridge_gap(feet, moves, stance, frames, kTiltFade_s * hz, way);
      }
      continue;
    }
    for (int t = stance.first; t <= stance.last; ++t) {
      way[static_cast<std::size_t>(t)] =
          is_first ? feet.first[static_cast<std::size_t>(t)]
                   : feet.second[static_cast<std::size_t>(t - frames.start)];
    }
  }
}

}  // namespace

FootWays bridge_stances(const EditState& first,
                        const EditState& second,
                        const JoinFrames& frames,
                        const EditState& out) {
  FootWays ways{foot_places(out, 0), foot_places(out, 1)};
  for (std::size_t side = 0; side < 2; ++side) {
    const int foot = static_cast<int>(side);
    const OverlapFeet feet{
        foot_places(first, foot), foot_places(second, foot), out.map.feet[side]};
    place_foot(feet,
               {&first.contacts.feet[side], &second.contacts.feet[side]},
               out.contacts.feet[side].stance,
               frames,
               out.motion.rate.hz,
               ways[side]);
  }
  return ways;
}

}  // namespace marey::edit
