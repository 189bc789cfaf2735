// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/tag_clusters.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#include "reconstruct/clusters/locate_rigid.h"

namespace marey::reconstruct {
namespace {

// A single view is ambiguous if its second pose costs less than this times the first
// (docs: a ratio of two detected every flip of a real wand recording).
constexpr double kUnambiguous = 3.0;
constexpr double kMaxRmsPx = 2.0;
// Relative poses nearer than this (metres, a radian counting as 0.1 m) agree.
constexpr double kAgree = 0.02;

using TagPoses = std::map<std::size_t, RigidTransform>;  // world_from_tag by tag

TagPoses locate_tags(std::span<const Camera> cameras,
                     std::span<const TagOnSegment> tags,
                     std::span<const TagSighting> frame) {
  TagPoses poses;
  for (const TagSighting& sighting : frame) {
    if (poses.contains(sighting.tag)) continue;
    if (const auto pose = locate_tag(sighting.tag, cameras, tags, frame)) {
      poses[sighting.tag] = *pose;
    }
  }
  return poses;
}

double disagreement(const RigidTransform& x, const RigidTransform& y) {
  return glm::length(x.translation - y.translation) +
         0.1 * glm::length(rotation_vector(glm::conjugate(x.rotation) * y.rotation));
}

struct Agreed {
  RigidTransform pose;
  int support = 0;
};

/// Returns the candidate that most others are within `near` of, averaged with those.
Agreed agree(std::span<const RigidTransform> candidates, double near) {
  Agreed best;
  for (const RigidTransform& candidate : candidates) {
    int support = 0;
    for (const RigidTransform& other : candidates) {
      support += disagreement(candidate, other) < near;
    }
    if (support > best.support) best = {candidate, support};
  }
  glm::dvec3 shift(0.0);
  glm::dvec3 turn(0.0);
  for (const RigidTransform& other : candidates) {
    if (disagreement(best.pose, other) >= near) continue;
    shift += other.translation - best.pose.translation;
    turn += rotation_vector(glm::conjugate(best.pose.rotation) * other.rotation);
  }
  const double n = std::max(1, best.support);
  best.pose.translation += shift / n;
  best.pose.rotation =
      glm::normalize(best.pose.rotation * rotation_from_vector(turn / n));
  return best;
}

TagCluster grow(HumanBone segment,
                const std::vector<std::size_t>& members,
                const std::vector<TagPoses>& frames) {
  // The tag that is seen most defines the cluster's frame.
  std::size_t anchor = members.front();
  std::ptrdiff_t maximum = -1;
  for (const std::size_t tag : members) {
    const auto seen = std::count_if(
        frames.begin(), frames.end(), [&](const TagPoses& f) { return f.contains(tag); });
    if (seen > maximum) {
      maximum = seen;
      anchor = tag;
    }
  }
  TagCluster cluster{segment, {{anchor, RigidTransform{}}}};
  while (cluster.cluster_from_tag.size() < members.size()) {
    Agreed best;
    std::size_t best_tag = 0;
    for (const std::size_t tag : members) {
      if (cluster.cluster_from_tag.contains(tag)) continue;
      std::vector<RigidTransform> candidates;
      for (const TagPoses& frame : frames) {
        const auto here = frame.find(tag);
        if (here == frame.end()) continue;
        for (const auto& [known, cluster_from_known] : cluster.cluster_from_tag) {
          const auto other = frame.find(known);
          if (other == frame.end()) continue;
          candidates.push_back(cluster_from_known * inverse(other->second) *
                               here->second);
        }
      }
      const Agreed agreed = agree(candidates, kAgree);
      if (agreed.support > best.support) {
        best = agreed;
        best_tag = tag;
      }
    }
    // Never seen together: fit_subject() places it on the body.
    if (best.support == 0) break;
    cluster.cluster_from_tag[best_tag] = best.pose;
  }
  return cluster;
}

}  // namespace

std::optional<RigidTransform> locate_tag(std::size_t tag,
                                         std::span<const Camera> cameras,
                                         std::span<const TagOnSegment> tags,
                                         std::span<const TagSighting> frame) {
  std::vector<RigidPointView> views;
  std::vector<RigidTransform> starts;
  int cameras_seeing = 0;
  for (const TagSighting& sighting : frame) {
    if (sighting.tag != tag) continue;
    const Camera& camera = cameras[index(sighting.camera)];
    append_corner_views(camera, *sighting.detection, tags[tag].size_m, {}, views);
    const auto both = planar_candidates(camera, *sighting.detection, tags[tag].size_m);
    starts.insert(starts.end(), both.begin(), both.end());
    ++cameras_seeing;
  }
  const auto pose = locate_rigid(views, starts);
  if (!pose || pose->rms_px > kMaxRmsPx) return std::nullopt;
  if (cameras_seeing == 1 && pose->ambiguity_ratio < kUnambiguous) return std::nullopt;
  return pose->world_from_body;
}

std::optional<RigidTransform> agreed_pose(std::span<const RigidTransform> candidates,
                                          double near) {
  // Two poses that agree can share an error; one always agrees with itself.
  constexpr int kMin = 3;
  const Agreed agreed = agree(candidates, near);
  if (agreed.support < kMin) return std::nullopt;
  return agreed.pose;
}

std::vector<TagCluster> cluster_tags(std::span<const Camera> cameras,
                                     std::span<const TagOnSegment> tags,
                                     std::span<const Sightings> trials) {
  std::vector<TagPoses> frames;
  for (const Sightings& trial : trials) {
    // A third of the frames of a long trial carries as much information as all of them.
    const std::size_t step = std::max<std::size_t>(1, trial.frames.size() / 300);
    for (std::size_t i = 0; i < trial.frames.size(); i += step) {
      frames.push_back(locate_tags(cameras, tags, trial.frames[i]));
    }
  }
  std::vector<TagCluster> clusters;
  for (const HumanBone bone : human_bones()) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (solved_segment(tags[i].segment) == bone) members.push_back(i);
    }
    if (!members.empty()) clusters.push_back(grow(bone, members, frames));
  }
  return clusters;
}

std::optional<RigidTransform> locate_cluster(const TagCluster& cluster,
                                             std::span<const Camera> cameras,
                                             std::span<const TagOnSegment> tags,
                                             std::span<const TagSighting> frame) {
  std::vector<RigidPointView> views;
  std::vector<RigidTransform> starts;
  for (const TagSighting& sighting : frame) {
    const auto member = cluster.cluster_from_tag.find(sighting.tag);
    if (member == cluster.cluster_from_tag.end()) continue;
    const Camera& camera = cameras[index(sighting.camera)];
    const double size_m = tags[sighting.tag].size_m;
    append_corner_views(camera, *sighting.detection, size_m, member->second, views);
    for (const RigidTransform& world_from_tag :
         planar_candidates(camera, *sighting.detection, size_m)) {
      starts.push_back(world_from_tag * inverse(member->second));
    }
  }
  const auto pose = locate_rigid(views, starts);
  if (!pose || pose->rms_px > 2.0 * kMaxRmsPx) return std::nullopt;
  const bool one_view = views.size() == 4;
  if (one_view && pose->ambiguity_ratio < kUnambiguous) return std::nullopt;
  return pose->world_from_body;
}

}  // namespace marey::reconstruct
