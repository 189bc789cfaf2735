// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/posture_jacobian.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/model/project_point.h"
#include "core/base/cross_matrix.h"
#include "core/human/posture_priors.h"

namespace marey::calib {
namespace {

using B = HumanBone;
using Row = Eigen::Matrix<double, 1, kPostureColumns>;
using Rows = Eigen::Matrix<double, 3, kPostureColumns>;

constexpr int kHips = 3;
constexpr int kAbdomenEnd = 6;
constexpr int kThorax = 9;
constexpr int kNeck = 12;
constexpr int kHead = 15;
constexpr int kShoulders = 18;  ///< Left, then right.
constexpr int kLimbs = 24;      ///< In the order of human_limbs(); each has:
constexpr int kFlexion = 3;
constexpr int kUpperTwist = 4;
constexpr int kLowerTwist = 5;
constexpr int kEnd = 6;
constexpr int kPerLimb = 9;

constexpr int limb_column(std::size_t limb) {
  return kLimbs + kPerLimb * static_cast<int>(limb);
}

Eigen::Vector3d in_world(const BodyPlace& place, B bone, const glm::dvec3& v) {
  return to_eigen(place[index(bone)].rotation * v);
}

/// The length that scales a bone's offset from its parent, and its direction in the
/// parent's frame.
struct Stretch {
  int column;
  glm::dvec3 way;
};

std::optional<Stretch> stretch_of(B bone, const Proportions& p) {
  switch (bone) {
    case B::kSpine:
      return Stretch{0, {0, 1, 0}};
    case B::kChest:
      return Stretch{1, {0, 1, 0}};
    case B::kUpperChest:
      return Stretch{2, {0, 1, 0}};
    case B::kNeck:
      return Stretch{3, {0, 1, 0}};
    case B::kHead:
      return Stretch{4, {0, 1, 0}};
    case B::kLeftUpperLeg:
      return Stretch{5, {1, 0, 0}};
    case B::kRightUpperLeg:
      return Stretch{5, {-1, 0, 0}};
    default:
      break;
  }
  constexpr std::array<B, 10> kLimbLengths{B::kLeftUpperArm,
                                           B::kRightUpperArm,
                                           B::kLeftLowerArm,
                                           B::kRightLowerArm,
                                           B::kLeftHand,
                                           B::kRightHand,
                                           B::kLeftLowerLeg,
                                           B::kRightLowerLeg,
                                           B::kLeftFoot,
                                           B::kRightFoot};
  for (std::size_t i = 0; i < kLimbLengths.size(); ++i) {
    if (kLimbLengths[i] != bone) continue;
    return Stretch{6 + static_cast<int>(i), glm::normalize(p[bone])};
  }
  return std::nullopt;
}

Rows turning(int column) {
  Rows rows = Rows::Zero();
  rows.middleCols<3>(column).setIdentity();
  return rows;
}

void spin_limb(std::size_t limb,
               const PlannedBody& body,
               const BodyPlace& place,
               PostureJacobian& out) {
  const HumanLimb& bones = human_limbs()[limb];
  const int at = limb_column(limb);
  const double upper_m = glm::length(body.proportions[bones.lower]);
  const double lower_m = glm::length(body.proportions[bones.end]);
  const Eigen::Vector3d hinge = in_world(place, bones.upper, bones.hinge_axis);
  const Eigen::Vector3d upper =
      in_world(place, bones.upper, glm::normalize(body.proportions[bones.lower]));
  const Eigen::Vector3d lower =
      in_world(place, bones.lower, glm::normalize(body.proportions[bones.end]));
  // The end stays on the frame's axis: flexion rotates the upper bone backwards. This is
  // the upper bone's share of the angle in the triangle.
  const double bent = std::acos(std::clamp(upper.dot(lower), -1.0, 1.0));
  const double reach2 =
      upper_m * upper_m + lower_m * lower_m + 2.0 * upper_m * lower_m * std::cos(bent);
  const double upper_share = lower_m * (lower_m + upper_m * std::cos(bent)) / reach2;
  out.spin[index(bones.upper)] = turning(at);
  out.spin[index(bones.upper)].col(at + kFlexion) = -upper_share * hinge;
  out.spin[index(bones.lower)] = turning(at);
  out.spin[index(bones.lower)].col(at + kFlexion) = (1.0 - upper_share) * hinge;
  out.spin[index(bones.upper)].col(at + kUpperTwist) = upper;
  out.spin[index(bones.lower)].col(at + kLowerTwist) = lower;
  out.spin[index(bones.end)] = turning(at + kEnd);
}

void set_spins(const PlannedBody& body, const BodyPlace& place, PostureJacobian& out) {
  out.spin[index(B::kHips)] = turning(kHips);
  out.spin[index(B::kChest)] = turning(kAbdomenEnd);
  out.spin[index(B::kSpine)] = 0.5 * (turning(kHips) + turning(kAbdomenEnd));
  out.spin[index(B::kUpperChest)] = turning(kThorax);
  out.spin[index(B::kNeck)] = turning(kNeck);
  out.spin[index(B::kHead)] = turning(kHead);
  out.spin[index(B::kLeftShoulder)] = turning(kShoulders);
  out.spin[index(B::kRightShoulder)] = turning(kShoulders + 3);
  for (std::size_t limb = 0; limb < 4; ++limb) spin_limb(limb, body, place, out);
  out.spin[index(B::kLeftToes)] = out.spin[index(B::kLeftFoot)];
  out.spin[index(B::kRightToes)] = out.spin[index(B::kRightFoot)];
}

/// Rows divided by their sigmas.
class Prior {
 public:
  void add(const Row& row, double sigma) { rows_.push_back(row / sigma); }
  /// Adds a row per axis of the world.
  void add(const Rows& rows, double sigma) {
    for (int axis = 0; axis < 3; ++axis) add(Row(rows.row(axis)), sigma);
  }
  void add_column(int column, double sigma) { add(Row(Row::Unit(column)), sigma); }
  void add_upright(const Rows& spin, const Eigen::Vector3d& ahead, double sigma) {
    // About its left axis and, if it must not roll, about its forward axis.
    add(Row(ahead.transpose() * spin), sigma);
    add(Row(Eigen::Vector3d::UnitY().cross(ahead).transpose() * spin), sigma);
  }
  [[nodiscard]] PosturePriorRows rows() const {
    PosturePriorRows out(static_cast<Eigen::Index>(rows_.size()), kPostureColumns);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      out.row(static_cast<Eigen::Index>(i)) = rows_[i];
    }
    return out;
  }

