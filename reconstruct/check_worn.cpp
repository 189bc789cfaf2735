// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/check_worn.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/assert.h"
#include "reconstruct/tag_groups.h"
#include "reconstruct/worn_segments.h"

namespace marey::reconstruct {
namespace {

constexpr std::size_t kFramesPerTrial = 150;

/// Clusters on the segments that their movement shows, with their poses.
struct Renamed {
  std::vector<TagCluster> clusters;
  std::vector<ClusterPoses> standing;
  std::vector<ClusterPoses> moving;
};

std::vector<ClusterPoses> locate_all(const WornTags& worn,
                                     std::span<const TagCluster> clusters,
                                     const Sightings& trial) {
  std::vector<ClusterPoses> located;
  const std::size_t step = 1 + trial.frames.size() / kFramesPerTrial;
  for (std::size_t i = 0; i < trial.frames.size(); i += step) {
    ClusterPoses& poses = located.emplace_back();
    for (const TagCluster& cluster : clusters) {
      const auto pose = locate_cluster(cluster, worn.cameras, worn.tags, trial.frames[i]);
      if (pose) poses[cluster.segment] = *pose;
    }
  }
  return located;
}

Renamed regrouped(const WornTags& worn, std::span<const HumanBone> segments) {
  std::vector<TagOnSegment> tags(worn.tags.begin(), worn.tags.end());
  for (std::size_t i = 0; i < tags.size(); ++i) tags[i].segment = segments[i];
  Renamed out;
  out.clusters = cluster_tags(worn.cameras, tags, worn.trials);
  out.standing = locate_all(worn, out.clusters, worn.trials[0]);
  out.moving = locate_all(worn, out.clusters, worn.trials[1]);
  return out;
}

void rename_all(const Renaming& names, Renamed& body, std::vector<HumanBone>& segments) {
  rename(names, body.clusters);
  rename(names, body.standing);
  rename(names, body.moving);
  for (HumanBone& segment : segments) {
    const auto found = names.find(segment);
    if (found != names.end()) segment = found->second;
  }
}

/// Tags whose segment is not the declared one.
std::vector<std::size_t> moved(const WornTags& worn,
                               std::span<const HumanBone> segments) {
  std::vector<std::size_t> tags;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i] != solved_segment(worn.tags[i].segment)) tags.push_back(i);
  }
  return tags;
}

}  // namespace

Result<std::optional<WornDoubt>> check_worn(const WornTags& worn,
                                            const Proportions& average) {
  MAREY_ASSERT(worn.trials.size() == 2);
  const auto singles = locate_single_tags(worn.cameras, worn.tags, worn.trials[1]);
  std::vector<HumanBone> segments = segments_by_rigidity(worn.tags, singles);
  const std::vector<HumanBone> by_rigidity = segments;
  const bool as_declared =
      std::ranges::equal(segments, worn.tags, {}, {}, [](const auto& t) {
        return solved_segment(t.segment);
      });
  Renamed body;
  if (as_declared) {
    body.clusters.assign(worn.clusters.begin(), worn.clusters.end());
    body.standing.assign(worn.standing.begin(), worn.standing.end());
    body.moving.assign(worn.moving.begin(), worn.moving.end());
  } else {
    body = regrouped(worn, segments);
  }
  std::vector<ClusterPoses> frames = body.standing;
  frames.insert(frames.end(), body.moving.begin(), body.moving.end());
  rename_all(exchanged_segments(body.clusters, frames), body, segments);
  const auto found =
      find_segment_frames(body.clusters, body.standing, body.moving, average);
  std::optional<Error> undecided;
  if (found) {
    const auto sides = exchanged_sides(*found, body.clusters, body.standing, body.moving);
    if (sides) {
      rename_all(*sides, body, segments);
    } else {
      undecided = sides.error();
    }
  }
  const auto error = exchange_error(worn.tags, segments);
  if (error && segments == by_rigidity) {
    return std::optional(WornDoubt{*error, moved(worn, segments)});
  }
  if (error) return *error;
  if (undecided) return *undecided;
  return std::optional<WornDoubt>();
}

}  // namespace marey::reconstruct
