// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/find_splice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <tuple>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/adapt_to_ground.h"

namespace marey::edit {
namespace {

constexpr double kWholeTurn_rad = 6.283185307179586477;
constexpr double kMaxGridPairs = 40'000.0;
// Places of the grid that are searched frame by frame.
constexpr std::size_t kRefinedPlaces = 12;

// Compares two frames where they are, without a move.
PlanarMatch match_in_place(const MatchPoints& a,
                           int frame_a,
                           const MatchPoints& b,
                           int frame_b,
                           const MatchOptions& options) {
  PlanarMatch match;
  const auto points = static_cast<std::size_t>(a.point_count());
  double places = 0.0;
  double velocities = 0.0;
  for (std::size_t p = 0; p < points; ++p) {
    const std::size_t at_a = static_cast<std::size_t>(frame_a) * points + p;
    const std::size_t at_b = static_cast<std::size_t>(frame_b) * points + p;
    const glm::dvec3 off = a.places[at_a] - b.places[at_b];
    const glm::dvec3 faster = a.velocities[at_a] - b.velocities[at_b];
    places += a.weights[p] * glm::dot(off, off);
    velocities += a.weights[p] * glm::dot(faster, faster);
    match.worst_m = std::max(match.worst_m, glm::length(off));
  }
  match.rms_m = std::sqrt(places);
  match.rms_velocity_m_per_s = std::sqrt(velocities);
  match.distance_m =
      std::sqrt(places + options.velocity_s * options.velocity_s * velocities);
  return match;
}

// Frames in which each foot stands.
using StanceMarks = std::array<std::vector<char>, 2>;

StanceMarks marks_of_stances(const Contacts& contacts) {
  const auto count = static_cast<std::size_t>(contacts.frame_count);
  return {retarget::frame_marks(contacts.feet[0].stance, count),
          retarget::frame_marks(contacts.feet[1].stance, count)};
}

SupportClass class_of(bool left, bool right) {
  if (left && right) return SupportClass::kBoth;
  if (left) return SupportClass::kLeft;
  return right ? SupportClass::kRight : SupportClass::kNone;
}

SupportClass class_at(const StanceMarks& marks, int frame) {
  const auto t = static_cast<std::size_t>(frame);
  return class_of(marks[0][t] != 0, marks[1][t] != 0);
}

double floor_of(const EditState& state) {
  return retarget::floor_height_m(state.map,
                                  retarget::ankles_rest_m(state.map, state.contacts));
}

// Direction of the pelvis on the floor in each frame, as an angle from +Z to +X. [rad]
std::vector<double> facings_of(const EditState& state) {
  std::vector<double> out;
  std::vector<RigidTransform> joints(state.motion.skeleton.joints.size());
  for (const Pose& pose : state.motion.poses) {
    world_from_joints(state.motion.skeleton, pose, joints);
    const glm::dvec3 ahead =
        retarget::rotation_from_t_pose(state.map, joints, state.map.hips()) *
        glm::dvec3(0.0, 0.0, 1.0);
    out.push_back(std::atan2(ahead.x, ahead.z));
  }
  return out;
}

class SpliceSearch {
 public:
  SpliceSearch(const EditState& first,
               const EditState& second,
               const FindSpliceOptions& options)
      : a_(match_points(first.motion, first.map)),
        b_(match_points(second.motion, second.map)),
        stands_a_(marks_of_stances(first.contacts)),
        stands_b_(marks_of_stances(second.contacts)),
        facing_a_(facings_of(first)),
        facing_b_(facings_of(second)),
        hz_(first.motion.rate.hz),
        options_(options) {
    if (!options.align) return;
    // Motions are compared above their own floors.
    const double raised_m = floor_of(first) - floor_of(second);
    for (glm::dvec3& place : b_.places) place.y += raised_m;
  }

  // Adds the pairs of the windows on a grid of this step.
  void add(const SpliceWindows& windows, int step, std::vector<SpliceCandidate>& out) {
    for (int i = windows.leave.last; i >= windows.leave.first; i -= step) {
      for (int j = windows.enter.first; j <= windows.enter.last; j += step) {
        if (!accepts(i, j)) continue;
        SpliceCandidate pair;
        pair.leave = i;
        pair.enter = j;
        pair.match = options_.align ? match_windows(a_, i, b_, j, options_.match)
                                    : match_in_place(a_, i, b_, j, options_.match);
        pair.unlike_s = unlike_s(i, j);
        pair.facing_rad = std::remainder(facing_b_[static_cast<std::size_t>(j)] +
                                             pair.match.a_from_b.turn_rad -
                                             facing_a_[static_cast<std::size_t>(i)],
                                         kWholeTurn_rad);
        pair.cost_m = pair.match.distance_m + options_.unlike_m_per_s * pair.unlike_s +
                      options_.facing_m * (1.0 - std::cos(pair.facing_rad));
        out.push_back(pair);
      }
    }
  }

