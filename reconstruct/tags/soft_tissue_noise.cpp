// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/soft_tissue_noise.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

namespace marey::reconstruct {
namespace {

// Limit on one sighting's squares, relative to their expectation: outliers are not slip.
constexpr double kMaxSquares = 9.0;
// Prior of a segment's slip: that of all segments, with the weight of this many
// sightings.
constexpr double kPriorSightings = 20.0;

}  // namespace

TagSlip tag_slip(const BodyModel& model,
                 const TagSighting& sighting,
                 std::span<const Camera> cameras,
                 const Posture& posture,
                 double sigma_m,
                 double cameras_that_see_it) {
  TagSlip slip;
  const RigidTransform* segment_from_tag = model.place(sighting.tag);
  if (!segment_from_tag) return slip;
  const Camera& camera = cameras[index(sighting.camera)];
  const RigidTransform world_from_tag =
      world_from_bone(model.bone(sighting.tag), posture, model.lengths, model.body) *
      *segment_from_tag;
  constexpr double kStepM = 1e-4;
  Eigen::Matrix<double, 8, 3> per_metre;
  for (int corner = 0; corner < 4; ++corner) {
    const glm::dvec3 p =
        world_from_tag * corner_in_tag(corner, model.tags[sighting.tag].size_m);
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = kStepM;
      const auto ahead = project(camera, p + step);
      const auto behind = project(camera, p - step);
      if (!ahead || !behind) return slip;
      const glm::dvec2 speed =
          (*ahead - *behind) / (2.0 * kStepM * sighting.detection->sigma_px);
      per_metre(2 * corner, axis) = speed.x;
      per_metre(2 * corner + 1, axis) = speed.y;
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(per_metre, Eigen::ComputeThinU);
  slip.directions = svd.matrixU();
  slip.gains = svd.singularValues();
  slip.sigma_m = sigma_m;
  slip.cameras = cameras_that_see_it;
  return slip;
}

void SlipEstimate::add(HumanBone bone,
                       const TagSlip& slip,
                       const Eigen::Matrix<double, 8, 1>& residuals,
                       const Eigen::Matrix<double, 8, Eigen::Dynamic>& jacobian,
                       const Eigen::MatrixXd& covariance) {
  // The part that the posture does not absorb.
  const Eigen::Matrix<double, 8, 8> kept = Eigen::Matrix<double, 8, 8>::Identity() -
                                           jacobian * covariance * jacobian.transpose();
  const double freedom = std::max(0.0, kept.trace());
  freedom_ += freedom;
  squares_ += std::min(residuals.squaredNorm(), kMaxSquares * freedom);
  if (slip.gains.isZero()) return;
  const Eigen::Matrix<double, 8, 3> per_metre =
      slip.directions * (slip.gains.array() / slip.stretch()).matrix().asDiagonal();
  const Eigen::Matrix3d information = per_metre.transpose() * kept * per_metre;
  // Below unit variance if several cameras see one slip.
  const double expected =
      information.trace() -
      ((slip.gains.array() / slip.stretch()).square() * (1.0 - slip.explained())).sum();
  if (!(expected > 0.0)) return;
  const double squares = (per_metre.transpose() * residuals).squaredNorm();
  Sums& sums = sums_[index(bone)];
  sums.excess += std::min(squares, kMaxSquares * expected) - expected;
  sums.information += information.squaredNorm();
  ++sums.count;
}

SlipSigmas SlipEstimate::improved(const SlipSigmas& sigmas_m) const {
  Sums all;
  double weighted_m2 = 0.0;
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    all.excess += sums_[b].excess;
    all.information += sums_[b].information;
    all.count += sums_[b].count;
    weighted_m2 += sums_[b].information * sigmas_m[b] * sigmas_m[b];
  }
  if (all.count == 0 || !(all.information > 0.0)) return sigmas_m;
  const double usual_m2 = std::max(0.0, (weighted_m2 + all.excess) / all.information);
  const double prior = kPriorSightings * all.information / all.count;
  SlipSigmas better{};
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    const double was_m2 = sigmas_m[b] * sigmas_m[b];
    const double step_m2 =
        (sums_[b].excess + prior * (usual_m2 - was_m2)) / (sums_[b].information + prior);
    better[b] = std::sqrt(std::max(0.0, was_m2 + step_m2));
  }
  return better;
}

double SlipEstimate::scale() const {
  return freedom_ > 0.0 ? std::max(1.0, std::sqrt(squares_ / freedom_)) : 1.0;
}

}  // namespace marey::reconstruct
