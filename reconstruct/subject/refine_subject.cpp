// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject/refine_subject.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "reconstruct/bundle/bundle_frames.h"
#include "reconstruct/bundle/subject_priors.h"
#include "reconstruct/bundle/subject_sigmas.h"
#include "reconstruct/bundle/subject_solve.h"
#include "reconstruct/clusters/tag_clusters.h"
#include "reconstruct/subject/turned_limbs.h"

namespace marey::reconstruct {
namespace {

// Largest error of a segment's pose in a frame of the bundle when a tag is placed on it:
// metres, a radian counting as 0.1 m.
constexpr double kPostureAgreement = 0.04;
// Below this share of explained sightings a tag's place is wrong.
constexpr double kMinExplainedShare = 0.5;
constexpr double kExplained2 = 40.0;
// Median of chi-square with eight degrees of freedom.
constexpr double kMedianSquare = 7.344;
// A plate with a larger slip is not fixed. [m]
constexpr double kMaxSlip_m = 0.02;

using GuessedPoses = std::map<std::size_t, RigidTransform>;

bool is_extremity(HumanBone bone) {
  return std::any_of(human_limbs().begin(), human_limbs().end(), [&](const auto& limb) {
    return bone == limb.end;
  });
}

/// Removes the extremities' tags from the model; returns their places.
GuessedPoses take_extremities(SubjectBundle& bundle) {
  GuessedPoses taken;
  for (std::size_t tag = 0; tag < bundle.model.tags.size(); ++tag) {
    if (!is_extremity(bundle.model.bone(tag))) continue;
    if (const RigidTransform* place = bundle.model.place(tag)) taken[tag] = *place;
    bundle.model.segment_from_tag.erase(tag);
  }
  return taken;
}

/// Places tags without a place, except those of extremities, according to the body's
/// postures, if several sightings agree.
void place_on_body(SubjectBundle& bundle, std::span<const Camera> cameras) {
  BodyModel& model = bundle.model;
  for (std::size_t tag = 0; tag < model.tags.size(); ++tag) {
    if (model.place(tag) || is_extremity(model.bone(tag)) ||
        is_seen_too_seldom(tag, bundle)) {
      continue;
    }
    std::vector<RigidTransform> segment_from_tag;
    for (const BundleFrame& frame : bundle.frames) {
      const auto world_from_tag = locate_tag(tag, cameras, model.tags, frame.sightings);
      if (!world_from_tag) continue;
      segment_from_tag.push_back(
          inverse(world_from_bone(
              model.bone(tag), frame.posture, model.lengths, model.body)) *
          *world_from_tag);
    }
    if (const auto agreed = agreed_pose(segment_from_tag, kPostureAgreement)) {
      model.segment_from_tag[tag] = *agreed;
    }
  }
}

int settle(SubjectBundle& bundle, std::span<const Camera> cameras) {
  const BundleFrameSolver solver(bundle, cameras);
  int changed = 0;
  for (BundleFrame& frame : bundle.frames) changed += solver.settle(frame);
  return changed;
}

/// Alternates between the bundle and single frames, from a loss that nearly all tags are
/// inside of to the corners' own.
bool refine_coarse_to_fine(SubjectBundle& bundle, std::span<const Camera> cameras) {
  for (const double scale : {10.0, 3.0, 1.0}) {
    bundle.noise_scale = scale;
    if (!adjust(bundle, cameras, 12, {{}, true})) return false;
    if (scale == 3.0) place_on_body(bundle, cameras);
    settle(bundle, cameras);
  }
  return true;
}

bool refine_rounds(SubjectBundle& bundle, std::span<const Camera> cameras, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    estimate_slips(cameras, bundle);
    if (!adjust(bundle, cameras, 15)) return false;
    if (settle(bundle, cameras) == 0) break;
  }
  return true;
}

/// Returns the turn of the skin of the upper arms about their bones, root mean square
/// over the trials: at least 3 degrees, at most the allowed value.
double upper_arm_twist_rad(const SubjectBundle& bundle) {
  double sum = 0.0;
  double count = 0.0;
  for (const PoseParameter parameter :
       {PoseParameter::kLeftUpperArmTwist, PoseParameter::kRightUpperArmTwist}) {
    for (const BundleFrame& frame : bundle.frames) {
      const double twist = *frame.posture.block(parameter);
      sum += twist * twist;
      count += 1.0;
    }
  }
  constexpr double kMin_rad = 0.05;
  return std::clamp(std::sqrt(sum / count), kMin_rad, kTrialTwists.upper_arm);
}

std::vector<std::size_t> unexplained_tags(const SubjectBundle& bundle,
                                          std::span<const Camera> cameras) {
  std::vector<std::size_t> tags;
  for (const TagEvidence& e : tag_evidence(cameras, bundle)) {
    const bool is_lost = e.explained_share < kMinExplainedShare;
    const bool is_in_the_air = off_flesh(bundle.model, e.tag) > 3.0;
    if (is_lost || is_in_the_air) tags.push_back(e.tag);
  }
  return tags;
}

/// Removes the places of unexplained tags, and returns these tags.
std::set<std::size_t> take_unexplained(SubjectBundle& bundle,
                                       std::span<const Camera> cameras) {
  const std::vector<std::size_t> tags = unexplained_tags(bundle, cameras);
  for (const std::size_t tag : tags) bundle.model.segment_from_tag.erase(tag);
  return {tags.begin(), tags.end()};
}

void place_extremities(std::span<const Camera> cameras,
                       const GuessedPoses& guesses,
                       SubjectBundle& bundle,
                       SubjectEvidence& evidence) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    std::vector<std::pair<int, std::size_t>> by_sightings;
    for (std::size_t tag = 0; tag < bundle.model.tags.size(); ++tag) {
      if (bundle.model.bone(tag) != human_limbs()[limb].end) continue;
      int count = 0;
      for (const BundleFrame& frame : bundle.frames) {
        for (const TagSighting& s : frame.sightings) count += s.tag == tag;
      }
      if (count > 0) by_sightings.emplace_back(-count, tag);
    }
    if (by_sightings.empty()) continue;
    std::sort(by_sightings.begin(), by_sightings.end());
    std::vector<std::size_t> tags;
    for (const auto& [count, tag] : by_sightings) tags.push_back(tag);
    std::vector<RigidTransform> starts;
    if (const auto guess = guesses.find(tags.front()); guess != guesses.end()) {
      starts.push_back(guess->second);
    }
    evidence.extremities[limb] = place_extremity(limb, tags, starts, cameras, bundle);
  }
}

}  // namespace

