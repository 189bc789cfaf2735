// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject/fit_subject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/human/average_proportions.h"
#include "reconstruct/bundle/subject_bundle.h"
#include "reconstruct/bundle/subject_sigmas.h"
#include "reconstruct/clusters/located_frames.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/clusters/tag_clusters.h"
#include "reconstruct/posture/initial_posture.h"
#include "reconstruct/segments/find_suspect_tags.h"
#include "reconstruct/segments/segment_frames.h"
#include "reconstruct/subject/assess_subject.h"
#include "reconstruct/subject/refine_subject.h"
#include "reconstruct/subject/subject_output.h"

namespace marey::reconstruct {
namespace {

// The bundle's cost grows with its frames, its gain with their variety.
constexpr std::size_t kStandingFrames = 5;
constexpr std::size_t kMovingFrames = 90;
constexpr std::size_t kLocatedFrames = 300;
constexpr std::size_t kFramesPerTag = 3;
constexpr std::size_t kMinMovingFrames = 10;
constexpr int kSteps = 4;  // Steps reported to `progress`.
std::vector<std::size_t> evenly(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> chosen;
  const std::size_t n = std::min(count, wanted);
  for (std::size_t i = 0; i < n; ++i) chosen.push_back((2 * i + 1) * count / (2 * n));
  return chosen;
}

ClusterPoses locate(std::span<const TagCluster> clusters,
                    std::span<const Camera> cameras,
                    std::span<const TagOnSegment> tags,
                    std::span<const TagSighting> frame) {
  ClusterPoses poses;
  for (const TagCluster& cluster : clusters) {
    if (const auto pose = locate_cluster(cluster, cameras, tags, frame)) {
      poses[cluster.segment] = *pose;
    }
  }
  return poses;
}

std::map<HumanBone, RigidTransform> to_segments(const ClusterPoses& clusters,
                                                const SegmentFrames& frames) {
  std::map<HumanBone, RigidTransform> segments;
  for (const auto& [bone, world_from_cluster] : clusters) {
    const auto known = frames.segment_from_cluster.find(bone);
    if (known == frames.segment_from_cluster.end()) continue;
    segments[bone] = world_from_cluster * inverse(known->second);
  }
  return segments;
}

/// Frames of one trial with their clusters located.
struct LocatedTrial {
  std::vector<std::size_t> frames;
  std::vector<ClusterPoses> poses;
};

LocatedTrial locate_trial(const Sightings& trial,
                          std::span<const TagCluster> clusters,
                          std::span<const Camera> cameras,
                          std::span<const TagOnSegment> tags) {
  LocatedTrial located;
  for (const std::size_t frame : evenly(trial.frames.size(), kLocatedFrames)) {
    located.frames.push_back(frame);
    located.poses.push_back(locate(clusters, cameras, tags, trial.frames[frame]));
  }
  return located;
}

/// Returns the located frames in which the hips are known: the others have no initial
/// posture.
std::vector<std::size_t> usable_frames(const LocatedTrial& located) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < located.frames.size(); ++i) {
    if (located.poses[i].contains(HumanBone::kHips)) usable.push_back(i);
  }
  return usable;
}

bool shows(std::span<const TagSighting> frame, std::size_t tag) {
  return std::any_of(
      frame.begin(), frame.end(), [&](const TagSighting& s) { return s.tag == tag; });
}

/// Chooses frames spread over the trial, and some for each tag: a tag that none of them
/// shows could not be placed.
std::vector<std::size_t> choose_frames(const Sightings& trial,
                                       const LocatedTrial& located,
                                       std::size_t wanted,
                                       std::size_t tags) {
  const std::vector<std::size_t> usable = usable_frames(located);
  std::set<std::size_t> chosen;
  for (const std::size_t i : evenly(usable.size(), wanted)) chosen.insert(usable[i]);
  for (std::size_t tag = 0; tag < tags; ++tag) {
    std::vector<std::size_t> showing;
    for (const std::size_t i : usable) {
      if (shows(trial.frames[located.frames[i]], tag)) showing.push_back(i);
    }
    for (const std::size_t i : evenly(showing.size(), kFramesPerTag)) {
      chosen.insert(showing[i]);
    }
  }
  return {chosen.begin(), chosen.end()};
}

