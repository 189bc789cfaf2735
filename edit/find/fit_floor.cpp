// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/fit_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "core/pose.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/leg_placement.h"

namespace marey::edit {
namespace {

/// Sum of one joint's places in a stance.
struct RestSum {
  glm::dvec3 sum{0.0};
  int frames = 0;

  void add(const glm::dvec3& p) {
    sum += p;
    ++frames;
  }
  [[nodiscard]] glm::dvec3 mean() const { return sum / static_cast<double>(frames); }
};

/// Ankle and toe joint of one side, frame by frame.
struct FootWays {
  std::vector<glm::dvec3> ankle;
  std::vector<glm::dvec3> ball;
};

FootWays foot_ways(const EditState& state, int side) {
  FootWays out;
  const Skeleton& skeleton = state.motion.skeleton;
  const auto toes = state.map.joint_of[marey::index(retarget::toes_bone(side))];
  std::vector<RigidTransform> joints(skeleton.joints.size());
  for (const Pose& pose : state.motion.poses) {
    world_from_joints(skeleton, pose, joints);
    out.ankle.push_back(joints[index(state.map.leg(side).end)].translation);
    out.ball.push_back(toes ? joints[index(*toes)].translation : out.ankle.back());
  }
  return out;
}

/// Sums a point over the middle half of the frames that count: at both ends of a contact
/// the foot still lands, or leaves already.
template <class Counts, class Point>
RestSum middle_of(const FrameRange& run, const Counts& counts, const Point& point) {
  int total = 0;
  for (int frame = run.first; frame <= run.last; ++frame) total += counts(frame) ? 1 : 0;
  RestSum out;
  const int skipped = total / 4;
  int seen = 0;
  for (int frame = run.first; frame <= run.last; ++frame) {
    if (!counts(frame)) continue;
    if (seen >= skipped && seen < total - skipped) out.add(point(frame));
    ++seen;
  }
  return out;
}

/// Main axes of points on the floor, and the standard deviations along them.
struct FloorAxes {
  glm::dvec2 centre{0.0};
  glm::dvec2 along{0.0, 1.0};
  glm::dvec2 across{1.0, 0.0};
  double along_m = 0.0;
  double across_m = 0.0;
};

FloorAxes axes_of(std::span<const RestingSole> soles) {
  FloorAxes out;
  const auto count = static_cast<double>(soles.size());
  for (const RestingSole& sole : soles) {
    out.centre += glm::dvec2(sole.p_in_world.x, sole.p_in_world.z) / count;
  }
  double xx = 0.0;
  double xz = 0.0;
  double zz = 0.0;
  for (const RestingSole& sole : soles) {
    const glm::dvec2 p = glm::dvec2(sole.p_in_world.x, sole.p_in_world.z) - out.centre;
    xx += p.x * p.x / count;
    xz += p.x * p.y / count;
    zz += p.y * p.y / count;
  }
  const double angle = 0.5 * std::atan2(2.0 * xz, xx - zz);
  const double half = std::hypot(0.5 * (xx - zz), xz);
  out.along = {std::cos(angle), std::sin(angle)};
  out.across = {-out.along.y, out.along.x};
  out.along_m = std::sqrt(std::max(0.5 * (xx + zz) + half, 0.0));
  out.across_m = std::sqrt(std::max(0.5 * (xx + zz) - half, 0.0));
  return out;
}

/// Height of the floor at the centre, and its slopes along both axes.
using FloorSlopes = glm::dvec3;

double scale_of(const FloorSlopes& slopes) {
  return std::sqrt(1.0 + slopes.y * slopes.y + slopes.z * slopes.z);
}

/// Returns 1 and the place along the axes whose slopes are observed; 0 for the others.
glm::dvec3 row_of(const RestingSole& sole, const FloorAxes& axes, FloorRank rank) {
  const glm::dvec2 p = glm::dvec2(sole.p_in_world.x, sole.p_in_world.z) - axes.centre;
  return {1.0,
          rank == FloorRank::kHeight ? 0.0 : glm::dot(p, axes.along),
          rank == FloorRank::kPlane ? glm::dot(p, axes.across) : 0.0};
}

/// Distance of a sole from the floor.
double residual_of(const RestingSole& sole,
                   const FloorAxes& axes,
                   FloorRank rank,
                   const FloorSlopes& slopes) {
  const double scale = scale_of(slopes);
  return (sole.p_in_world.y - glm::dot(row_of(sole, axes, rank), slopes)) / scale -
         sole.height_m;
}

FloorSlopes solve_slopes(std::span<const RestingSole> soles,
                         const FloorAxes& axes,
                         FloorRank rank) {
  constexpr double kHuber_m = 0.010;
  constexpr int kRounds = 30;
  FloorSlopes slopes(0.0);
  for (int round = 0; round < kRounds; ++round) {
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (const RestingSole& sole : soles) {
      const glm::dvec3 row = row_of(sole, axes, rank);
      const double off_m = std::abs(residual_of(sole, axes, rank, slopes));
      const double weight = round == 0 || off_m <= kHuber_m ? 1.0 : kHuber_m / off_m;
      normal += weight * glm::outerProduct(row, row);
      right += weight * row * (sole.p_in_world.y - sole.height_m * scale_of(slopes));
    }
    // Slopes that are not observed are zero.
    if (rank == FloorRank::kHeight) normal[1][1] = 1.0;
    if (rank != FloorRank::kPlane) normal[2][2] = 1.0;
    slopes = glm::inverse(normal) * right;
  }
  return slopes;
}

}  // namespace

std::vector<RestingSole> resting_soles(const EditState& state,
                                       const Contacts& contacts,
                                       const FrameRange& frames) {
  std::vector<RestingSole> out;
  const std::size_t count = state.motion.poses.size();
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    const FootWays ways = foot_ways(state, side);
    const auto heel = retarget::frame_marks(contacts.feet[s].heel, count);
    const auto ball = retarget::frame_marks(contacts.feet[s].ball, count);
    const double ankle_m = state.map.feet[s].ankle_height_m;
    const double ball_m =
        state.map.feet[s].has_toes ? state.map.feet[s].ball_height_m : ankle_m;
    for (const FrameRange& run : contacts.feet[s].stance) {
      if (run.first < frames.first || run.last > frames.last) continue;
      const auto rests_on = [&](int frame) {
        const auto t = static_cast<std::size_t>(frame);
        return (heel[t] ? 1 : 0) + (ball[t] ? 2 : 0);
      };
      const RestSum flat = middle_of(
          run,
          [&](int f) { return rests_on(f) == 3; },
          [&](int f) {
            const auto t = static_cast<std::size_t>(f);
            return 0.5 * (ways.ankle[t] + ways.ball[t]);
          });
      const RestSum on_ball = middle_of(
          run,
          [&](int f) { return rests_on(f) >= 2; },
          [&](int f) { return ways.ball[static_cast<std::size_t>(f)]; });
      const RestSum on_heel = middle_of(
          run,
          [&](int f) { return rests_on(f) == 1; },
          [&](int f) { return ways.ankle[static_cast<std::size_t>(f)]; });
      if (flat.frames > 0) {
        out.push_back({flat.mean(), 0.5 * (ankle_m + ball_m), run});
      } else if (on_ball.frames > 0) {
        out.push_back({on_ball.mean(), ball_m, run});
      } else if (on_heel.frames > 0) {
        out.push_back({on_heel.mean(), ankle_m, run});
      }
    }
  }
  return out;
}

