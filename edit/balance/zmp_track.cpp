// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/balance/zmp_track.h"

#include <cstddef>
#include <utility>

#include "dynamics/momentum/angular_momentum.h"

#include "retarget/balance/measure_balance.h"
#include "retarget/contacts/contact_edges.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {

double standing_floor_m(const retarget::BodyMap& map, const Contacts& contacts) {
  double sum_m = 0.0;
  int feet = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& foot = contacts.feet[side];
    if (foot.stance.empty()) continue;
    sum_m += foot.ankle_height_m + map.feet[side].heel_from_ankle_in_t_pose.y;
    ++feet;
  }
  return feet > 0 ? sum_m / feet : 0.0;
}

// Returns the frames of either.
std::vector<FrameRange> either_runs(const std::vector<FrameRange>& runs,
                                    const std::vector<FrameRange>& others,
                                    std::size_t frames) {
  std::vector<char> marks = retarget::frame_marks(runs, frames);
  const std::vector<char> more = retarget::frame_marks(others, frames);
  for (std::size_t t = 0; t < frames; ++t) {
    if (more[t] != 0) marks[t] = 1;
  }
  return retarget::runs_with(marks);
}

}  // namespace

ZmpGround zmp_ground(const Motion& motion,
                     const retarget::BodyMap& map,
                     const Contacts& contacts) {
  ZmpGround out{contacts, standing_floor_m(map, contacts)};
  retarget::move_to_edges(
      retarget::find_contact_edges(motion, map, contacts), motion.rate, out.loaded);
  const std::size_t frames = motion.poses.size();
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& detected = contacts.feet[side];
    FootContacts& foot = out.loaded.feet[side];
    foot.heel = either_runs(foot.heel, detected.heel, frames);
    foot.ball = either_runs(foot.ball, detected.ball, frames);
    foot.stance = either_runs(foot.stance, detected.stance, frames);
  }
  return out;
}

ZmpTrack zmp_track(const Motion& motion,
                   const retarget::BodyMap& map,
                   std::span<const PointMass> masses,
                   const ZmpGround& ground) {
  ZmpTrack out;
  std::vector<glm::dvec3> momentum_per_kg_m2_s;
  for (const dynamics::CentroidalState& state :
       dynamics::centroidal_states(motion.skeleton, masses, motion.rate, motion.poses)) {
    out.com_in_world.push_back(state.com_in_world);
    momentum_per_kg_m2_s.push_back(state.angular_momentum_kg_m2_s / state.mass_kg);
  }
  dynamics::ZmpOptions options;
  options.floor_height_m = ground.floor_height_m;
  out.reactions = dynamics::ground_reactions(
      out.com_in_world, momentum_per_kg_m2_s, motion.rate, options);
  for (retarget::BalanceFrame& frame :
       retarget::balance_frames(motion, map, masses, ground.loaded)) {
    out.supports.push_back(std::move(frame.support_xz_m));
  }
  return out;
}

}  // namespace marey::edit
