// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/tag_tracks.h"

#include <string>

#include "core/base/assert.h"
#include "core/pose.h"
#include "reconstruct/clusters/sightings.h"

namespace marey::reconstruct {
namespace {

constexpr int kCorners = 4;

/// Returns for each tag whether any frame of the trial shows it.
std::vector<bool> seen_tags(const SolvedTrial& trial, std::size_t tags) {
  std::vector<bool> seen(tags, false);
  for (const auto& frame : trial.tags) {
    MAREY_ASSERT(frame.size() == tags);
    for (std::size_t t = 0; t < tags; ++t) {
      if (frame[t].seen) seen[t] = true;
    }
  }
  return seen;
}

}  // namespace

MarkerTracks tag_tracks(const Body& body, const SolvedTrial& trial) {
  const Motion& motion = trial.estimate.motion;
  MAREY_ASSERT(trial.tags.size() == motion.poses.size());
  MarkerTracks tracks;
  tracks.rate = motion.rate;
  tracks.first_frame = motion.first_frame + 1;
  tracks.start_s = motion.first_frame / motion.rate.hz;
  for (const PlacedTag& placed : body.tags) {
    for (int c = 0; c < kCorners; ++c) {
      tracks.labels.push_back(std::string(name(placed.tag.segment)) + "_tag" +
                              std::to_string(number(placed.tag.id)) + "_c" +
                              std::to_string(c));
    }
  }
  tracks.samples.resize(tracks.labels.size() * motion.poses.size());
  const std::vector<bool> seen = seen_tags(trial, body.tags.size());
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    const auto world = world_from_joints(motion.skeleton, motion.poses[f]);
    for (std::size_t t = 0; t < body.tags.size(); ++t) {
      const PlacedTag& placed = body.tags[t];
      const std::size_t bone = index(solved_segment(placed.tag.segment));
      const TagUncertainty& uncertainty = trial.tags[f][t];
      const bool known =
          trial.estimate.uncertainty[f][bone].segment_source != Source::kInferred;
      if (!seen[t] || (!uncertainty.seen && !known)) continue;
      const RigidTransform world_from_tag = world[bone] * placed.segment_from_tag;
      for (int c = 0; c < kCorners; ++c) {
        MarkerSample sample;
        sample.p_in_world = world_from_tag * corner_in_tag(c, placed.tag.size_m);
        sample.sigma_m = uncertainty.sigma_m;
        sample.cameras = uncertainty.cameras;
        sample.source = uncertainty.seen ? Source::kMeasured : Source::kRepaired;
        tracks.at(f, kCorners * t + static_cast<std::size_t>(c)) = sample;
      }
    }
  }
  return tracks;
}

}  // namespace marey::reconstruct
