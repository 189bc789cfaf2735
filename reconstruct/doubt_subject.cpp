// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/doubt_subject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include <glm/trigonometric.hpp>

#include "reconstruct/subject_priors.h"
#include "reconstruct/turned_limbs.h"

namespace marey::reconstruct {
namespace {

// A tag that was seen less often may be misread each time.
constexpr int kFewestSightings = 10;
// Of a tag whose place is right, 86 % and more of the sightings are explained in
// simulated sessions, and the median square is below 1.6 times what is expected.
constexpr int kFewestToJudge = 20;
constexpr double kLeastExplained = 0.7;
constexpr double kMostMedianRatio = 4.0;
// Half squares by which one hypothesis must beat another, were all sightings independent:
// three sigma. They count less, by SubjectBundle::prior_weight.
constexpr double kSureGain = 4.5;
// Two hypotheses whose joints are nearer are one answer. [m]
constexpr double kElsewhere_m = 0.04;
// People's left and right bones differ by millimetres. [m]
constexpr double kSidesDiffer_m = 0.03;
// Of an average person's length at this stature: five standard deviations.
constexpr double kShortest = 0.7;
constexpr double kLongest = 1.35;

// Hips, knees and elbows known no better make no motion, per coordinate. [m]
constexpr double kKnownJoint_m = 0.02;
// Shoulders glide on the rib cage by nearly as much, and an elbow keeps its place if its
// shoulder is wrong: an upper arm of average length is turned by 6 degrees.
constexpr double kKnownShoulder_m = 0.035;

// A flat tag has two poses that one camera cannot tell apart: a hand that two cameras
// never see, on a forearm that two seldom see, may get a wrong one. Shares of the frames.
constexpr double kSeenTwice = 0.08;
constexpr double kBoneSeenTwice = 0.12;
// Share of the frames: where two cameras see the forearm or shank less often, its wrist or
// ankle is not determined, even if both see the hand or foot.
constexpr double kBoneHardlySeenTwice = 0.05;
// A limb's bone that fewer frames locate can be fitted turned over, with all that hangs
// on it: half a second of a slow movement.
constexpr int kFewestLocated = 15;
// Sigmas of the prior of a tag's place on its segment.
constexpr double kMostOffFlesh = 3.0;
// No person stands with a thigh or an upper arm turned further. [rad]
constexpr double kMostStandingTurn_rad = 1.75;

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

Error doubt(std::string cause, std::string next) {
  return {Errc::kQuality, "", std::move(cause), std::move(next)};
}

std::string in_quotes(HumanBone bone) {
  std::string text(1, '"');
  text += name(bone);
  text += '"';
  return text;
}

void doubt_tags(const SubjectBundle& bundle,
                const SubjectEvidence& evidence,
                std::vector<Error>& out) {
  for (const std::size_t tag : evidence.unexplained) {
    int sightings = 0;
    for (const BundleFrame& frame : bundle.frames) {
      for (const TagSighting& s : frame.sightings) sightings += s.tag == tag;
    }
    if (sightings < kFewestSightings) continue;
    const TagOnSegment& declared = bundle.model.tags[tag];
    out.push_back(doubt("tag " + std::to_string(number(declared.id)) +
                            " does not move with segment " + in_quotes(declared.segment),
                        "check its `segment` and `size_m` under [[tags.tag]], and that "
                        "it is glued firmly"));
  }
}

/// Placed tags, each against the detector's own law.
void doubt_sightings(const SubjectBundle& bundle,
                     const SubjectEvidence& evidence,
                     std::vector<Error>& out) {
  for (const TagEvidence& e : evidence.tags) {
    const bool is_explained =
        e.explained_share >= kLeastExplained && e.median_ratio <= kMostMedianRatio;
    if (e.sightings < kFewestToJudge || is_explained) continue;
    const TagOnSegment& tag = bundle.model.tags[e.tag];
    const std::string how =
        e.explained_share < kLeastExplained
            ? " lies away from its fitted place in " + percent(1.0 - e.explained_share) +
                  " of its sightings"
            : " fits its place worse than its corners' noise explains, in most of its "
              "sightings";
    out.push_back(doubt("tag " + std::to_string(number(tag.id)) + " on segment " +
                            in_quotes(tag.segment) + how,
                        "check that it is glued firmly and did not shift during the "
                        "trials; then record the range of motion again"));
  }
}

/// Returns why the tags of a limb's hand or foot have no certain place.
std::optional<Error> doubt_of_place(std::size_t limb,
                                    const SubjectBundle& bundle,
                                    const SubjectEvidence& evidence) {
  const ExtremityFit& fit = evidence.extremities[limb];
  const std::string segment = in_quotes(human_limbs()[limb].end);
  if (!fit.placed && fit.sightings < kFewestSightings) return std::nullopt;
  if (!fit.placed) {
    return doubt("no place of the tags on segment " + segment +
                     " explains what the cameras saw of them",
                 "check their `segment` and `size_m` under [[tags.tag]]; then record the "
                 "range of motion again, turning that segment before two cameras");
  }
  const double sure_gain = kSureGain * bundle.prior_weight;
  if (fit.runner_up_cost > sure_gain || fit.runner_up_m < kElsewhere_m) {
    return std::nullopt;
  }
  return doubt("the tags on segment " + segment + " fit in two ways, " +
                   millimetres(fit.runner_up_m) + " apart",
               "record the range of motion again, turning that segment slowly before two "
               "cameras, or glue a second tag to it");
}

std::optional<Error> doubt_of_views(std::size_t limb, const SubjectEvidence& evidence) {
  const HumanLimb& bones = human_limbs()[limb];
  if (evidence.extremities[limb].sightings < kFewestSightings) return std::nullopt;
  const double end = evidence.seen_twice_share[index(bones.end)];
  const double lower = evidence.seen_twice_share[index(bones.lower)];
  const bool is_seen = end >= kSeenTwice && lower >= kBoneHardlySeenTwice;
  if (is_seen || lower >= kBoneSeenTwice) return std::nullopt;
  return doubt("two cameras at once see segments " + in_quotes(bones.lower) + " and " +
                   in_quotes(bones.end) + " in only " + percent(lower) + " and " +
                   percent(end) + " of the range of motion",
               "record the range of motion again, turning that limb slowly before two "
               "cameras, or glue tags to other sides of it");
}

void doubt_extremities(const SubjectEvidence& evidence, std::vector<Error>& out) {
  for (const std::optional<Error>& reason : evidence.left_out) {
    if (reason) out.push_back(*reason);
  }
}

void doubt_locations(const SubjectBundle& bundle,
                     const SubjectEvidence& evidence,
                     std::vector<Error>& out) {
  for (const HumanLimb& limb : human_limbs()) {
    for (const HumanBone bone : {limb.upper, limb.lower}) {
      const bool has_tags = std::ranges::any_of(
          bundle.model.segment_from_tag,
          [&](const auto& placed) { return bundle.model.bone(placed.first) == bone; });
      const int frames = evidence.located_frames[index(bone)];
      if (!has_tags || frames >= kFewestLocated) continue;
      out.push_back(doubt(
          "segment " + in_quotes(bone) + " is seen well enough in only " +
              std::to_string(frames) +
              " frames of the range of motion: elsewhere one camera sees one of its "
              "tags, and nearly face on",
          "record the range of motion again, turning that limb slowly before two "
          "cameras, or glue tags to other sides of it"));
    }
  }
}

/// Tags that the fit placed where no flesh of their segment is.
void doubt_places(const SubjectBundle& bundle, std::vector<Error>& out) {
  for (const auto& [tag, place] : bundle.model.segment_from_tag) {
    if (off_flesh(bundle.model, tag) < kMostOffFlesh) continue;
    const TagOnSegment& declared = bundle.model.tags[tag];
    out.push_back(doubt("tag " + std::to_string(number(declared.id)) +
                            " is fitted to a place where segment " +
                            in_quotes(declared.segment) + " has no skin",
                        "check its `segment` and `size_m` under [[tags.tag]]; then "
                        "record the range of motion again, turning that segment slowly "
                        "before two cameras"));
  }
}

void doubt_turns(const SubjectBundle& bundle, std::vector<Error>& out) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const auto turn_rad = standing_turn_rad(limb, bundle);
    if (!turn_rad || std::abs(*turn_rad) < kMostStandingTurn_rad) continue;
    out.push_back(
        doubt("segment " + in_quotes(human_limbs()[limb].upper) +
                  " is fitted turned about its own axis by " + degrees(*turn_rad) +
                  " in the static trial",
              "check that its tags and the next segment's are declared on the "
              "right segments; then record the range of motion again, bending " +
                  std::string(limb < 2 ? "that elbow" : "that knee") +
                  " far before two cameras"));
  }
}

