// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/balance/shift_zmp.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "dynamics/balance/keep_zmp.h"
#include "edit/balance/zmp_track.h"
#include "edit/state/hold_feet.h"
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/human/centre_of_mass.h"
#include "core/pose.h"

namespace marey::edit {
namespace {

constexpr int kRounds = 12;
// Corrections of the root until the centre of mass is displaced as wanted.
constexpr int kRootSteps = 3;
// Margins of the rounds: a later round needs less, since it corrects less. [m]
constexpr double kMargin_m = 0.010;
constexpr double kEnough_m = 0.0005;

// Moves the centres of mass of a motion with held feet.
class RootShifter {
 public:
  RootShifter(const EditState& state,
              std::span<const PointMass> masses,
              const OpWeights& weights)
      : state_(state),
        masses_(masses),
        weights_(weights),
        kept_(keep_standing_feet(state)),
        root_m_(state.motion.poses.size(), glm::dvec2(0.0)),
        world_from_joint_(state.motion.skeleton.joints.size()) {}

  // Moves roots until each centre of mass is at its target, X and Z.
  void reach(std::span<const glm::dvec2> target_xz_m, Motion& motion) {
    for (int step = 0; step < kRootSteps; ++step) {
      for (int frame = weights_.frames.first; frame <= weights_.frames.last; ++frame) {
        const auto t = static_cast<std::size_t>(frame);
        const glm::dvec3 com = centre(motion.poses[t]);
        root_m_[t] += target_xz_m[t] - glm::dvec2(com.x, com.z);
        motion.poses[t] = state_.motion.poses[t];
        motion.poses[t].root_in_world += glm::dvec3(root_m_[t].x, 0.0, root_m_[t].y);
      }
      held_ = hold_feet(state_, state_.motion, weights_.frames, kept_, motion);
    }
  }

  [[nodiscard]] glm::dvec3 centre(const Pose& pose) {
    world_from_joints(state_.motion.skeleton, pose, world_from_joint_);
    return centre_of_mass(masses_, world_from_joint_);
  }
  [[nodiscard]] const HoldFeetReport& held() const { return held_; }
  [[nodiscard]] double max_shift_m() const {
    double out = 0.0;
    for (const glm::dvec2& way : root_m_) out = std::max(out, glm::length(way));
    return out;
  }

 private:
  const EditState& state_;
  std::span<const PointMass> masses_;
  const OpWeights& weights_;
  KeptFeet kept_;
  std::vector<glm::dvec2> root_m_;
  std::vector<RigidTransform> world_from_joint_;
  HoldFeetReport held_;
};

// The round that left the fewest points outside.
struct BestRound {
  Motion motion;
  dynamics::ZmpFigures figures;
  HoldFeetReport held;
  double max_shift_m = 0.0;
};

// Scales the limits, which are those of an adult, for bodies that are taller.
void scale_to(std::span<const glm::dvec3> com_in_world,
              dynamics::KeepZmpOptions& options) {
  constexpr double kAdult_m = 0.95;
  double height_m = 0.0;
  for (const glm::dvec3& com : com_in_world) {
    height_m +=
        (com.y - options.zmp.floor_height_m) / static_cast<double>(com_in_world.size());
  }
  const double scale = std::max(height_m / kAdult_m, 1.0);
  options.max_shift_m *= scale;
  options.modest_shift_m *= scale;
  options.price_m *= scale;
}

// Compares the frames that may change.
dynamics::ZmpFigures figures_within(const FrameRange& frames, const ZmpTrack& track) {
  const auto first = static_cast<std::size_t>(frames.first);
  const auto count = static_cast<std::size_t>(frames.last - frames.first + 1);
  dynamics::ZmpFigures out =
      dynamics::zmp_figures(std::span(track.reactions).subspan(first, count),
                            std::span(track.supports).subspan(first, count));
  if (out.worst_frame) *out.worst_frame += frames.first;
  return out;
}

}  // namespace

ShiftZmpReport shift_zmp(const EditState& state,
                         std::span<const PointMass> masses,
                         const OpWeights& weights,
                         Motion& motion) {
  ShiftZmpReport report;
  if (weights.frames.last < weights.frames.first) return report;
  const ZmpGround ground = zmp_ground(state.motion, state.map, state.contacts);
  RootShifter shifter(state, masses, weights);
  dynamics::KeepZmpOptions options;
  options.zmp.floor_height_m = ground.floor_height_m;
  std::vector<glm::dvec2> displaced(motion.poses.size(), glm::dvec2(0.0));
  std::vector<glm::dvec3> start_in_world;
  BestRound best;
  int fewest = 0;
  for (int round = 0; round <= kRounds; ++round) {
    const ZmpTrack track = zmp_track(motion, state.map, masses, ground);
    report.after = figures_within(weights.frames, track);
    if (round == 0) {
      report.before = report.after;
      start_in_world = track.com_in_world;
      scale_to(track.com_in_world, options);
    }
    const int outside = report.after.supported_frames - report.after.inside_frames;
    if (round == 0 || outside < fewest) {
      fewest = outside;
      best = {motion, report.after, shifter.held(), shifter.max_shift_m()};
    }
    if (round == kRounds) break;
    if (round > 0 && report.after.inside_frames == report.after.supported_frames) break;
    for (std::size_t t = 0; t < displaced.size(); ++t) {
      const glm::dvec3 way = track.com_in_world[t] - start_in_world[t];
      displaced[t] = {way.x, way.z};
    }
    options.margin_m = round == 0 ? kMargin_m : 0.8 * kMargin_m;
    const dynamics::KeepZmpResult step = dynamics::keep_zmp({track.com_in_world,
                                                             track.reactions,
                                                             track.supports,
                                                             motion.rate,
                                                             displaced,
                                                             weights.weight},
                                                            options);
    // A price that was too high stays so.
    options.price_m = step.price_m;
    std::vector<glm::dvec2> target(motion.poses.size());
    double largest_m = 0.0;
    for (std::size_t t = 0; t < target.size(); ++t) {
      const glm::dvec3& com = track.com_in_world[t];
      target[t] = glm::dvec2(com.x, com.z) + step.shift_xz_m[t];
      largest_m = std::max(largest_m, glm::length(step.shift_xz_m[t]));
    }
    if (largest_m <= 0.0 || (round > 0 && largest_m < kEnough_m)) break;
    shifter.reach(target, motion);
  }
  motion = std::move(best.motion);
  report.after = best.figures;
  report.max_shift_m = best.max_shift_m;
  report.lowered_m = best.held.lowered_m;
  report.missed_m = best.held.missed_m;
  report.missed_frame = best.held.missed_frame;
  return report;
}

}  // namespace marey::edit
