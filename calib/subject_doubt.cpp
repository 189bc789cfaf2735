// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/subject_doubt.h"

#include <glm/geometric.hpp>

#include "calib/see_point.h"

namespace marey::calib {
namespace {

// As many as marey's own bundle chooses (reconstruct/fit_subject.cpp).
constexpr int kMovingFrames = 90;
constexpr int kStandingFrames = 5;
constexpr double kArmTwist_rad = 0.1;

/// Adds what a frame tells of the shared columns, whatever its posture.
void add_frame(const FrameInformation& frame, Eigen::MatrixXd& shared) {
  const Eigen::MatrixXd follows = frame.posture.llt().solve(frame.coupling);
  shared.noalias() -= frame.coupling.transpose() * follows;
}

/// A tag on a limb faces away from its bone; and any tag is on the body.
void add_tag_priors(const PlannedBody& body,
                    const SharedColumns& columns,
                    Eigen::MatrixXd& shared) {
  constexpr double kAnyTurn_rad = 3.0;
  constexpr double kAnyPlace_m = 0.5;
  constexpr double kOffAxis_m = 0.02;
  for (std::size_t i = 0; i < body.tags.size(); ++i) {
    const PlacedTag& tag = body.tags[i];
    Eigen::Matrix<double, 6, 6> prior = Eigen::Matrix<double, 6, 6>::Zero();
    prior.diagonal().head<3>().setConstant(1.0 / (kAnyTurn_rad * kAnyTurn_rad));
    prior.diagonal().tail<3>().setConstant(1.0 / (kAnyPlace_m * kAnyPlace_m));
    for (const HumanLimb& limb : human_limbs()) {
      const HumanBone bone = tag.tag.segment;
      if (bone != limb.upper && bone != limb.lower) continue;
      const HumanBone next = bone == limb.upper ? limb.lower : limb.end;
      const glm::dvec3 along = glm::normalize(body.proportions[next]);
      const glm::dvec3 normal = tag.segment_from_tag.rotation * glm::dvec3(0, 0, 1);
      const glm::dvec3 p = tag.segment_from_tag.translation;
      const glm::dvec3 across = glm::cross(along, normal);
      Eigen::Matrix<double, 1, 6> row;
      // How p . (along x normal) follows turning the normal, and moving p.
      const glm::dvec3 by_turn =
          p * glm::dot(along, normal) - along * glm::dot(p, normal);
      row << to_eigen(by_turn).transpose(), to_eigen(across).transpose();
      row /= (glm::length(across) + 0.05) * kOffAxis_m;
      prior += row.transpose() * row;
    }
    shared.block<6, 6>(columns.tag(i), columns.tag(i)) += prior;
  }
}

}  // namespace

Eigen::MatrixXd subject_doubt(std::span<const Camera> cameras,
                              const RigCovariance* covariance,
                              const PlannedBody& body,
                              const glm::dvec2& floor_m,
                              const CornerSigma& corner_sigma,
                              const PlanOptions& options,
                              const SharedColumns& columns) {
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(columns.count(), columns.count());
  const auto add = [&](const BodyPlace& place, bool stands) {
    const auto views = views_of(cameras, body, place, options);
    const BodyMotion motion = motion_of(body, place);
    FrameInformation frame = information_of(
        cameras, body, place, motion, views, corner_sigma, columns, &shared);
    add_habits(habits(place, motion, kArmTwist_rad), frame);
    if (stands) {
      const HabitRows upright = standing_habits(place, motion);
      frame.posture.noalias() += upright.transpose() * upright;
    }
    add_frame(frame, shared);
  };
  for (int f = 0; f < kStandingFrames; ++f) add(standing_body(body, floor_m, 0.0), true);
  for (int f = 0; f < kMovingFrames; ++f) {
    add(exercising_body(body, floor_m, (f + 0.5) / kMovingFrames), false);
  }
  const int own = columns.body();
  const int rest = columns.count() - own;
  shared.topLeftCorner<kLengthColumns, kLengthColumns>() += usual_lengths(body);
  add_tag_priors(body, columns, shared);
  const Eigen::LLT<Eigen::MatrixXd> factor(shared.topLeftCorner(own, own));
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(columns.count(), columns.count());
  out.topLeftCorner(own, own) = factor.solve(Eigen::MatrixXd::Identity(own, own));
  const Eigen::MatrixXd takes_over = -factor.solve(shared.topRightCorner(own, rest));
  Eigen::MatrixXd doubt = Eigen::MatrixXd::Zero(rest, rest);
  doubt.diagonal().tail<kBaseColumns>().setConstant(kBaseSigma_m * kBaseSigma_m);
  for (std::size_t row = 0; covariance && row < covariance->size(); ++row) {
    for (std::size_t column = 0; column < covariance->size(); ++column) {
      doubt(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          covariance->at(row, column);
    }
  }
  out.topRightCorner(own, rest) = takes_over * doubt;
  out.bottomLeftCorner(rest, own) = out.topRightCorner(own, rest).transpose();
  out.topLeftCorner(own, own) += out.topRightCorner(own, rest) * takes_over.transpose();
  out.bottomRightCorner(rest, rest) = doubt;
  return out;
}

}  // namespace marey::calib
