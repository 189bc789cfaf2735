// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject/assess_subject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include <glm/trigonometric.hpp>

#include "core/base/in_quotes.h"
#include "reconstruct/bundle/subject_priors.h"
#include "reconstruct/subject/turned_limbs.h"

namespace marey::reconstruct {
namespace {

// A tag with fewer sightings can be misread in each.
constexpr int kMinSightings = 10;
// For a tag at its right place, 86 % and more of the sightings are explained in simulated
// sessions, and the median square is below 1.6 times its expectation.
constexpr int kMinAssessedSightings = 20;
constexpr double kMinExplainedTags = 0.7;
constexpr double kMaxRatioOfMedian = 4.0;
// Half squares by which one hypothesis must beat another if all sightings were
// independent: three sigma. They have less weight, by SubjectBundle::prior_weight.
constexpr double kSureGain = 4.5;
// Two hypotheses whose joints are nearer are one solution. [m]
constexpr double kElsewhere_m = 0.04;
// People's left and right bones differ by millimetres. [m]
constexpr double kSidesDiffer_m = 0.03;
// Ratio to an average person's length at this stature: five standard deviations.
constexpr double kMinRatio = 0.7;
constexpr double kMaxRatio = 1.35;

// Largest sigma of hips, knees and elbows that are usable for a motion, per coordinate.
// [m]
constexpr double kKnownJoint_m = 0.02;
// Shoulders glide on the rib cage by nearly as much, and an elbow keeps its place if its
// shoulder is wrong: an upper arm of average length is turned by 6 degrees.
constexpr double kKnownShoulder_m = 0.035;

// One camera cannot distinguish the two poses of a flat tag: a hand that two cameras
// never see, on a forearm that two rarely see, can get a wrong one. Shares of the frames.
constexpr double kSeenTwice = 0.08;
constexpr double kBoneSeenTwice = 0.12;
// Share of the frames: if two cameras see the forearm or shank less often, its wrist or
// ankle is not determined, even if both see the hand or foot.
constexpr double kBoneHardlySeenTwice = 0.05;
// A limb's bone that fewer frames locate can be fitted turned over, with everything
// attached to it: half a second of a slow movement.
constexpr int kMinLocated = 15;
// Sigmas of the prior of a tag's place on its segment.
constexpr double kMaxOffSoftTissue = 3.0;
// No person stands with a thigh or an upper arm turned further. [rad]
constexpr double kMaxStandingTurn_rad = 1.75;

std::string millimetres(double m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.0f mm", 1e3 * m);
  return text.data();
}

std::string degrees(double rad) {
  return std::to_string(std::lround(glm::degrees(std::abs(rad)))) + " degrees";
}

std::string percent(double share) {
  return std::to_string(std::lround(100.0 * share)) + " %";
}

Finding doubtful(std::string cause, std::string next) {
  return poor_finding("subject", "", std::move(cause), std::move(next));
}

void assess_tags(const SubjectBundle& bundle,
                 const SubjectEvidence& evidence,
                 std::vector<Finding>& out) {
  for (const std::size_t tag : evidence.unexplained) {
    int sightings = 0;
    for (const BundleFrame& frame : bundle.frames) {
      for (const TagSighting& s : frame.sightings) sightings += s.tag == tag;
    }
    if (sightings < kMinSightings) continue;
    const TagOnSegment& declared = bundle.model.tags[tag];
    out.push_back(
        doubtful("tag " + std::to_string(number(declared.id)) +
                     " does not move with segment " + in_quotes(name(declared.segment)),
                 "check its `segment` and `size_m` under [[tags.tag]], and that "
                 "it is glued firmly"));
  }
}

/// Checks the sightings of placed tags, each against the detector's own noise.
void assess_sightings(const SubjectBundle& bundle,
                      const SubjectEvidence& evidence,
                      std::vector<Finding>& out) {
  for (const TagEvidence& e : evidence.tags) {
    const bool is_explained =
        e.explained_share >= kMinExplainedTags && e.median_ratio <= kMaxRatioOfMedian;
    if (e.sightings < kMinAssessedSightings || is_explained) continue;
    const TagOnSegment& tag = bundle.model.tags[e.tag];
    const std::string how =
        e.explained_share < kMinExplainedTags
            ? " lies away from its fitted place in " + percent(1.0 - e.explained_share) +
                  " of its sightings"
            : " fits its place worse than its corners' noise explains, in most of its "
              "sightings";
    out.push_back(doubtful("tag " + std::to_string(number(tag.id)) + " on segment " +
                               in_quotes(name(tag.segment)) + how,
                           "check that it is glued firmly and did not shift during the "
                           "trials; then record the range of motion again"));
  }
}

/// Returns why the tags of a limb's hand or foot have no certain place.
std::optional<Finding> place_finding(std::size_t limb,
                                     const SubjectBundle& bundle,
                                     const SubjectEvidence& evidence) {
  const ExtremityFit& fit = evidence.extremities[limb];
  const std::string segment = in_quotes(name(human_limbs()[limb].end));
  if (!fit.placed && fit.sightings < kMinSightings) return std::nullopt;
  if (!fit.placed) {
    return doubtful(
        "no place of the tags on segment " + segment +
            " explains their positions in the images",
        "check their `segment` and `size_m` under [[tags.tag]]; then record the "
        "range of motion again, turning that segment in view of two cameras");
  }
  const double sure_gain = kSureGain * bundle.prior_weight;
  if (fit.runner_up_cost > sure_gain || fit.runner_up_m < kElsewhere_m) {
    return std::nullopt;
  }
  return doubtful(
      "the tags on segment " + segment + " fit in two ways, " +
          millimetres(fit.runner_up_m) + " apart",
      "record the range of motion again, turning that segment slowly in view of "
      "two cameras, or glue a second tag to it");
}

std::optional<Finding> view_finding(std::size_t limb, const SubjectEvidence& evidence) {
  const HumanLimb& bones = human_limbs()[limb];
  if (evidence.extremities[limb].sightings < kMinSightings) return std::nullopt;
  const double end = evidence.seen_twice_share[index(bones.end)];
  const double lower = evidence.seen_twice_share[index(bones.lower)];
  const bool is_seen = end >= kSeenTwice && lower >= kBoneHardlySeenTwice;
  if (is_seen || lower >= kBoneSeenTwice) return std::nullopt;
  return doubtful(
      "in the range of motion, two cameras at once see segments " +
          in_quotes(name(bones.lower)) + " and " + in_quotes(name(bones.end)) +
          " in only " + percent(lower) + " and " + percent(end) + " of frames",
      "record the range of motion again, turning that limb slowly in view of two "
      "cameras, or glue tags to other sides of it");
}

void assess_extremities(const SubjectEvidence& evidence, std::vector<Finding>& out) {
  for (const std::optional<Finding>& reason : evidence.left_out) {
    if (reason) out.push_back(*reason);
  }
}

void assess_locations(const SubjectBundle& bundle,
                      const SubjectEvidence& evidence,
                      std::vector<Finding>& out) {
  for (const HumanLimb& limb : human_limbs()) {
    for (const HumanBone bone : {limb.upper, limb.lower}) {
      const bool has_tags = std::ranges::any_of(
          bundle.model.segment_from_tag,
          [&](const auto& placed) { return bundle.model.bone(placed.first) == bone; });
      const int frames = evidence.located_frames[index(bone)];
      if (!has_tags || frames >= kMinLocated) continue;
      out.push_back(doubtful(
          "segment " + in_quotes(name(bone)) + " is seen well enough in only " +
              std::to_string(frames) +
              " frames of the range of motion; in the others one camera sees one of "
              "its tags, nearly from the front",
          "record the range of motion again, turning that limb slowly in view of two "
          "cameras, or glue tags to other sides of it"));
    }
  }
}

/// Checks for tags that the fit placed off the soft tissue of their segment.
void assess_places(const SubjectBundle& bundle, std::vector<Finding>& out) {
  for (const auto& [tag, place] : bundle.model.segment_from_tag) {
    if (off_soft_tissue(bundle.model, tag) < kMaxOffSoftTissue) continue;
    const TagOnSegment& declared = bundle.model.tags[tag];
    out.push_back(
        doubtful("tag " + std::to_string(number(declared.id)) +
                     " is fitted to a place where segment " +
                     in_quotes(name(declared.segment)) + " has no skin",
                 "check its `segment` and `size_m` under [[tags.tag]]; then "
                 "record the range of motion again, turning that segment slowly "
                 "in view of two cameras"));
  }
}

void assess_turns(const SubjectBundle& bundle, std::vector<Finding>& out) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const auto turn_rad = standing_turn_rad(limb, bundle);
    if (!turn_rad || std::abs(*turn_rad) < kMaxStandingTurn_rad) continue;
    out.push_back(
        doubtful("segment " + in_quotes(name(human_limbs()[limb].upper)) +
                     " is fitted turned about its own axis by " + degrees(*turn_rad) +
                     " in the static trial",
                 "check that its tags and the next segment's are declared on the "
                 "right segments; then record the range of motion again, bending " +
                     std::string(limb < 2 ? "that elbow" : "that knee") +
                     " far in view of two cameras"));
  }
}