 private:
  std::vector<Row> rows_;
};

Rows relative(const PostureJacobian& jacobian, B child, B of) {
  return jacobian.spin[index(child)] - jacobian.spin[index(of)];
}

}  // namespace

PostureJacobian posture_jacobian(const PlannedBody& body, const BodyPlace& place) {
  PostureJacobian out;
  for (auto& rows : out.spin) rows.setZero();
  set_spins(body, place, out);
  for (const B bone : human_bones()) {
    Rows& origin = out.origin[index(bone)];
    auto& by_length = out.origin_by_length[index(bone)];
    auto& by_base = out.origin_by_base[index(bone)];
    const auto above = parent(bone);
    if (!above) {
      origin = turning(0);
      by_length.setZero();
      by_base.setZero();
      continue;
    }
    const Eigen::Vector3d offset = in_world(place, *above, body.proportions[bone]);
    origin = out.origin[index(*above)] -
             cross_matrix<Eigen::Matrix3d>(offset) * out.spin[index(*above)];
    by_length = out.origin_by_length[index(*above)];
    by_base = out.origin_by_base[index(*above)];
    if (bone == B::kLeftShoulder || bone == B::kRightShoulder) {
      by_base.middleCols<3>(bone == B::kLeftShoulder ? 0 : 3) =
          to_eigen(place[index(*above)].rotation).toRotationMatrix();
    }
    if (const auto stretch = stretch_of(bone, body.proportions)) {
      by_length.col(stretch->column) += in_world(place, *above, stretch->way);
    }
  }
  return out;
}

PosturePriorRows posture_prior_rows(const BodyPlace& place,
                                    const PostureJacobian& jacobian,
                                    double arm_twist_rad) {
  Prior prior;
  prior.add(Rows(turning(kAbdomenEnd) - 0.5 * (turning(kHips) + turning(kThorax))),
            kAbdomenBendSigma_rad);
  prior.add(Rows(turning(kNeck) - 0.5 * (turning(kThorax) + turning(kHead))),
            kNeckBendSigma_rad);
  prior.add(relative(jacobian, B::kUpperChest, B::kHips), kTrunkTurnSigma_rad);
  prior.add(relative(jacobian, B::kHead, B::kUpperChest), kTrunkTurnSigma_rad);
  for (const B shoulder : {B::kLeftShoulder, B::kRightShoulder}) {
    const Rows turn = relative(jacobian, shoulder, B::kUpperChest);
    const auto axis = [&](const glm::dvec3& v) {
      return Row(in_world(place, shoulder, v).transpose() * turn);
    };
    prior.add(axis({1, 0, 0}), kCollarBoneSigma_rad.x);
    prior.add(axis({0, 1, 0}), kCollarBoneSigma_rad.y);
    prior.add(axis({0, 0, 1}), kCollarBoneSigma_rad.z);
  }
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const bool arm = limb < 2;
    const int at = limb_column(limb);
    const B trunk = arm ? B::kUpperChest : B::kHips;
    prior.add(Rows(turning(at) - jacobian.spin[index(trunk)]),
              arm ? kArmSigma_rad : kLegSigma_rad);
    const HumanLimb& bones = human_limbs()[limb];
    prior.add(relative(jacobian, bones.end, bones.lower),
              arm ? kHandSigma_rad : kFootSigma_rad);
    prior.add_column(at + kUpperTwist, arm ? arm_twist_rad : kLegTwistSigma_rad);
    prior.add_column(at + kLowerTwist, arm ? arm_twist_rad : kLegTwistSigma_rad);
    prior.add_column(at + kFlexion, kFlexionSigma_rad);
  }
  return prior.rows();
}

