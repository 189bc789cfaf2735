// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "reconstruct/common_error.h"
#include "reconstruct/point_sigma.h"
#include "reconstruct/subject_bundle.h"
#include "reconstruct/subject_solve.h"

namespace marey::reconstruct {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of a thigh's skin. More is a strap that came loose. The least is what firm skin and the
// errors of good cameras and clocks show in simulated sessions.
constexpr double kUsualSlide_m_per_rad = 0.006;
constexpr double kLeastSlide_m_per_rad = 0.001;
constexpr double kMostSlide_m_per_rad = 0.06;

// The median length of a two-dimensional error whose coordinates have unit sigma.
constexpr double kMedianOfUnitNoise = 1.177;

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
  int column = kShapeCount;
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

  /// Returns the covariance of a linear function of them: the model's, or the scatter of
  /// the parts where its trace is clearly larger (White 1982: a model that is not quite
  /// right makes residuals that go together, and its covariance too small).
  [[nodiscard]] MatrixXd covariance_of(const MatrixXd& jacobian) const {
    const MatrixXd model = jacobian * covariance * jacobian.transpose();
    const double parts = static_cast<double>(moves.cols());
    const MatrixXd moved = jacobian * moves;
    const MatrixXd scatter = moved * moved.transpose() * (parts / (parts - 1.0));
    // Two standard deviations of a mean of three squares from twelve parts.
    constexpr double kSurely = 1.5;
    return scatter.trace() > kSurely * model.trace() ? scatter : model;
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
          const double sigma_m = point_sigma_m(knowledge.covariance_of(*j));
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

/// Variance v of the slides' rates, of which the scores along the eigenvectors of their
/// information l have the variance noise l + v l^2: maximum likelihood by scoring.
double slide_variance(const Eigen::SelfAdjointEigenSolver<MatrixXd>& spectrum,
                      const VectorXd& gradient,
                      double noise) {
  constexpr double kMost = kMostSlide_m_per_rad * kMostSlide_m_per_rad;
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
    const double next = std::clamp(variance + excess / information, 0.0, kMost);
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

/// Sets each tag's mean angles over its sightings, and no slide.
void begin_slides(SubjectBundle& bundle) {
  bundle.slides.clear();
  std::map<std::size_t, double> counts;
  for (const auto& [tag, place] : bundle.model.segment_from_tag) {
    bundle.slides[tag].share = slide_share(bundle.model.bone(tag));
  }
  UnfoldedPosture unfolded;
  for (const BundleFrame& frame : bundle.frames) {
    unfolded.unfold(frame.posture, bundle.model.lengths, bundle.model.body);
    for (const TagSighting& s : frame.sightings) {
      const auto slide = bundle.slides.find(s.tag);
      if (slide == bundle.slides.end()) continue;
      const SlideAngles angles =
          slide_angles(bundle.model.bone(s.tag), frame.posture, unfolded);
      for (std::size_t i = 0; i < angles.size(); ++i) slide->second.mean[i] += angles[i];
      counts[s.tag] += 1.0;
    }
  }
  for (auto& [tag, slide] : bundle.slides) {
    for (double& angle : slide.mean) angle /= std::max(1.0, counts[tag]);
  }
}

/// Returns the variance of corner errors over the claimed variance, at least 1.
/// Precondition: measure().
double stray2(const SubjectBundle& bundle) {
  double sum_px = 0.0;
  double count = 0.0;
  for (const BundleFrame& frame : bundle.frames) {
    for (const TagSighting& s : frame.sightings) {
      sum_px += s.detection->sigma_px;
      count += 1.0;
    }
  }
  if (count == 0.0) return 1.0;
  const double stray =
      std::max(1.0, bundle.median_px * count / (kMedianOfUnitNoise * sum_px));
  return stray * stray;
}

/// Estimates how far skin slides per radian. Errors common to all sightings of one tag by
/// one camera are ignored: slides count from the tag's mean angles. Returns the present
/// value if the equations have no solution.
double estimated_slide_m_per_rad(const SubjectBundle& bundle,
                                 std::span<const Camera> cameras) {
  const BundleSolver solver(bundle, cameras, {});
  BundleSolver::Linear linear;
  solver.linearise(bundle, linear);
  SubjectSystem system;
  if (!solver.reduce(linear, 0.0, system)) return bundle.slide_m_per_rad;
  const int own = solver.columns().without_slides();
  MatrixXd all = system.hessian.selfadjointView<Eigen::Lower>();
  all.diagonal().array() += 1e-9;
  // Without the slides' own prior, and as if nothing slid.
  const double prior =
      bundle.prior_weight / (bundle.slide_m_per_rad * bundle.slide_m_per_rad);
  VectorXd rates = VectorXd::Zero(all.rows() - own);
  for (const auto& [tag, slide] : bundle.slides) {
    for (int i = 0; i < kSlideColumns; ++i) {
      rates[solver.columns().of_slide(tag) + i - own] = slide.rate(i % 3, i / 3);
    }
  }
  all.diagonal().tail(rates.size()).array() -= prior;
  system.gradient.tail(rates.size()) -= prior * rates;
  SlideSystem slides = slides_of(all, system.gradient, own);
  slides.gradient -= slides.information * rates;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(slides.information);
  const double variance = slide_variance(spectrum, slides.gradient, stray2(bundle));
  return std::clamp(std::sqrt(variance), kLeastSlide_m_per_rad, kMostSlide_m_per_rad);
}

}  // namespace

double variance_scale(const SubjectBundle& bundle) {
  double count = 0.0;
  std::map<std::pair<std::size_t, CameraId>, double> repeated;
  for (const BundleFrame& frame : bundle.frames) {
    for (const TagSighting& s : frame.sightings) {
      count += 1.0;
      repeated[{s.tag, s.camera}] += 1.0;
    }
  }
  if (count == 0.0) return 1.0;
  // The design effect of cluster sampling (Kish 1965, 5.4).
  double squares = 0.0;
  for (const auto& [pair, times] : repeated) squares += times * times;
  const double effect = 1.0 + (squares / count - 1.0) * bundle.common_share;
  return effect * stray2(bundle);
}

bool refine_slides(SubjectBundle& bundle, std::span<const Camera> cameras) {
  constexpr int kIterations = 4;
  begin_slides(bundle);
  bundle.common_share = estimated_common_share(bundle, cameras);
  bundle.prior_weight = variance_scale(bundle);
  bundle.slide_m_per_rad = kUsualSlide_m_per_rad;
  for (int round = 0; round < 2; ++round) {
    if (!adjust(bundle, cameras, kIterations)) return false;
    bundle.slide_m_per_rad = estimated_slide_m_per_rad(bundle, cameras);
  }
  return adjust(bundle, cameras, kIterations).has_value();
}

bool fill_sigmas(SubjectBundle& bundle, std::span<const Camera> cameras) {
  const BundleSolver solver(bundle, cameras, {});
  BundleSolver::Linear linear;
  solver.linearise(bundle, linear);
  const auto parts = in_parts(bundle, solver, linear);
  if (!parts) return false;
  const int own = solver.columns().without_slides();
  const int size = solver.columns().size();
  MatrixXd all = parts->system.hessian.selfadjointView<Eigen::Lower>();
  all.diagonal().array() += 1e-9;
  all /= bundle.prior_weight;
  const MatrixXd inverse = all.ldlt().solve(MatrixXd::Identity(size, size)).topRows(own);
  if (!inverse.allFinite()) return false;
  const Knowledge knowledge{inverse.leftCols(own),
                            inverse * parts->gradients / bundle.prior_weight};
  const auto variance_of = [&](int first, int count) {
    MatrixXd jacobian = MatrixXd::Zero(count, own);
    jacobian.middleCols(first, count).setIdentity();
    return std::max(0.0, knowledge.covariance_of(jacobian).trace()) / count;
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