void assess_lengths(const SubjectBundle& bundle, std::vector<Finding>& out) {
  const auto length = [&](Length which) { return bundle.model.lengths[index(which)]; };
  const auto sigma = [&](Length which) { return bundle.length_sigma_m[index(which)]; };
  const auto check = [&](Length left, Length right, HumanBone bone) {
    const double apart_m = std::abs(length(left) - length(right));
    const double sure_m = 3.0 * std::hypot(sigma(left), sigma(right));
    const double ratio = 0.5 * (length(left) + length(right)) / bundle.usual[index(left)];
    if (apart_m > std::max(kSidesDiffer_m, sure_m)) {
      out.push_back(doubtful("segment " + in_quotes(name(bone)) + " is " +
                                 millimetres(length(left)) + " long on the left and " +
                                 millimetres(length(right)) + " on the right",
                             "record the range of motion again, bending both sides far, "
                             "in view of at least two cameras"));
    }
    if (ratio < kMinRatio || ratio > kMaxRatio) {
      out.push_back(doubtful("segment " + in_quotes(name(bone)) + " is " +
                                 millimetres(length(left)) + " long, where " +
                                 millimetres(bundle.usual[index(left)]) +
                                 " is usual at this stature",
                             "check stature_m of [subject] and size_m of the tags; then "
                             "record the range of motion again"));
    }
  };
  check(Length::kLeftUpperArm, Length::kRightUpperArm, HumanBone::kLeftUpperArm);
  check(Length::kLeftLowerArm, Length::kRightLowerArm, HumanBone::kLeftLowerArm);
  check(Length::kLeftUpperLeg, Length::kRightUpperLeg, HumanBone::kLeftUpperLeg);
  check(Length::kLeftLowerLeg, Length::kRightLowerLeg, HumanBone::kLeftLowerLeg);
}

