// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/doubt_subject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace marey::reconstruct {
namespace {

// A tag that was seen less often may be misread each time.
constexpr int kFewestSightings = 10;
// Half squares by which one hypothesis must beat another: 4.5 sigma.
constexpr double kSureGain = 10.0;
// Two hypotheses whose joints are nearer are one answer. [m]
constexpr double kElsewhere_m = 0.04;
// People's left and right bones differ by millimetres. [m]
constexpr double kSidesDiffer_m = 0.03;
// Of an average person's length at this stature: five standard deviations.
constexpr double kShortest = 0.7;
constexpr double kLongest = 1.35;

// Hips, knees, shoulders and elbows known no better make no motion, per coordinate. [m]
constexpr double kKnownJoint_m = 0.025;

std::string millimetres(double m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.0f mm", 1e3 * m);
  return text.data();
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

void doubt_extremities(const SubjectEvidence& evidence, std::vector<Error>& out) {
  for (std::size_t limb = 0; limb < evidence.extremities.size(); ++limb) {
    const ExtremityFit& fit = evidence.extremities[limb];
    const std::string segment = in_quotes(human_limbs()[limb].end);
    if (fit.sightings < kFewestSightings) continue;
    if (!fit.placed) {
      out.push_back(
          doubt("no place of the tags on segment " + segment +
                    " explains what the cameras saw of them",
                "check their `segment` and `size_m` under [[tags.tag]]; then record the "
                "range of motion again, turning that segment before two cameras"));
      continue;
    }
    if (fit.runner_up_cost > kSureGain || fit.runner_up_m < kElsewhere_m) continue;
    out.push_back(doubt("the tags on segment " + segment + " fit in two ways, " +
                            millimetres(fit.runner_up_m) + " apart",
                        "record the range of motion again, turning that segment slowly "
                        "before two cameras, or glue a second tag to it"));
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
  for (const HumanLimb& limb : human_limbs()) {
    for (const HumanBone bone : {limb.upper, limb.lower}) {
      const std::optional<double>& sigma_m = bundle.centre_sigma_m[index(bone)];
      if (sigma_m && *sigma_m < kKnownJoint_m) continue;
      out.push_back(doubt("the joint at the near end of segment " + in_quotes(bone) +
                              " is known to " +
                              (sigma_m ? millimetres(*sigma_m) : "nothing") + " only",
                          "record the range of motion again, bending that joint far "
                          "before two cameras at once"));
    }
  }
}

}  // namespace

std::vector<Error> doubts_of(const SubjectBundle& bundle,
                             const SubjectEvidence& evidence) {
  std::vector<Error> doubts;
  doubt_tags(bundle, evidence, doubts);
  doubt_extremities(evidence, doubts);
  doubt_lengths(bundle, doubts);
  doubt_joints(bundle, doubts);
  return doubts;
}

}  // namespace marey::reconstruct
