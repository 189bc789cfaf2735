// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/assess_live_subject.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

#include "core/base/lower_case.h"

namespace marey::app {
namespace {

constexpr double kPoorSigma_m = 0.01;
/// Limit of the difference between the sides, above that of real subjects. A limb that
/// was rarely seen can have a larger error than its sigma.
constexpr double kPoorSide = 0.05;
constexpr double kPoorRms_px = 5.0;
constexpr double kPoorRatio = 0.15;
constexpr std::size_t kTagsPerUnplaced = 5;

std::string format(const char* form, double a, double b = 0.0) {
  char text[64];
  std::snprintf(text, sizeof text, form, a, b);
  return text;
}

/// Returns a row of the table: a note if the value is good.
Finding row(std::string name, std::string value, bool is_good) {
  return {is_good ? Severity::kNote : Severity::kFair,
          "subject",
          std::move(name),
          std::move(value),
          ""};
}

/// Returns the length of a bone, from its joint to the joint of its child.
Finding length_of(const Body& body, HumanBone bone, HumanBone child) {
  const double length_m = glm::length(body.proportions[child]);
  const double other_m = glm::length(body.proportions[mirrored(child)]);
  const double sigma_m = body.joint_centre_sigma_m[index(child)];
  // A displayed sigma of zero would be misleading.
  const double sigma_cm = std::max(100.0 * sigma_m, 0.1);
  return row(in_words(bone),
             format("%.1f cm \u00b1 %.1f", 100.0 * length_m, sigma_cm),
             sigma_m <= kPoorSigma_m &&
                 std::abs(length_m - other_m) <= kPoorSide * std::max(length_m, other_m));
}

Finding unplaced_of(const reconstruct::SubjectFit& fit) {
  std::string names;
  for (const TagId id : fit.unplaced) {
    names += (names.empty() ? "" : ", ") + std::to_string(number(id));
  }
  const std::size_t all = fit.body.tags.size() + fit.unplaced.size();
  return row("tags without a position",
             names.empty() ? "none" : names,
             kTagsPerUnplaced * fit.unplaced.size() <= all);
}

}  // namespace

std::string in_words(HumanBone bone) {
  std::string words;
  for (const char letter : name(bone)) {
    if (lower_case(letter) != letter) words += ' ';
    words += lower_case(letter);
  }
  return words;
}

std::vector<Finding> assess_live_subject(const reconstruct::SubjectFit& fit) {
  std::vector<Finding> out;
  for (const HumanLimb& limb : human_limbs()) {
    out.push_back(length_of(fit.body, limb.upper, limb.lower));
    out.push_back(length_of(fit.body, limb.lower, limb.end));
  }
  std::string distance = format("%.2f px", fit.rms_px);
  for (const Finding& finding : fit.findings) {
    distance += "; " + finding.cause + ": " + finding.next;
  }
  out.push_back(row("residual to the detected tags",
                    distance,
                    fit.rms_px <= kPoorRms_px && fit.findings.empty()));
  out.push_back(row("limbs relative to an average person",
                    format("%.0f %%", 100.0 * fit.limb_ratio),
                    std::abs(fit.limb_ratio - 1.0) <= kPoorRatio));
  out.push_back(unplaced_of(fit));
  return out;
}

}  // namespace marey::app
