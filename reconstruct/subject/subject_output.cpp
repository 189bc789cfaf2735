// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject/subject_output.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/base/assert.h"

namespace marey::reconstruct {
namespace {

constexpr std::array<Length, 8> kSegments{Length::kLeftUpperArm,
                                          Length::kRightUpperArm,
                                          Length::kLeftLowerArm,
                                          Length::kRightLowerArm,
                                          Length::kLeftUpperLeg,
                                          Length::kRightUpperLeg,
                                          Length::kLeftLowerLeg,
                                          Length::kRightLowerLeg};
/// Completes the proportions by toes and tips, which no tag shows: average, with the
/// soles on the floor while standing.
Proportions finish(const SubjectBundle& bundle, const Proportions& average) {
  Proportions p = to_proportions(bundle.model.lengths, bundle.model.body, average);
  const auto ankle_height = [&](HumanBone foot) {
    double sum = 0.0;
    int count = 0;
    for (const BundleFrame& frame : bundle.frames) {
      if (!frame.standing) continue;
      sum += world_from_bone(foot, frame.posture, bundle.model.lengths, bundle.model.body)
                 .translation.y;
      ++count;
    }
    MAREY_ASSERT(count > 0);
    return sum / count;
  };
  const double toe_height_m =
      average[HumanBone::kHips].y + average[HumanBone::kLeftUpperLeg].y +
      average[HumanBone::kLeftLowerLeg].y + average[HumanBone::kLeftFoot].y +
      average[HumanBone::kLeftToes].y;
  const auto set_toes = [&](HumanBone foot, HumanBone toes) {
    p[toes].y = -std::clamp(ankle_height(foot) - toe_height_m, 0.01, 0.15);
  };
  set_toes(HumanBone::kLeftFoot, HumanBone::kLeftToes);
  set_toes(HumanBone::kRightFoot, HumanBone::kRightToes);
  const double leg_m = leg_length_m(p);
  p[HumanBone::kHips].y =
      -p[HumanBone::kLeftUpperLeg].y + leg_m - p[HumanBone::kLeftToes].y + toe_height_m;
  return p;
}

std::array<double, kHumanBoneCount> centre_sigmas(const SubjectBundle& bundle) {
  // If neither a joint's bone nor its parent has tags, its centre is no better determined
  // than any length.
  const double unknown_m =
      *std::max_element(bundle.length_sigma_m.begin(), bundle.length_sigma_m.end());
  std::array<double, kHumanBoneCount> sigmas{};
  sigmas.fill(unknown_m);
  for (std::size_t b = 0; b < sigmas.size(); ++b) {
    sigmas[b] = bundle.centre_sigma_m[b].value_or(unknown_m);
  }
  return sigmas;
}

/// Returns whether the tags of this hand or foot are left out of the fit.
bool is_left_out(HumanBone bone, const SubjectEvidence& evidence) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    if (bone == human_limbs()[limb].end) return evidence.left_out[limb].has_value();
  }
  return false;
}

}  // namespace

double limb_ratio(const Lengths& measured,
                  const Lengths& usual,
                  std::span<const Length> segments) {
  std::vector<double> ratios;
  for (const Length length : segments) {
    ratios.push_back(measured[index(length)] / usual[index(length)]);
  }
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

SubjectFit to_fit(const SubjectPrior& prior,
                  const SubjectBundle& bundle,
                  const SubjectEvidence& evidence,
                  const Proportions& average) {
  SubjectFit fit;
  fit.body.name = prior.name;
  fit.body.stature_m = prior.stature_m;
  fit.body.mass_kg = prior.mass_kg;
  fit.body.proportions = finish(bundle, average);
  fit.body.hinges = bundle.model.body.hinges;
  fit.body.joint_centre_sigma_m = centre_sigmas(bundle);
  for (std::size_t i = 0; i < bundle.model.tags.size(); ++i) {
    const auto pose = bundle.model.segment_from_tag.find(i);
    if (is_left_out(bundle.model.bone(i), evidence)) continue;
    if (pose == bundle.model.segment_from_tag.end()) {
      fit.unplaced.push_back(bundle.model.tags[i].id);
      continue;
    }
    PlacedTag placed{bundle.model.tags[i], pose->second, 0.0, 0.0, 0};
    const TagSigma& sigma = bundle.tag_sigma.at(i);
    placed.sigma_m = sigma.m;
    placed.sigma_rad = sigma.rad;
    placed.sightings = sightings_of(i, bundle);
    fit.body.tags.push_back(placed);
  }
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const std::optional<Finding>& reason = evidence.left_out[limb];
    if (reason) fit.left_out.push_back({human_limbs()[limb].end, *reason});
  }
  fit.rms_px = bundle.rms_px;
  fit.limb_ratio = limb_ratio(bundle.model.lengths, bundle.usual, kSegments);
  return fit;
}

}  // namespace marey::reconstruct