 private:
  [[nodiscard]] bool accepts(int i, int j) const {
    return options_.allow_opposed ||
           !supports_oppose(class_at(stands_a_, i), class_at(stands_b_, j));
  }
  [[nodiscard]] double unlike_s(int i, int j) const {
    const int around = static_cast<int>(std::lround(options_.around_s * hz_));
    const int before = std::min({around, i, j});
    const int after =
        std::min({around, a_.frame_count() - 1 - i, b_.frame_count() - 1 - j});
    int count = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      for (int k = -before; k <= after; ++k) {
        if (stands_a_[side][static_cast<std::size_t>(i + k)] !=
            stands_b_[side][static_cast<std::size_t>(j + k)]) {
          ++count;
        }
      }
    }
    return count / hz_;
  }

  MatchPoints a_;
  MatchPoints b_;
  StanceMarks stands_a_;
  StanceMarks stands_b_;
  std::vector<double> facing_a_;
  std::vector<double> facing_b_;
  double hz_;
  const FindSpliceOptions& options_;
};

// Costs this near are equal: the root of a rounding error must not decide. [m]
constexpr double kSameCost_m = 1e-5;

void sort_by_cost(std::vector<SpliceCandidate>& candidates) {
  std::sort(candidates.begin(),
            candidates.end(),
            [](const SpliceCandidate& x, const SpliceCandidate& y) {
              return std::tuple(std::llround(x.cost_m / kSameCost_m), -x.leave, x.enter) <
                     std::tuple(std::llround(y.cost_m / kSameCost_m), -y.leave, y.enter);
            });
}

bool is_near(const SpliceCandidate& x, const SpliceCandidate& y, double frames) {
  return std::abs(x.leave - y.leave) <= frames && std::abs(x.enter - y.enter) <= frames;
}

// Keeps the best of each neighbourhood. `candidates` are sorted.
std::vector<SpliceCandidate> separate(const std::vector<SpliceCandidate>& candidates,
                                      double frames,
                                      std::size_t max_count) {
  std::vector<SpliceCandidate> out;
  for (const SpliceCandidate& candidate : candidates) {
    if (out.size() >= max_count) break;
    const bool is_known = std::any_of(out.begin(), out.end(), [&](const auto& kept) {
      return is_near(kept, candidate, frames);
    });
    if (!is_known) out.push_back(candidate);
  }
  return out;
}

FrameRange near_frame(int frame, int step, const FrameRange& within) {
  return {std::max(frame - step, within.first), std::min(frame + step, within.last)};
}

bool contains_frame(const std::vector<FrameRange>& runs, int frame) {
  return std::any_of(runs.begin(), runs.end(), [&](const FrameRange& run) {
    return run.first <= frame && frame <= run.last;
  });
}

}  // namespace

SupportClass support_class(const Contacts& contacts, int frame) {
  MAREY_ASSERT(frame >= 0 && frame < contacts.frame_count);
  return class_of(contains_frame(contacts.feet[0].stance, frame),
                  contains_frame(contacts.feet[1].stance, frame));
}

bool supports_oppose(SupportClass a, SupportClass b) {
  return (a == SupportClass::kLeft && b == SupportClass::kRight) ||
         (a == SupportClass::kRight && b == SupportClass::kLeft);
}

std::vector<SpliceCandidate> find_splices(const EditState& first,
                                          const EditState& second,
                                          const SpliceWindows& windows,
                                          const FindSpliceOptions& options) {
  const auto [leave, enter] = windows;
  MAREY_ASSERT(leave.first >= 0 && leave.first <= leave.last &&
               leave.last < first.frame_count());
  MAREY_ASSERT(enter.first >= 0 && enter.first <= enter.last &&
               enter.last < second.frame_count());
  SpliceSearch search(first, second, options);
  const double pairs =
      (leave.last - leave.first + 1.0) * (enter.last - enter.first + 1.0);
  const int step =
      std::max(1, static_cast<int>(std::ceil(std::sqrt(pairs / kMaxGridPairs))));
  std::vector<SpliceCandidate> candidates;
  search.add(windows, step, candidates);
  sort_by_cost(candidates);
  if (step > 1) {
    for (const auto& place : separate(candidates, 2.0 * step, kRefinedPlaces)) {
      search.add(
          {near_frame(place.leave, step, leave), near_frame(place.enter, step, enter)},
          1,
          candidates);
    }
    sort_by_cost(candidates);
  }
  return separate(candidates,
                  options.separation_s * first.motion.rate.hz,
                  static_cast<std::size_t>(std::max(0, options.max_candidates)));
}

}  // namespace marey::edit
