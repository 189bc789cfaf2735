// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_body.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "reconstruct/markers/body_stature.h"
#include "reconstruct/posture/measured_sigma.h"
#include "reconstruct/tags/solve_motion.h"

namespace marey::app {
namespace {

std::optional<Finding> stature_finding(const Body& body) {
  constexpr double kSigmas = 3.0;
  std::array<bool, kHumanBoneCount> measured{};
  // Only the legs are used: tags measure the rotation of the trunk better than its
  // length.
  for (const HumanLimb& limb : human_limbs()) {
    if (limb.end != HumanBone::kLeftFoot && limb.end != HumanBone::kRightFoot) continue;
    measured[index(limb.lower)] = true;
    measured[index(limb.end)] = true;
  }
  const auto by_legs = reconstruct::stature_of_body(body.proportions, measured);
  if (!by_legs ||
      std::abs(by_legs->stature_m - body.stature_m) < kSigmas * by_legs->sigma_m) {
    return std::nullopt;
  }
  std::array<char, 200> text{};
  std::snprintf(text.data(),
                text.size(),
                "stature_m of [subject] is %.2f m, but the legs are as long as those of "
                "a person of %.2f m (standard deviation %.2f m)",
                body.stature_m,
                by_legs->stature_m,
                by_legs->sigma_m);
  return fair_finding("stature",
                      "",
                      text.data(),
                      "correct stature_m; if it is right, check size_m of the tags and "
                      "tag_size_m of [board]");
}

Finding joint_finding(HumanBone joint, double sigma_m) {
  std::array<char, 200> text{};
  std::snprintf(text.data(),
                text.size(),
                "the position of joint \"%s\" has a standard deviation of %.0f mm: it is "
                "inferred in all motions, and the segments below it are as uncertain",
                std::string(name(joint)).c_str(),
                1e3 * sigma_m);
  return fair_finding("joint",
                      "",
                      text.data(),
                      "record the range of motion again, moving that limb far to all "
                      "sides before two cameras at once");
}

}  // namespace

std::vector<Finding> assess_body(const Body& body) {
  std::vector<Finding> findings;
  if (auto finding = stature_finding(body)) findings.push_back(std::move(*finding));
  for (const HumanLimb& limb : human_limbs()) {
    const double sigma_m = reconstruct::centre_sigma_in_motion_m(body, limb.upper);
    if (sigma_m > reconstruct::kMaxMeasuredSigma_m)
      findings.push_back(joint_finding(limb.upper, sigma_m));
  }
  return findings;
}

}  // namespace marey::app