void add_frames(const Sightings& trial,
                const LocatedTrial& located,
                std::span<const std::size_t> chosen,
                bool standing,
                const SegmentFrames& frames,
                SubjectBundle& bundle) {
  Posture fallback;
  for (const std::size_t i : chosen) {
    BundleFrame frame;
    frame.sightings = trial.frames[located.frames[i]];
    frame.standing = standing;
    frame.posture = posture_from_segments(
        to_segments(located.poses[i], frames), frames.lengths, frames.body, fallback);
    fallback = frame.posture;
    bundle.frames.push_back(std::move(frame));
  }
}

std::array<double, kHumanBoneCount> seen_twice_share(const Sightings& trial,
                                                     std::span<const TagOnSegment> tags) {
  std::array<double, kHumanBoneCount> shares{};
  const double share =
      1.0 / static_cast<double>(std::max<std::size_t>(trial.frames.size(), 1));
  for (const auto& frame : trial.frames) {
    std::array<std::set<CameraId>, kHumanBoneCount> cameras;
    for (const TagSighting& s : frame) {
      cameras[index(solved_segment(tags[s.tag].segment))].insert(s.camera);
    }
    for (std::size_t bone = 0; bone < shares.size(); ++bone) {
      if (cameras[bone].size() >= 2) shares[bone] += share;
    }
  }
  return shares;
}

/// Removes tags that no frame shows, or that are seen too seldom.
void keep_sighted(SubjectBundle& bundle) {
  std::erase_if(bundle.model.segment_from_tag, [&](const auto& placed) {
    return sightings_of(placed.first, bundle) == 0 ||
           is_seen_too_seldom(placed.first, bundle);
  });
}

std::string text(const char* format, double a, double b) {
  std::array<char, 240> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, a, b);
  return buffer.data();
}

/// Lengths that the initial estimate measures; the lower ones have their usual values.
constexpr std::array<Length, 4> kFirstSegments{Length::kLeftUpperArm,
                                               Length::kRightUpperArm,
                                               Length::kLeftUpperLeg,
                                               Length::kRightUpperLeg};

Status check_size(double ratio, double stature_m) {
  if (ratio > 0.75 && ratio < 1.35) return Done{};
  return bad_input(
      "",
      text("the limbs measure %.2f times those of a person of %.2f m", ratio, stature_m),
      "check size_m of the tags and tag_size_m of [board] against the print (edge of the "
      "black square, in metres), and stature_m of [subject]");
}

Error unfitted() {
  return bad_input(
      "",
      "the body cannot be fitted: too few frames show enough tags",
      "record the static and the range-of-motion trial longer, moving every joint in "
      "view of at least two cameras, and the hips always");
}

/// The static and the range-of-motion trial at the start of the fit.
struct LocatedTrials {
  std::span<const Sightings> trials;  ///< The static one, then the other.
  std::span<const TagCluster> clusters;
  const LocatedTrial& stood;
  const LocatedTrial& moved;
};

