// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/subject_uncertainty.h"

#include <glm/geometric.hpp>

#include "calib/model/project_point.h"
#include "core/human/posture_priors.h"

namespace marey::calib {
namespace {

// The same number as in marey's own bundle (reconstruct/subject/fit_subject.cpp).
constexpr int kMovingFrames = 90;
constexpr int kStandingFrames = 5;

/// Adds a frame's information on the shared columns, with its posture eliminated.
void add_frame(const FrameInformation& frame, Eigen::MatrixXd& shared) {
  const Eigen::MatrixXd follows = frame.posture.llt().solve(frame.coupling);
  shared.noalias() -= frame.coupling.transpose() * follows;
}

/// Priors: a tag on a limb faces away from its bone, and every tag is on the body.
void add_tag_priors(const PlannedBody& body,
                    const SharedColumns& columns,
                    Eigen::MatrixXd& shared) {
  constexpr double kTurnSigma_rad = 3.0;
  constexpr double kPlaceSigma_m = 0.5;
  constexpr double kOffAxis_m = 0.02;
  for (std::size_t i = 0; i < body.tags.size(); ++i) {
    const PlacedTag& tag = body.tags[i];
    Eigen::Matrix<double, 6, 6> prior = Eigen::Matrix<double, 6, 6>::Zero();
    prior.diagonal().head<3>().setConstant(1.0 / (kTurnSigma_rad * kTurnSigma_rad));
    prior.diagonal().tail<3>().setConstant(1.0 / (kPlaceSigma_m * kPlaceSigma_m));
    for (const HumanLimb& limb : human_limbs()) {
      const HumanBone bone = tag.tag.segment;
      if (bone != limb.upper && bone != limb.lower) continue;
      const HumanBone next = bone == limb.upper ? limb.lower : limb.end;
      const glm::dvec3 along = glm::normalize(body.proportions[next]);
      const glm::dvec3 normal = tag.segment_from_tag.rotation * glm::dvec3(0, 0, 1);
      const glm::dvec3 p = tag.segment_from_tag.translation;
      const glm::dvec3 across = glm::cross(along, normal);
      Eigen::Matrix<double, 1, 6> row;
      // Derivative of p . (along x normal) by a rotation of the normal and a translation
      // of p.
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

Eigen::MatrixXd subject_uncertainty(std::span<const Camera> cameras,
                                    const RigCovariance* covariance,
                                    const PlannedBody& body,
                                    const glm::dvec2& floor_m,
                                    const CornerSigma& corner_sigma,
                                    const PlanOptions& options,
                                    const SharedColumns& columns) {
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(columns.count(), columns.count());
  const auto add = [&](const BodyPlace& place, bool stands) {
    const auto views = views_of(cameras, body, place, options);
    const PostureJacobian jacobian = posture_jacobian(body, place);
    FrameInformation frame = information_of(
        cameras, body, place, jacobian, views, corner_sigma, columns, &shared);
    add_posture_prior(posture_prior_rows(place, jacobian, kFitTwistSigma_rad), frame);
    if (stands) {
      const PosturePriorRows upright = standing_prior_rows(place, jacobian);
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
  shared.topLeftCorner<kLengthColumns, kLengthColumns>() += length_information(body);
  add_tag_priors(body, columns, shared);
  const Eigen::LLT<Eigen::MatrixXd> factor(shared.topLeftCorner(own, own));
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(columns.count(), columns.count());
  out.topLeftCorner(own, own) = factor.solve(Eigen::MatrixXd::Identity(own, own));
  const Eigen::MatrixXd own_by_rest = -factor.solve(shared.topRightCorner(own, rest));
  Eigen::MatrixXd uncertainty = Eigen::MatrixXd::Zero(rest, rest);
  uncertainty.diagonal().tail<kBaseColumns>().setConstant(kBaseSigma_m * kBaseSigma_m);
  for (std::size_t row = 0; covariance && row < covariance->size(); ++row) {
    for (std::size_t column = 0; column < covariance->size(); ++column) {
      uncertainty(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          covariance->at(row, column);
    }
  }
  out.topRightCorner(own, rest) = own_by_rest * uncertainty;
  out.bottomLeftCorner(rest, own) = out.topRightCorner(own, rest).transpose();
  out.topLeftCorner(own, own) += out.topRightCorner(own, rest) * own_by_rest.transpose();
  out.bottomRightCorner(rest, rest) = uncertainty;
  return out;
}

}  // namespace marey::calib