void assess_joints(const SubjectBundle& bundle, std::vector<Finding>& out) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const HumanLimb& bones = human_limbs()[limb];
    for (const HumanBone bone : {bones.upper, bones.lower}) {
      const bool is_shoulder = limb < 2 && bone == bones.upper;
      const std::optional<double>& sigma_m = bundle.centre_sigma_m[index(bone)];
      if (sigma_m && *sigma_m < (is_shoulder ? kKnownShoulder_m : kKnownJoint_m))
        continue;
      out.push_back(
          doubtful("the joint at the near end of segment " + in_quotes(name(bone)) +
                       (sigma_m ? " has an uncertainty of " + millimetres(*sigma_m)
                                : " could not be determined"),
                   "record the range of motion again, bending that joint far "
                   "in view of two cameras at once"));
    }
  }
}

}  // namespace

bool leave_out_extremities(SubjectBundle& bundle, SubjectEvidence& evidence) {
  bool has_changed = false;
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    std::optional<Finding>& reason = evidence.left_out[limb];
    reason = place_finding(limb, bundle, evidence);
    if (!reason) reason = view_finding(limb, evidence);
    if (!reason) continue;
    const HumanBone end = human_limbs()[limb].end;
    reason->cause += "; they are left out, and the joint " + in_quotes(name(end)) +
                     " is inferred from the other segments";
    has_changed |= std::erase_if(bundle.model.segment_from_tag, [&](const auto& placed) {
                     return bundle.model.bone(placed.first) == end;
                   }) > 0;
    std::erase_if(evidence.unexplained,
                  [&](std::size_t tag) { return bundle.model.bone(tag) == end; });
  }
  return has_changed;
}

std::vector<Finding> assess_subject(const SubjectBundle& bundle,
                                    const SubjectEvidence& evidence) {
  std::vector<Finding> findings;
  assess_tags(bundle, evidence, findings);
  assess_sightings(bundle, evidence, findings);
  assess_extremities(evidence, findings);
  assess_locations(bundle, evidence, findings);
  assess_places(bundle, findings);
  assess_turns(bundle, findings);
  assess_lengths(bundle, findings);
  assess_joints(bundle, findings);
  return findings;
}

}  // namespace marey::reconstruct
