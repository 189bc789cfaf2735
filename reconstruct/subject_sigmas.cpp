// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "reconstruct/subject_bundle.h"
#include "reconstruct/subject_solve.h"

namespace marey::reconstruct {
namespace {

// Share of the variance of a corner's error that is the same in all pictures that one
// camera takes of the tag: lens, print and light. A choice: rendered tags that move show
// up to a seventh (docs/measurements.md).
constexpr double kCommonShare = 0.03;

// The median length of a two-dimensional error whose coordinates have unit sigma.
constexpr double kMedianOfUnitNoise = 1.177;

/// By how much sigmas are too small: residuals may be larger than expected, and many
/// sightings of one tag by one camera are not as many independent ones.
double sigma_scale(const SubjectBundle& bundle) {
  double sum_px = 0.0;
  double count = 0.0;
  std::map<std::pair<std::size_t, CameraId>, double> repeated;
  for (const BundleFrame& frame : bundle.frames) {
    for (const TagSighting& s : frame.sightings) {
      sum_px += s.detection->sigma_px;
      count += 1.0;
      repeated[{s.tag, s.camera}] += 1.0;
    }
  }
  if (count == 0.0) return 1.0;
  // The design effect of cluster sampling (Kish 1965, 5.4).
  double squares = 0.0;
  for (const auto& [pair, times] : repeated) squares += times * times;
  const double effect = 1.0 + (squares / count - 1.0) * kCommonShare;
  return std::sqrt(effect) *
         std::max(1.0, bundle.median_px * count / (kMedianOfUnitNoise * sum_px));
}

/// How a joint centre moves against the tags of `side`, over the subject's unknowns: the
/// mean over these tags, in the bone's axes. `offset` is the joint's place on the bone.
/// nullopt without tags.
std::optional<Eigen::MatrixXd> centre_jacobian(const SubjectBundle& bundle,
                                               HumanBone side,
                                               const glm::dvec3& offset,
                                               const Eigen::MatrixXd& offset_jacobian) {
  Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Zero(offset_jacobian.rows(), offset_jacobian.cols());
  int tags = 0;
  int column = kLengthCount;
  for (const auto& [tag, pose] : bundle.model.segment_from_tag) {
    if (bundle.model.bone(tag) == side) {
      const glm::dvec3 arm = offset - pose.translation;
      Eigen::Matrix3d cross;
      cross << 0.0, -arm.z, arm.y, arm.z, 0.0, -arm.x, -arm.y, arm.x, 0.0;
      jacobian += offset_jacobian;
      // -turn x arm = arm x turn, the turn being in the segment's frame.
      jacobian.middleCols<3>(column) += cross;
      jacobian.middleCols<3>(column + 3) -= Eigen::Matrix3d::Identity();
      ++tags;
    }
    column += 6;
  }
  if (tags == 0) return std::nullopt;
  return jacobian / tags;
}

void fill_centre_sigmas(const Eigen::MatrixXd& covariance,
                        double scale,
                        SubjectBundle& bundle) {
  const Lengths& lengths = bundle.model.lengths;
  const auto offset_of = [&](const Lengths& some, HumanBone bone) {
    return to_proportions(some, bundle.model.body, Proportions{})[bone];
  };
  const auto columns = covariance.cols();
  for (const HumanBone bone : human_bones()) {
    std::optional<double>& least = bundle.centre_sigma_m[index(bone)];
    const auto look = [&](HumanBone side,
                          const glm::dvec3& offset,
                          const Eigen::MatrixXd& offset_jacobian) {
      const auto j = centre_jacobian(bundle, side, offset, offset_jacobian);
      if (!j) return;
      const double trace = (*j * covariance * j->transpose()).trace();
      const double sigma_m = scale * std::sqrt(std::max(0.0, trace) / 3.0);
      if (!least || sigma_m < *least) least = sigma_m;
    };
    look(bone, glm::dvec3(0.0), Eigen::MatrixXd::Zero(3, columns));
    if (bone == HumanBone::kHips) continue;
    // Offsets are linear in lengths.
    Eigen::MatrixXd offset_jacobian = Eigen::MatrixXd::Zero(3, columns);
    for (int i = 0; i < kLengthCount; ++i) {
      Lengths longer = lengths;
      longer[static_cast<std::size_t>(i)] += 1.0;
      const glm::dvec3 d = offset_of(longer, bone) - offset_of(lengths, bone);
      offset_jacobian.col(i) = Eigen::Vector3d(d.x, d.y, d.z);
    }
    look(*parent(bone), offset_of(lengths, bone), offset_jacobian);
  }
}

}  // namespace

bool fill_sigmas(SubjectBundle& bundle, std::span<const Camera> cameras) {
  const BundleSolver solver(bundle, cameras, {});
  BundleSolver::Linear linear;
  solver.linearise(bundle, linear);
  SubjectSystem system;
  if (!solver.reduce(linear, 0.0, system)) return false;
  system.hessian.diagonal().array() += 1e-9;
  const Eigen::MatrixXd information = system.hessian.selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd covariance = information.ldlt().solve(
      Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  const double scale = sigma_scale(bundle);
  const auto variance = [&](int i) { return std::max(0.0, covariance(i, i)); };
  for (int i = 0; i < kLengthCount; ++i) {
    bundle.length_sigma_m[static_cast<std::size_t>(i)] = scale * std::sqrt(variance(i));
  }
  for (const auto& [tag, pose] : bundle.model.segment_from_tag) {
    const auto rms = [&](int from) {
      return scale *
             std::sqrt((variance(from) + variance(from + 1) + variance(from + 2)) / 3.0);
    };
    const int column = solver.columns().of_tag(tag);
    bundle.tag_sigma[tag] = {rms(column + 3), rms(column)};
  }
  fill_centre_sigmas(covariance, scale, bundle);
  return true;
}

}  // namespace marey::reconstruct
