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

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Share of the variance of a corner's error that is the same in all pictures that one
// camera takes of the tag: lens, print and light. A choice: rendered tags that move show
// up to a seventh (docs/measurements.md).
constexpr double kCommonShare = 0.03;

// Skin that slides further per radian is a strap that came loose. [m^2]
constexpr double kMostSlide2 = 0.06 * 0.06;

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

/// The equations of lengths and tags, and of slides once those are free.
struct SlideSystem {
  MatrixXd covariance;   ///< Of lengths and tags, slides held.
  MatrixXd by_slide;     ///< How they follow the slides' equations: H_ss^-1 H_sp.
  MatrixXd information;  ///< On the slides.
  VectorXd gradient;     ///< Of the slides.
};

SlideSystem split(const SubjectSystem& system, int own) {
  const MatrixXd all = system.hessian.selfadjointView<Eigen::Lower>();
  const auto slides = all.rows() - own;
  SlideSystem out;
  MatrixXd subject = all.topLeftCorner(own, own);
  subject.diagonal().array() += 1e-9;
  const Eigen::LDLT<MatrixXd> factor(subject);
  out.covariance = factor.solve(MatrixXd::Identity(own, own));
  out.by_slide = out.covariance * all.topRightCorner(own, slides);
  out.information = all.bottomRightCorner(slides, slides) -
                    all.bottomLeftCorner(slides, own) * out.by_slide;
  out.gradient =
      system.gradient.tail(slides) - out.by_slide.transpose() * system.gradient.head(own);
  return out;
}

/// Variance of the slides, of which the scores along the eigenvectors of their
/// information have the variance `noise` l + v l^2: maximum likelihood by scoring.
double slide_variance(const Eigen::SelfAdjointEigenSolver<MatrixXd>& spectrum,
                      const VectorXd& gradient,
                      double noise) {
  const VectorXd scores = spectrum.eigenvectors().transpose() * gradient;
  double variance = 1e-6;
  for (int round = 0; round < 50; ++round) {
    double excess = 0.0;
    double information = 0.0;
    for (Eigen::Index i = 0; i < scores.size(); ++i) {
      const double l = spectrum.eigenvalues()[i];
      if (l < 1.0) continue;
      const double expected = noise * l + variance * l * l;
      const double rate = l * l / expected;
      excess += rate * (scores[i] * scores[i] / expected - 1.0);
      information += rate * rate;
    }
    if (information <= 0.0) return 0.0;
    const double next = std::clamp(variance + excess / information, 0.0, kMostSlide2);
    if (std::abs(next - variance) < 1e-3 * variance + 1e-12) return next;
    variance = next;
  }
  return variance;
}

}  // namespace

bool fill_sigmas(SubjectBundle& bundle, std::span<const Camera> cameras) {
  const BundleSolver solver(bundle, cameras, {}, true);
  BundleSolver::Linear linear;
  solver.linearise(bundle, linear);
  SubjectSystem system;
  if (!solver.reduce(linear, 0.0, system)) return false;
  const int own = solver.columns().without_slides();
  const SlideSystem slides = split(system, own);
  const double scale = sigma_scale(bundle);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(slides.information);
  const double variance = slide_variance(spectrum, slides.gradient, scale * scale);
  bundle.slide_m_per_rad = std::sqrt(variance);
  // The slides' own covariance: what the sightings say of them, and their size.
  const VectorXd posterior = (spectrum.eigenvalues().array().max(0.0) / (scale * scale) +
                              1.0 / std::max(variance, 1e-12))
                                 .inverse();
  const MatrixXd by_mode = slides.by_slide * spectrum.eigenvectors();
  const MatrixXd covariance = scale * scale * slides.covariance +
                              by_mode * posterior.asDiagonal() * by_mode.transpose();
  const VectorXd modes =
      -(spectrum.eigenvectors().transpose() * slides.gradient).cwiseProduct(posterior) /
      (scale * scale);
  BundleSolver::Step step;
  step.subject = VectorXd::Zero(solver.columns().size());
  step.subject.head(own) = -by_mode * modes;
  step.postures.assign(bundle.frames.size(), PostureVector::Zero());
  if (!step.subject.allFinite()) return false;
  solver.move(step, bundle);
  const auto variance_of = [&](int i) { return std::max(0.0, covariance(i, i)); };
  for (int i = 0; i < kLengthCount; ++i) {
    bundle.length_sigma_m[static_cast<std::size_t>(i)] = std::sqrt(variance_of(i));
  }
  for (const auto& [tag, pose] : bundle.model.segment_from_tag) {
    const auto rms = [&](int from) {
      return std::sqrt(
          (variance_of(from) + variance_of(from + 1) + variance_of(from + 2)) / 3.0);
    };
    const int column = solver.columns().of_tag(tag);
    bundle.tag_sigma[tag] = {rms(column + 3), rms(column)};
  }
  fill_centre_sigmas(covariance, 1.0, bundle);
  return true;
}

}  // namespace marey::reconstruct
