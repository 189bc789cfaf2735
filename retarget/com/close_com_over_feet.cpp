// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/close_com_over_feet.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/base/assert.h"
#include "core/base/smooth_step.h"
#include "core/human/centre_of_mass.h"

namespace marey::retarget {
namespace {

constexpr double kSameCom_m = 1e-12;
constexpr double kClosed_m = 1e-9;
constexpr double kStill_m = 1e-10;
constexpr int kMaxEvaluations = 24;
constexpr int kMaxGiveWays = 8;
// Hold from which on the root begins to give way to a leg that is too short.
constexpr double kGivesWayFrom = 0.7;
// Largest step of the root, in legs: the derivative is only local.
constexpr double kMaxStepInLegs = 0.3;

// Inverse of the derivative of the centre of mass by the root's position. Broyden's rule
// keeps it up to date from the steps made (Broyden 1965, "good" update, in the form of
// Sherman and Morrison).
void update_inverse(const glm::dvec3& step,
                    const glm::dvec3& change,
                    glm::dmat3& root_from_com) {
  const glm::dvec3 predicted = root_from_com * change;
  const double scale = glm::dot(step, predicted);
  if (std::abs(scale) < 0.1 * glm::dot(step, step)) return;
  const glm::dvec3 row = (glm::transpose(root_from_com) * step) / scale;
  root_from_com += glm::outerProduct(step - predicted, row);
}

}  // namespace

ComCloser::ComCloser(const ComFollower& body)
    : body_(body),
      legs_{StandingLeg(body.skeleton, body.map, 0),
            StandingLeg(body.skeleton, body.map, 1)},
      world_from_joint_(body.skeleton.joints.size()),
      closed_from_joint_(body.skeleton.joints.size()) {
  part_of_mass_.reserve(body.masses.size());
  for (const PointMass& mass : body.masses) {
    std::size_t part = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      if (const auto own = legs_[side].part_of(mass.joint)) part = 1 + 4 * side + *own;
    }
    part_of_mass_.push_back(part);
    mass_kg_ += mass.mass_kg;
  }
  MAREY_ASSERT(mass_kg_ > 0.0);
}

void ComCloser::start_frame(const Pose& reference, const std::array<FootGoal, 2>& feet) {
  world_from_joints(body_.skeleton, reference, world_from_joint_);
  std::array<std::array<LegPart, 4>, 2> parts{};
  other_mass_kg_ = 0.0;
  other_moment_ = glm::dvec3(0.0);
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < body_.masses.size(); ++i) {
    const PointMass& mass = body_.masses[i];
    const glm::dvec3 p = world_from_joint_[index(mass.joint)] * mass.p_in_joint;
    sum += mass.mass_kg * p;
    if (part_of_mass_[i] == 0) {
      other_mass_kg_ += mass.mass_kg;
      other_moment_ += mass.mass_kg * p;
      continue;
    }
    const std::size_t side = (part_of_mass_[i] - 1) / 4;
    const std::size_t part = (part_of_mass_[i] - 1) % 4;
    const JointIndex joint = legs_[side].joint(part);
    parts[side][part].mass_kg += mass.mass_kg;
    parts[side][part].moment +=
        mass.mass_kg * (p - world_from_joint_[index(joint)].translation);
  }
  com_of_reference_ = sum / mass_kg_;
  for (std::size_t side = 0; side < 2; ++side) {
    legs_[side].start_frame(world_from_joint_, parts[side], feet[side]);
    if (legs_[side].hold() > 0.0) continue;
    // A leg without a held foot moves with the root.
    for (std::size_t part = 0; part < 4; ++part) {
      const glm::dvec3 at = world_from_joint_[index(legs_[side].joint(part))].translation;
      other_mass_kg_ += parts[side][part].mass_kg;
      other_moment_ += parts[side][part].mass_kg * at + parts[side][part].moment;
    }
  }
}

