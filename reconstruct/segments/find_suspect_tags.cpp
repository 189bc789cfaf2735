// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/segments/find_suspect_tags.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/assert.h"
#include "reconstruct/segments/exchanged_limbs.h"
#include "reconstruct/segments/exchanged_segments.h"
#include "reconstruct/segments/tag_groups.h"

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

/// Returns the tags whose segment is not the declared one.
std::vector<std::size_t> moved(const WornTags& worn,
                               std::span<const HumanBone> segments) {
  std::vector<std::size_t> tags;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i] != solved_segment(worn.tags[i].segment)) tags.push_back(i);
  }
  return tags;
}

/// Segments of the tags according to their movement.
struct Movement {
  std::vector<HumanBone> segments;  ///< By position in WornTags::tags.
  std::optional<Error> undecided;   ///< The body has not moved enough for a decision.
};

/// Searches for exchanged segments and sides of a body with its tags on `segments`.
Movement find_movement(const Proportions& average,
                       std::vector<HumanBone> segments,
                       Renamed body) {
  Movement out{std::move(segments), std::nullopt};
  std::vector<ClusterPoses> frames = body.standing;
  frames.insert(frames.end(), body.moving.begin(), body.moving.end());
  rename_all(exchanged_segments(body.clusters, frames), body, out.segments);
  const auto found =
      find_segment_frames(body.clusters, body.standing, body.moving, average);
  if (!found) return out;
  const auto sides = exchanged_limbs(*found, body.clusters, body.standing, body.moving);
  if (sides) {
    rename_all(*sides, body, out.segments);
  } else {
    out.undecided = sides.error();
  }
  return out;
}

/// Returns the error of the tags on the segments that they are declared on, or the reason
/// why it cannot be determined; nullopt for a body that moves correctly.
std::optional<Error> mistake_as_declared(const WornTags& worn,
                                         const Proportions& average) {
  std::vector<HumanBone> segments;
  for (const TagOnSegment& tag : worn.tags) {
    segments.push_back(solved_segment(tag.segment));
  }
  Renamed body;
  body.clusters.assign(worn.clusters.begin(), worn.clusters.end());
  body.standing.assign(worn.standing.begin(), worn.standing.end());
  body.moving.assign(worn.moving.begin(), worn.moving.end());
  Movement found = find_movement(average, std::move(segments), std::move(body));
  if (auto error = exchange_error(worn.tags, found.segments)) return error;
  return std::move(found.undecided);
}

}  // namespace

Result<std::optional<SuspectTags>> find_suspect_tags(const WornTags& worn,
                                                     const Proportions& average) {
  MAREY_ASSERT(worn.trials.size() == 2);
  const auto singles = locate_single_tags(worn.cameras, worn.tags, worn.trials[1]);
  const std::vector<HumanBone> by_rigidity = segments_by_rigidity(worn.tags, singles);
  const bool as_declared =
      std::ranges::equal(by_rigidity, worn.tags, {}, {}, [](const auto& t) {
        return solved_segment(t.segment);
      });
  if (as_declared) {
    const auto mistake = mistake_as_declared(worn, average);
    if (mistake) return *mistake;
    return std::optional<SuspectTags>();
  }
  const Movement found =
      find_movement(average, by_rigidity, regrouped(worn, by_rigidity));
  const auto error = exchange_error(worn.tags, found.segments);
  if (!error) {
    if (found.undecided) return *found.undecided;
    return std::optional<SuspectTags>();
  }
  // A fit can refute a suspicion of single tags, but only if the rest moves as declared.
  const bool is_of_single_tags = found.segments == by_rigidity && !found.undecided;
  if (!is_of_single_tags || mistake_as_declared(worn, average)) return *error;
  return std::optional(SuspectTags{*error, moved(worn, by_rigidity)});
}

}  // namespace marey::reconstruct
