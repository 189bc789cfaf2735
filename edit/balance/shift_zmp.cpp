// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/balance/shift_zmp.h"

#include <algorithm>
#include <cstddef>

#include "dynamics/balance/keep_zmp.h"
#include "dynamics/momentum/angular_momentum.h"
#include "edit/state/hold_feet.h"
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/human/centre_of_mass.h"
#include "core/pose.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/contacts/contact_edges.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {

constexpr int kRounds = 6;
// Corrections of the root until the centre of mass is displaced as wanted.
constexpr int kRootSteps = 3;
// Margins of the rounds: a later round needs less, since it corrects less. [m]
constexpr double kMargin_m = 0.010;
constexpr double kEnough_m = 0.0005;

// Returns the height of the soles of standing feet; 0 if no foot ever stands.
double standing_floor_m(const EditState& state) {
  double sum_m = 0.0;
  int feet = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& foot = state.contacts.feet[side];
    if (foot.stance.empty()) continue;
    sum_m += foot.ankle_height_m + state.map.feet[side].heel_from_ankle_in_t_pose.y;
    ++feet;
  }
  return feet > 0 ? sum_m / feet : 0.0;
}

struct BodyStates {
  std::vector<glm::dvec3> com_in_world;
  std::vector<glm::dvec3> momentum_per_kg_m2_s;
};

BodyStates body_states(std::span<const PointMass> masses, const Motion& motion) {
  BodyStates out;
  for (const dynamics::CentroidalState& state :
       dynamics::centroidal_states(motion.skeleton, masses, motion.rate, motion.poses)) {
    out.com_in_world.push_back(state.com_in_world);
    out.momentum_per_kg_m2_s.push_back(state.angular_momentum_kg_m2_s / state.mass_kg);
  }
  return out;
}

// Adds the frames of other runs to runs.
std::vector<FrameRange> either(const std::vector<FrameRange>& runs,
                               const std::vector<FrameRange>& others,
                               std::size_t frames) {
  const std::vector<char> marks = retarget::frame_marks(runs, frames);
  const std::vector<char> more = retarget::frame_marks(others, frames);
  std::vector<FrameRange> out;
  for (std::size_t t = 0; t < frames; ++t) {
    if (marks[t] == 0 && more[t] == 0) continue;
    const int frame = static_cast<int>(t);
    if (out.empty() || out.back().last + 1 < frame) out.push_back({frame, frame});
    out.back().last = frame;
  }
  return out;
}

// Returns the contacts from strike to toe-off, and the detected ones where they are
// longer.
Contacts loaded_contacts(const EditState& state) {
  Contacts out = state.contacts;
  retarget::move_to_edges(
      retarget::find_contact_edges(state.motion, state.map, state.contacts),
      state.motion.rate,
      out);
  const std::size_t frames = state.motion.poses.size();
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& detected = state.contacts.feet[side];
    out.feet[side].heel = either(out.feet[side].heel, detected.heel, frames);
    out.feet[side].ball = either(out.feet[side].ball, detected.ball, frames);
  }
  return out;
}

ZmpTrack track_of(const EditState& state,
                  const Contacts& loaded,
                  std::span<const PointMass> masses,
                  const Motion& motion,
                  const BodyStates& body) {
  dynamics::ZmpOptions options;
  options.floor_height_m = standing_floor_m(state);
  ZmpTrack out;
  out.reactions = dynamics::ground_reactions(
      body.com_in_world, body.momentum_per_kg_m2_s, motion.rate, options);
  for (retarget::BalanceFrame& frame :
       retarget::balance_frames(motion, state.map, masses, loaded)) {
    out.supports.push_back(std::move(frame.support_xz_m));
  }
  return out;
}

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

}  // namespace

ZmpTrack zmp_track(const EditState& state,
                   std::span<const PointMass> masses,
                   const Motion& motion) {
  return track_of(
      state, loaded_contacts(state), masses, motion, body_states(masses, motion));
}

ShiftZmpReport shift_zmp(const EditState& state,
                         std::span<const PointMass> masses,
                         const OpWeights& weights,
                         Motion& motion) {
  ShiftZmpReport report;
  const Contacts loaded = loaded_contacts(state);
  RootShifter shifter(state, masses, weights);
  dynamics::KeepZmpOptions options;
  options.zmp.floor_height_m = standing_floor_m(state);
  std::vector<glm::dvec2> displaced(motion.poses.size(), glm::dvec2(0.0));
  std::vector<glm::dvec3> start_in_world;
  for (int round = 0; round <= kRounds; ++round) {
    const BodyStates body = body_states(masses, motion);
    const ZmpTrack track = track_of(state, loaded, masses, motion, body);
    report.after = dynamics::zmp_figures(track.reactions, track.supports);
    if (round == 0) {
      report.before = report.after;
      start_in_world = body.com_in_world;
    }
    if (round == kRounds) break;
    options.margin_m = round == 0 ? kMargin_m : 0.8 * kMargin_m;
    const dynamics::KeepZmpResult step = dynamics::keep_zmp({body.com_in_world,
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
      const glm::dvec3& com = body.com_in_world[t];
      target[t] = glm::dvec2(com.x, com.z) + step.shift_xz_m[t];
      largest_m = std::max(largest_m, glm::length(step.shift_xz_m[t]));
      displaced[t] = target[t] - glm::dvec2(start_in_world[t].x, start_in_world[t].z);
    }
    if (largest_m <= 0.0 || (round > 0 && largest_m < kEnough_m)) break;
    shifter.reach(target, motion);
  }
  report.max_shift_m = shifter.max_shift_m();
  report.lowered_m = shifter.held().lowered_m;
  report.missed_m = shifter.held().missed_m;
  report.missed_frame = shifter.held().missed_frame;
  return report;
}

}  // namespace marey::edit