std::optional<FloorFit> fit_floor(std::span<const RestingSole> soles,
                                  double min_spread_m) {
  if (soles.empty()) return std::nullopt;
  const FloorAxes axes = axes_of(soles);
  FloorFit out;
  if (soles.size() >= 2 && axes.along_m >= min_spread_m) out.rank = FloorRank::kLine;
  if (soles.size() >= 3 && axes.across_m >= min_spread_m) out.rank = FloorRank::kPlane;
  const FloorSlopes slopes = solve_slopes(soles, axes, out.rank);
  const glm::dvec2 rise = slopes.y * axes.along + slopes.z * axes.across;
  out.normal = glm::normalize(glm::dvec3(-rise.x, 1.0, -rise.y));
  double squares = 0.0;
  for (const RestingSole& sole : soles) {
    const double off_m = residual_of(sole, axes, out.rank, slopes);
    out.support_in_world += (sole.p_in_world - (sole.height_m + off_m) * out.normal) /
                            static_cast<double>(soles.size());
    squares += off_m * off_m;
    if (std::abs(off_m) <= out.largest_residual_m) continue;
    out.largest_residual_m = std::abs(off_m);
    out.worst_frame = sole.stance.first;
  }
  const auto count = static_cast<double>(soles.size());
  out.residual_m = std::sqrt(squares / count);
  if (out.rank == FloorRank::kPlane && soles.size() > 3) {
    out.tilt_sigma_rad = std::sqrt(squares / (count - 3.0) / count) / axes.across_m;
  }
  return out;
}

}  // namespace marey::edit