PosturePriorRows standing_prior_rows(const BodyPlace& place,
                                     const PostureJacobian& jacobian) {
  Prior prior;
  const auto ahead = [&](B bone) { return in_world(place, bone, {0, 0, 1}); };
  // Hips: their roll is measured, not part of the prior.
  prior.add(Row(Eigen::Vector3d::UnitY().cross(ahead(B::kHips)).transpose() *
                jacobian.spin[index(B::kHips)]),
            kStandingTrunkSigma_rad);
  for (const B bone : {B::kUpperChest, B::kHead, B::kLeftFoot, B::kRightFoot}) {
    const bool foot = bone == B::kLeftFoot || bone == B::kRightFoot;
    prior.add_upright(jacobian.spin[index(bone)],
                      ahead(bone),
                      foot ? kStandingFootSigma_rad : kStandingTrunkSigma_rad);
  }
  prior.add(Rows(turning(kAbdomenEnd) - 0.5 * (turning(kHips) + turning(kThorax))),
            kStandingBendSigma_rad);
  prior.add(relative(jacobian, B::kHead, B::kUpperChest), kStandingTurnSigma_rad);
  prior.add(relative(jacobian, B::kLeftShoulder, B::kUpperChest), kStandingTurnSigma_rad);
  prior.add(relative(jacobian, B::kRightShoulder, B::kUpperChest),
            kStandingTurnSigma_rad);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const HumanLimb& bones = human_limbs()[limb];
    prior.add(relative(jacobian, bones.end, bones.lower),
              limb < 2 ? kStandingHandSigma_rad : kStandingAnkleSigma_rad);
    prior.add_column(limb_column(limb) + kUpperTwist, kStandingTwistSigma_rad);
    prior.add_column(limb_column(limb) + kLowerTwist, kStandingTwistSigma_rad);
  }
  return prior.rows();
}

StepPrior step_prior(FrameRate rate) {
  StepPrior prior;
  const auto set = [&prior](int column, int count, const StepProcess& process) {
    prior.sigma.segment(column, count).setConstant(process.sigma);
    prior.correlation.segment(column, count).setConstant(process.correlation);
  };
  const auto turns = [&](int column, int count, double acceleration_rad_s2) {
    set(column, count, step_process(acceleration_rad_s2, rate));
  };
  set(0, 3, hips_step_process(rate));
  for (const int column : {kHips, kAbdomenEnd, kThorax, kShoulders, kShoulders + 3}) {
    turns(column, 3, kTrunkAcceleration_rad_s2);
  }
  turns(kNeck, 3, kNeckAcceleration_rad_s2);
  turns(kHead, 3, kHeadAcceleration_rad_s2);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const bool arm = limb < 2;
    const int at = limb_column(limb);
    turns(at, 3, arm ? kArmAcceleration_rad_s2 : kLegAcceleration_rad_s2);
    turns(at + kFlexion, 1, kFlexionAcceleration_rad_s2);
    turns(at + kUpperTwist,
          1,
          arm ? kUpperArmTwistAcceleration_rad_s2 : kLegTwistAcceleration_rad_s2);
    turns(at + kLowerTwist,
          1,
          arm ? kForearmTwistAcceleration_rad_s2 : kLegTwistAcceleration_rad_s2);
    turns(at + kEnd, 3, arm ? kHandAcceleration_rad_s2 : kFootAcceleration_rad_s2);
  }
  return prior;
}

Eigen::Matrix<double, kLengthColumns, kLengthColumns> length_information(
    const PlannedBody& body) {
  Eigen::Matrix<double, kLengthColumns, kLengthColumns> sum;
  sum.setZero();
  for (const B bone : human_bones()) {
    const auto stretch = stretch_of(bone, body.proportions);
    if (!stretch || bone == B::kRightUpperLeg) continue;
    const double typical_m = glm::dot(stretch->way, body.proportions[bone]);
    const double sigma_m = length_sigma_m(typical_m);
    sum(stretch->column, stretch->column) += 1.0 / (sigma_m * sigma_m);
  }
  for (int left = 6; left < kLengthColumns; left += 2) {
    Eigen::Matrix<double, 1, kLengthColumns> row;
    row.setZero();
    row[left] = 1.0 / kSidesDifferSigma_m;
    row[left + 1] = -1.0 / kSidesDifferSigma_m;
    sum += row.transpose() * row;
  }
  return sum;
}

}  // namespace marey::calib