void doubt_lengths(const SubjectBundle& bundle, std::vector<Error>& out) {
  const auto length = [&](Length which) { return bundle.model.lengths[index(which)]; };
  const auto sigma = [&](Length which) { return bundle.length_sigma_m[index(which)]; };
  const auto check = [&](Length left, Length right, HumanBone bone) {
    const double apart_m = std::abs(length(left) - length(right));
    const double sure_m = 3.0 * std::hypot(sigma(left), sigma(right));
    const double ratio = 0.5 * (length(left) + length(right)) / bundle.usual[index(left)];
    if (apart_m > std::max(kSidesDiffer_m, sure_m)) {
      out.push_back(doubt("segment " + in_quotes(bone) + " is " +
                              millimetres(length(left)) + " long on the left and " +
                              millimetres(length(right)) + " on the right",
                          "record the range of motion again, bending both sides far, "
                          "before at least two cameras"));
    }
    if (ratio < kShortest || ratio > kLongest) {
      out.push_back(doubt("segment " + in_quotes(bone) + " is " +
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

void doubt_joints(const SubjectBundle& bundle, std::vector<Error>& out) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const HumanLimb& bones = human_limbs()[limb];
    for (const HumanBone bone : {bones.upper, bones.lower}) {
      const bool is_shoulder = limb < 2 && bone == bones.upper;
      const std::optional<double>& sigma_m = bundle.centre_sigma_m[index(bone)];
      if (sigma_m && *sigma_m < (is_shoulder ? kKnownShoulder_m : kKnownJoint_m))
        continue;
      out.push_back(doubt("the joint at the near end of segment " + in_quotes(bone) +
                              (sigma_m ? " is known to " + millimetres(*sigma_m) + " only"
                                       : " could not be determined"),
                          "record the range of motion again, bending that joint far "
                          "before two cameras at once"));
    }
  }
}

}  // namespace

bool leave_out_extremities(SubjectBundle& bundle, SubjectEvidence& evidence) {
  bool has_changed = false;
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    std::optional<Error>& reason = evidence.left_out[limb];
    reason = doubt_of_place(limb, bundle, evidence);
    if (!reason) reason = doubt_of_views(limb, evidence);
    if (!reason) continue;
    const HumanBone end = human_limbs()[limb].end;
    reason->cause += "; they are left out, and the joint " + in_quotes(end) +
                     " is inferred from the other segments";
    has_changed |= std::erase_if(bundle.model.segment_from_tag, [&](const auto& placed) {
                     return bundle.model.bone(placed.first) == end;
                   }) > 0;
    std::erase_if(evidence.unexplained,
                  [&](std::size_t tag) { return bundle.model.bone(tag) == end; });
  }
  return has_changed;
}

std::vector<Error> doubts_of(const SubjectBundle& bundle,
                             const SubjectEvidence& evidence) {
  std::vector<Error> doubts;
  doubt_tags(bundle, evidence, doubts);
  doubt_sightings(bundle, evidence, doubts);
  doubt_extremities(evidence, doubts);
  doubt_locations(bundle, evidence, doubts);
  doubt_places(bundle, doubts);
  doubt_turns(bundle, doubts);
  doubt_lengths(bundle, doubts);
  doubt_joints(bundle, doubts);
  return doubts;
}

}  // namespace marey::reconstruct