int sightings_of(std::size_t tag, const SubjectBundle& bundle) {
  std::ptrdiff_t count = 0;
  for (const BundleFrame& frame : bundle.frames) {
    count += std::ranges::count(frame.sightings, tag, &TagSighting::tag);
  }
  return static_cast<int>(count);
}

bool is_seen_too_seldom(std::size_t tag, const SubjectBundle& bundle) {
  constexpr int kMin = 6;
  if (sightings_of(tag, bundle) >= kMin) return false;
  const BodyModel& model = bundle.model;
  for (std::size_t other = 0; other < model.tags.size(); ++other) {
    if (model.bone(other) == model.bone(tag) && sightings_of(other, bundle) >= kMin) {
      return true;
    }
  }
  return false;
}

void estimate_slips(std::span<const Camera> cameras, SubjectBundle& bundle) {
  // Limit on one component of one sighting: outliers are not slip.
  constexpr double kMaxSquare = 9.0;
  constexpr int kMin = 20;
  struct Score {
    double excess = 0.0;
    double information = 0.0;
    int sightings = 0;
  };
  std::array<Score, kHumanBoneCount> scores{};
  const SubjectSight sight(cameras);
  UnfoldedPosture unfolded;
  SightedTag sighted;
  for (const BundleFrame& frame : bundle.frames) {
    unfolded.unfold(frame.posture, bundle.model.lengths, bundle.model.body);
    for (const TagSighting& s : frame.sightings) {
      if (!bundle.model.place(s.tag)) continue;
      const SightingNoise noise = bundle.noise(s.tag, frame.posture, unfolded);
      if (!sight.look(bundle.model, unfolded, s, noise, false, sighted)) continue;
      Score& score = scores[index(bundle.model.bone(s.tag))];
      ++score.sightings;
      for (int k = 0; k < 3; ++k) {
        const double gain2 = sighted.slip_gains[k] * sighted.slip_gains[k];
        const double rate = gain2 / (1.0 + noise.slip_m * noise.slip_m * gain2);
        const double along = sighted.slip_directions.col(k).dot(sighted.residual);
        score.excess += rate * (std::min(along * along, kMaxSquare) - 1.0);
        score.information += rate * rate;
      }
    }
  }
  Score all;
  double known_m2 = 0.0;
  for (std::size_t b = 0; b < scores.size(); ++b) {
    all.excess += scores[b].excess;
    all.information += scores[b].information;
    known_m2 += scores[b].information * bundle.slips_m[b] * bundle.slips_m[b];
  }
  if (all.information <= 0.0) return;
  const double usual_m2 = std::max(0.0, (known_m2 + all.excess) / all.information);
  for (std::size_t b = 0; b < scores.size(); ++b) {
    const Score& own = scores[b];
    double variance_m2 = usual_m2;
    if (own.sightings >= kMin && own.information > 0.0) {
      variance_m2 = bundle.slips_m[b] * bundle.slips_m[b] + own.excess / own.information;
    }
    bundle.slips_m[b] =
        std::clamp(std::sqrt(std::max(0.0, variance_m2)), 0.0, kMaxSlip_m);
  }
}