Result<SubjectFit> fit_located(const SubjectPrior& prior,
                               std::span<const Camera> cameras,
                               const LocatedTrials& located,
                               const Progress& report_step,
                               SubjectEvidence& evidence) {
  const auto& [trials, clusters, stood, moved] = located;
  const Proportions average = average_proportions(prior.stature_m);
  const auto frames = find_segment_frames(clusters, stood.poses, moved.poses, average);
  if (!frames) return frames.error();

  SubjectBundle bundle;
  bundle.model.lengths = frames->lengths;
  bundle.usual = lengths_of(average);
  bundle.model.body = frames->body;
  bundle.model.tags = prior.tags;
  if (const Status ok =
          check_size(limb_ratio(bundle.model.lengths, bundle.usual, kFirstSegments),
                     prior.stature_m);
      !ok) {
    return ok.error();
  }
  for (const TagCluster& cluster : clusters) {
    const auto known = frames->segment_from_cluster.find(cluster.segment);
    if (known == frames->segment_from_cluster.end()) continue;
    for (const auto& [tag, cluster_from_tag] : cluster.cluster_from_tag) {
      bundle.model.segment_from_tag[tag] = known->second * cluster_from_tag;
    }
  }
  const std::size_t tag_count = prior.tags.size();
  const auto still = choose_frames(trials[0], stood, kStandingFrames, tag_count);
  const auto lively = choose_frames(trials[1], moved, kMovingFrames, tag_count);
  add_frames(trials[0], stood, still, true, *frames, bundle);
  add_frames(trials[1], moved, lively, false, *frames, bundle);
  keep_sighted(bundle);
  report_step(2, kSteps);
  if (still.empty() || lively.size() < kMinMovingFrames ||
      !refine_subject(cameras, bundle, evidence)) {
    return unfitted();
  }
  measure(bundle, cameras);
  report_step(3, kSteps);
  if (!refine_slides(bundle, cameras)) return unfitted();
  evidence.seen_twice_share = seen_twice_share(trials[1], prior.tags);
  evidence.located_frames = located_frames(trials[1], prior.tags, cameras);
  if (leave_out_extremities(bundle, evidence)) {
    if (!refine_again(cameras, bundle, evidence)) return unfitted();
    measure(bundle, cameras);
    if (!refine_slides(bundle, cameras)) return unfitted();
  }
  if (!fill_sigmas(bundle, cameras)) return unfitted();
  report_step(kSteps, kSteps);
  SubjectFit fit = to_fit(prior, bundle, evidence, average);
  if (const Status ok = check_size(fit.limb_ratio, prior.stature_m); !ok) {
    return ok.error();
  }
  fit.findings = assess_subject(bundle, evidence);
  for (const Finding& finding : fit.findings) {
    fit.body.warnings.push_back(fair_finding("", "", finding.cause, finding.next));
  }
  return fit;
}

/// Returns whether the body explains these tags on the segments that they are declared
/// on: as well as tags in their right places are explained (assess_subject.h).
bool explains(std::span<const std::size_t> tags, const SubjectEvidence& evidence) {
  constexpr double kMinExplained = 0.85;
  constexpr double kMaxMedianRatio = 2.5;
  return std::ranges::all_of(tags, [&](std::size_t tag) {
    const auto found = std::ranges::find(evidence.tags, tag, &TagEvidence::tag);
    return found != evidence.tags.end() && found->explained_share >= kMinExplained &&
           found->median_ratio <= kMaxMedianRatio;
  });
}

}  // namespace

Result<SubjectFit> fit_subject(const SubjectPrior& prior,
                               std::span<const Camera> cameras,
                               std::span<const CameraDetections> standing,
                               std::span<const CameraDetections> moving,
                               const Progress& progress) {
  const Progress report_step = [&](int step, int steps) {
    if (progress) progress(step, steps);
  };
  report_step(0, kSteps);
  const Proportions average = average_proportions(prior.stature_m);
  const std::array<Sightings, 2> trials{group_sightings(standing, prior.tags),
                                        group_sightings(moving, prior.tags)};
  const auto clusters = cluster_tags(cameras, prior.tags, trials);
  const LocatedTrial stood = locate_trial(trials[0], clusters, cameras, prior.tags);
  const LocatedTrial moved = locate_trial(trials[1], clusters, cameras, prior.tags);
  report_step(1, kSteps);
  const WornTags worn{cameras, prior.tags, trials, clusters, stood.poses, moved.poses};
  const auto warning = find_suspect_tags(worn, average);
  if (!warning) return warning.error();
  SubjectEvidence evidence;
  auto fit = fit_located(
      prior, cameras, {trials, clusters, stood, moved}, report_step, evidence);
  const bool is_refuted =
      *warning && fit && fit->findings.empty() && explains((*warning)->tags, evidence);
  if (*warning && !is_refuted) return (*warning)->error;
  return fit;
}

}  // namespace marey::reconstruct
