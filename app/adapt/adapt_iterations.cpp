// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/adapt_iterations.h"

#include <algorithm>

namespace marey::app {
namespace {

/// Returns the supports that bear in a frame, restricted to that frame.
std::vector<retarget::SupportTrack> bearing_in(
    std::size_t frame, std::span<const retarget::SupportTrack> supports) {
  std::vector<retarget::SupportTrack> out;
  for (const retarget::SupportTrack& track : supports) {
    const bool bears = std::ranges::any_of(track.bears, [&](const auto& run) {
      return run.first <= static_cast<int>(frame) && static_cast<int>(frame) <= run.last;
    });
    if (!bears) continue;
    out.push_back({track.constraint,
                   {{0, 0}},
                   {},
                   {track.p_in_world[frame]},
                   {track.world_from_t_pose[frame]},
                   track.ball_in_t_pose});
  }
  return out;
}

}  // namespace

std::vector<char> try_more_iterations(const AdaptBody& body,
                                      std::span<const retarget::SupportTrack> supports,
                                      retarget::AdaptMotionOptions options,
                                      const ConstraintSet& constraints,
                                      std::span<const retarget::KeptConstraint> kept) {
  std::vector<char> out(kept.size(), 0);
  const int usual = retarget::AdaptOptions{}.max_iterations;
  if (options.adapt.max_iterations >= usual) return out;
  options.adapt.max_iterations = usual;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i].ran_out || !kept[i].worst_frame) continue;
    const auto at = static_cast<std::size_t>(*kept[i].worst_frame);
    const Motion& motion = body.reference;
    const Motion one{motion.skeleton,
                     motion.rate,
                     motion.first_frame + *kept[i].worst_frame,
                     {motion.poses[at]}};
    const auto again = retarget::adapt_motion(
        one, body.character, constraints, bearing_in(at, supports), options);
    if (again && again->constraints[i].met_frames > 0) out[i] = 1;
  }
  return out;
}

}  // namespace marey::app