std::vector<TagEvidence> tag_evidence(std::span<const Camera> cameras,
                                      const SubjectBundle& bundle) {
  std::map<std::size_t, std::vector<double>> squares;
  const SubjectSight sight(cameras);
  UnfoldedPosture unfolded;
  SightedTag sighted;
  for (const BundleFrame& frame : bundle.frames) {
    unfolded.unfold(frame.posture, bundle.model.lengths, bundle.model.body);
    for (const TagSighting& s : frame.sightings) {
      if (!bundle.model.place(s.tag)) continue;
      const bool seen = sight.look(bundle.model,
                                   unfolded,
                                   s,
                                   bundle.noise(s.tag, frame.posture, unfolded),
                                   false,
                                   sighted);
      squares[s.tag].push_back(seen ? sighted.residual.squaredNorm() : 1e6);
    }
  }
  std::vector<TagEvidence> evidence;
  for (auto& [tag, own] : squares) {
    TagEvidence e;
    e.tag = tag;
    e.sightings = static_cast<int>(own.size());
    const auto explained = std::count_if(
        own.begin(), own.end(), [](double square) { return square < kExplained2; });
    e.explained_share = static_cast<double>(explained) / static_cast<double>(own.size());
    e.median_ratio = median(std::move(own)) / kMedianSquare;
    evidence.push_back(e);
  }
  return evidence;
}

bool refine_subject(std::span<const Camera> cameras,
                    SubjectBundle& bundle,
                    SubjectEvidence& evidence) {
  bundle.prior_weight = variance_scale(bundle);
  const GuessedPoses guesses = take_extremities(bundle);
  if (!refine_coarse_to_fine(bundle, cameras)) return false;
  place_on_body(bundle, cameras);
  if (!refine_rounds(bundle, cameras, 2)) return false;
  if (!turn_limbs(cameras, bundle).empty()) {
    place_on_body(bundle, cameras);
    if (!refine_rounds(bundle, cameras, 2)) return false;
  }
  place_extremities(cameras, guesses, bundle, evidence);
  if (!refine_rounds(bundle, cameras, 2)) return false;
  bundle.twists = kTrialTwists;
  if (!refine_rounds(bundle, cameras, 2)) return false;
  bundle.twists.upper_arm = upper_arm_twist_rad(bundle);
  std::set<std::size_t> lost = take_unexplained(bundle, cameras);
  if (!lost.empty()) {
    if (!refine_rounds(bundle, cameras, 2)) return false;
    place_on_body(bundle, cameras);
    if (!refine_rounds(bundle, cameras, 2)) return false;
    // A tag that was placed can make the place of another of its segment impossible.
    lost.merge(take_unexplained(bundle, cameras));
  }
  if (!adjust(bundle, cameras, 60)) return false;
  for (const std::size_t tag : lost) {
    if (!bundle.model.place(tag)) evidence.unexplained.push_back(tag);
  }
  evidence.tags = tag_evidence(cameras, bundle);
  return true;
}

bool refine_again(std::span<const Camera> cameras,
                  SubjectBundle& bundle,
                  SubjectEvidence& evidence) {
  bundle.slides.clear();
  if (!refine_rounds(bundle, cameras, 2)) return false;
  if (!adjust(bundle, cameras, 60)) return false;
  evidence.tags = tag_evidence(cameras, bundle);
  return true;
}

}  // namespace marey::reconstruct