// Evaluates the posture for a displacement of the root. Where the leg of a held foot is
// too short, the root gives way along the leg. Where the foot is held in part, the foot
// gives way, by the rest of the share.
void ComCloser::try_at(glm::dvec3& moved_m, Try& out) const {
  const glm::dvec3 wanted_m = moved_m;
  std::array<double, 2> kept_short_m{};
  out.short_leg_m = 0.0;
  for (int k = 0; k < kMaxGiveWays; ++k) {
    double largest_m = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
      if (legs_[side].hold() <= 0.0) continue;
      out.ankles[side] = legs_[side].ankle_over_foot(moved_m);
      const AnkleOverFoot& ankle = out.ankles[side];
      const double hold = legs_[side].hold();
      const double share = legs_[side].root_gives_way() *
                           smooth_step((hold - kGivesWayFrom) / (1.0 - kGivesWayFrom));
      if (ankle.short_m == 0.0 || share <= 0.0) continue;
      if (k == 0) {
        kept_short_m[side] = (1.0 - share) * ankle.short_m;
        out.short_leg_m = std::max(out.short_leg_m, share * ankle.short_m);
      }
      double give_m = ankle.short_m - kept_short_m[side];
      if (give_m * ankle.short_m <= 0.0) continue;
      give_m /= hold;
      largest_m = std::max(largest_m, std::abs(give_m));
      moved_m += give_m * glm::normalize(ankle.ankle_from_hip);
    }
    if (largest_m < kStill_m) break;
  }
  out.gave_way_m = glm::distance(moved_m, wanted_m);
  glm::dvec3 moment = other_moment_ + other_mass_kg_ * moved_m;
  for (std::size_t side = 0; side < 2; ++side) {
    if (legs_[side].hold() <= 0.0) continue;
    if (out.gave_way_m > 0.0) out.ankles[side] = legs_[side].ankle_over_foot(moved_m);
    out.legs[side] = legs_[side].bend(moved_m, out.ankles[side]);
    moment += out.legs[side].moment;
  }
  out.com_in_world = moment / mass_kg_;
}

glm::dvec3 ComCloser::find_root(const glm::dvec3& com_in_world,
                                Try& last,
                                int& evaluations) {
  double moved_kg = other_mass_kg_;
  double longest_m = 0.0;
  for (const StandingLeg& leg : legs_) {
    if (leg.hold() > 0.0) moved_kg += leg.moved_mass_kg();
    longest_m = std::max(longest_m, leg.length_m());
  }
  const double first_guess = mass_kg_ / std::max(moved_kg, 0.2 * mass_kg_);
  glm::dmat3 root_from_com(first_guess);
  const double max_step_m = kMaxStepInLegs * longest_m;
  const auto limited = [&](const glm::dvec3& step) {
    const double length_m = glm::length(step);
    return length_m > max_step_m ? step * (max_step_m / length_m) : step;
  };

  glm::dvec3 moved_m = limited(root_from_com * (com_in_world - com_of_reference_));
  try_at(moved_m, last);
  evaluations = 1;
  glm::dvec3 missing_m = com_in_world - last.com_in_world;
  while (evaluations < kMaxEvaluations && glm::length(missing_m) > kClosed_m) {
    const bool was_free = last.gave_way_m == 0.0;
    const glm::dvec3 from_m = moved_m;
    const glm::dvec3 com_from_m = last.com_in_world;
    moved_m += limited(root_from_com * missing_m);
    try_at(moved_m, last);
    ++evaluations;
    const glm::dvec3 step = moved_m - from_m;
    missing_m = com_in_world - last.com_in_world;
    if (was_free && last.gave_way_m == 0.0) {
      update_inverse(step, last.com_in_world - com_from_m, root_from_com);
      continue;
    }
    if (glm::length(step) < kStill_m) break;
    root_from_com = glm::dmat3(first_guess);
  }
  return moved_m;
}

void ComCloser::measure(const glm::dvec3& com_in_world,
                        const Pose& pose,
                        ClosedFrame& out) {
  world_from_joints(body_.skeleton, pose, closed_from_joint_);
  out.com_error_m =
      glm::distance(centre_of_mass(body_.masses, closed_from_joint_), com_in_world);
}

ClosedFrame ComCloser::close(const Pose& reference,
                             const glm::dvec3& com_in_world,
                             const std::array<FootGoal, 2>& feet,
                             Pose& out) {
  ClosedFrame report;
  start_frame(reference, feet);
  const bool is_own = glm::distance(com_in_world, com_of_reference_) < kSameCom_m &&
                      legs_[0].is_at_goal() && legs_[1].is_at_goal();
  if (&out != &reference) out = reference;
  if (is_own) return report;
  Try last;
  const bool is_held = legs_[0].hold() > 0.0 || legs_[1].hold() > 0.0;
  const glm::dvec3 moved_m = is_held ? find_root(com_in_world, last, report.evaluations)
                                     : com_in_world - com_of_reference_;
  out.root_in_world += moved_m;
  report.short_leg_m = is_held ? last.short_leg_m : 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    if (legs_[side].hold() <= 0.0) continue;
    legs_[side].write(last.legs[side], world_from_joint_, out);
  }
  measure(com_in_world, out, report);
  for (std::size_t side = 0; side < 2; ++side) {
    const StandingLeg& leg = legs_[side];
    if (leg.hold() <= 0.0) continue;
    const glm::dvec3 ankle = closed_from_joint_[index(leg.joint(2))].translation;
    const glm::dvec3 rise = leg.rise_m(last.ankles[side]);
    report.raised_heel_m = std::max(report.raised_heel_m, glm::length(rise));
    if (leg.hold() < 1.0) continue;
    const glm::dvec3 wanted = feet[side].place.ankle_in_world + rise;
    report.foot_error_m = std::max(report.foot_error_m, glm::distance(ankle, wanted));
  }
  return report;
}

}  // namespace marey::retarget
