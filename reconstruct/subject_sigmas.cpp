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

/// What the bundle's equations say of its unknowns, and how far apart what it says in
/// different parts of the trials is.
struct Knowledge {
  MatrixXd covariance;  ///< Of lengths and tags.
  MatrixXd moves;       ///< Of lengths and tags, by each part's equations alone.

  /// Of a linear function of them: what the covariance makes of it, or the scatter of the
  /// parts where that is surely larger (White 1982: a model that is not quite right makes
  /// residuals that go together, and its covariance too small).
  [[nodiscard]] double variance(const MatrixXd& jacobian) const {
    const double model = (jacobian * covariance * jacobian.transpose()).trace();
    const double parts = static_cast<double>(moves.cols());
    const double scatter = (jacobian * moves).squaredNorm() * parts / (parts - 1.0);
    // Two standard deviations of a mean of three squares from twelve parts.
    constexpr double kSurely = 1.5;
    return std::max(0.0, scatter > kSurely * model ? scatter : model);
  }
};

void fill_centre_sigmas(const Knowledge& knowledge, SubjectBundle& bundle) {
  const Lengths& lengths = bundle.model.lengths;
  const auto offset_of = [&](const Lengths& some, HumanBone bone) {
    return to_proportions(some, bundle.model.body, Proportions{})[bone];
  };
  const auto columns = knowledge.covariance.cols();
  for (const HumanBone bone : human_bones()) {
    std::optional<double>& least = bundle.centre_sigma_m[index(bone)];
    const auto look =
        [&](HumanBone side, const glm::dvec3& offset, const MatrixXd& offset_jacobian) {
          const auto j = centre_jacobian(bundle, side, offset, offset_jacobian);
          if (!j) return;
          const double sigma_m = std::sqrt(knowledge.variance(*j) / 3.0);
          if (!least || sigma_m < *least) least = sigma_m;
        };
    look(bone, glm::dvec3(0.0), MatrixXd::Zero(3, columns));
    if (bone == HumanBone::kHips) continue;
    // Offsets are linear in lengths.
    MatrixXd offset_jacobian = MatrixXd::Zero(3, columns);
    for (int i = 0; i < kLengthCount; ++i) {
      Lengths longer = lengths;
      longer[static_cast<std::size_t>(i)] += 1.0;
      const glm::dvec3 d = offset_of(longer, bone) - offset_of(lengths, bone);
      offset_jacobian.col(i) = Eigen::Vector3d(d.x, d.y, d.z);
    }
    look(*parent(bone), offset_of(lengths, bone), offset_jacobian);
  }
}

/// Information on the slides, and their gradient, once lengths and tags are free.
struct SlideSystem {
  MatrixXd information;
  VectorXd gradient;
};

SlideSystem slides_of(const MatrixXd& all, const VectorXd& gradient, int own) {
  const auto slides = all.rows() - own;
  const Eigen::LDLT<MatrixXd> subject(all.topLeftCorner(own, own));
  const MatrixXd by_slide = subject.solve(all.topRightCorner(own, slides));
  return {all.bottomRightCorner(slides, slides) -
              all.bottomLeftCorner(slides, own) * by_slide,
          gradient.tail(slides) - by_slide.transpose() * gradient.head(own)};
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

/// The subject's equations as the sum of what each part of the trials says.
struct Parts {
  SubjectSystem system;
  MatrixXd gradients;  ///< One column per part.
};

std::optional<Parts> in_parts(const SubjectBundle& bundle,
                              const BundleSolver& solver,
                              BundleSolver::Linear& linear) {
  // Enough to see a scatter, and each long enough to hold an exercise of its own.
  constexpr std::size_t kParts = 12;
  Parts out;
  out.system = linear.subject;
  out.gradients.setZero(solver.columns().size(), kParts + 1);
  const auto standing = static_cast<std::size_t>(
      std::count_if(bundle.frames.begin(), bundle.frames.end(), [](const auto& frame) {
        return frame.standing;
      }));
  const std::size_t moving = std::max<std::size_t>(1, bundle.frames.size() - standing);
  std::size_t moved = 0;
  VectorXd gradient;
  for (std::size_t f = 0; f < linear.frames.size(); ++f) {
    gradient.setZero(solver.columns().size());
    if (!linear.frames[f].eliminate(0.0, out.system.hessian, gradient)) {
      return std::nullopt;
    }
    const std::size_t part =
        bundle.frames[f].standing ? kParts : kParts * moved++ / moving;
    out.gradients.col(static_cast<Eigen::Index>(part)) += gradient;
    out.system.gradient += gradient;
  }
  return out;
}

}  // namespace

bool fill_sigmas(SubjectBundle& bundle, std::span<const Camera> cameras) {
  const BundleSolver solver(bundle, cameras, {}, true);
  BundleSolver::Linear linear;
  solver.linearise(bundle, linear);
  const auto parts = in_parts(bundle, solver, linear);
  if (!parts) return false;
  const int own = solver.columns().without_slides();
  const int size = solver.columns().size();
  MatrixXd all = parts->system.hessian.selfadjointView<Eigen::Lower>();
  all.diagonal().array() += 1e-9;
  const double scale = sigma_scale(bundle);
  const double scale2 = scale * scale;
  const SlideSystem slides = slides_of(all, parts->system.gradient, own);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(slides.information);
  const double slide2 = slide_variance(spectrum, slides.gradient, scale2);
  bundle.slide_m_per_rad = std::sqrt(slide2);
  all /= scale2;
  all.diagonal().tail(size - own).array() += 1.0 / std::max(slide2, 1e-12);
  const MatrixXd inverse = all.ldlt().solve(MatrixXd::Identity(size, size)).topRows(own);
  const Knowledge knowledge{inverse.leftCols(own), inverse * parts->gradients / scale2};
  BundleSolver::Step step;
  step.subject = VectorXd::Zero(size);
  step.subject.head(own) =
      -inverse.rightCols(size - own) * parts->system.gradient.tail(size - own) / scale2;
  step.postures.assign(bundle.frames.size(), PostureVector::Zero());
  if (!step.subject.allFinite()) return false;
  solver.move(step, bundle);
  const auto variance_of = [&](int first, int count) {
    MatrixXd jacobian = MatrixXd::Zero(count, own);
    jacobian.middleCols(first, count).setIdentity();
    return knowledge.variance(jacobian) / count;
  };
  for (int i = 0; i < kLengthCount; ++i) {
    bundle.length_sigma_m[static_cast<std::size_t>(i)] = std::sqrt(variance_of(i, 1));
  }
  for (const auto& [tag, pose] : bundle.model.segment_from_tag) {
    const int column = solver.columns().of_tag(tag);
    bundle.tag_sigma[tag] = {std::sqrt(variance_of(column + 3, 3)),
                             std::sqrt(variance_of(column, 3))};
  }
  fill_centre_sigmas(knowledge, bundle);
  return true;
}

}  // namespace marey::reconstruct
