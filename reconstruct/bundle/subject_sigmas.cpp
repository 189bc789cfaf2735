// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/subject_sigmas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "reconstruct/bundle/correlated_error_share.h"
#include "reconstruct/bundle/subject_covariance.h"
#include "reconstruct/bundle/subject_solve.h"

namespace marey::reconstruct {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Bounds for a thigh's skin. Above the upper one a strap has come loose. The lower one is
// the apparent slide of firm skin due to the errors of good cameras and clocks in
// simulated sessions.
constexpr double kUsualSlide_m_per_rad = 0.006;
constexpr double kMinSlide_m_per_rad = 0.001;
constexpr double kMaxSlide_m_per_rad = 0.06;

// Median length of a two-dimensional error whose coordinates have unit sigma.
constexpr double kMedianOfUnitNoise = 1.177;

/// Information on some slides, and their gradient, after elimination of all other
/// unknowns.
struct SlideSystem {
  MatrixXd information;
  VectorXd gradient;
};

SlideSystem slides_of(const MatrixXd& all,
                      const VectorXd& gradient,
                      const std::vector<int>& columns) {
  std::vector<int> others;
  for (int column = 0; column < all.rows(); ++column) {
    if (!std::ranges::binary_search(columns, column)) others.push_back(column);
  }
  const MatrixXd cross = all(others, columns);
  const Eigen::LDLT<MatrixXd> subject(all(others, others));
  const MatrixXd by_slide = subject.solve(cross);
  return {all(columns, columns) - cross.transpose() * by_slide,
          gradient(columns) - by_slide.transpose() * gradient(others)};
}

/// A variance and the Fisher information on it.
struct Variance {
  double value = 0.0;
  double information = 0.0;
};

/// Estimates the variance v of the slides' rates by maximum likelihood with scoring. The
/// scores along the eigenvectors of their information l have the variance noise l + v
/// l^2.
Variance slide_variance(const SlideSystem& slides, double noise) {
  constexpr double kMax = kMaxSlide_m_per_rad * kMaxSlide_m_per_rad;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(slides.information);
  const VectorXd scores = spectrum.eigenvectors().transpose() * slides.gradient;
  Variance variance{1e-6, 0.0};
  for (int round = 0; round < 50; ++round) {
    double excess = 0.0;
    double information = 0.0;
    for (Eigen::Index i = 0; i < scores.size(); ++i) {
      const double l = spectrum.eigenvalues()[i];
      if (l < 1.0) continue;
      const double expected = noise * l + variance.value * l * l;
      const double rate = l * l / expected;
      excess += rate * (scores[i] * scores[i] / expected - 1.0);
      information += rate * rate;
    }
    variance.information = 0.5 * information;
    if (information <= 0.0) return {};
    const double next = std::clamp(variance.value + excess / information, 0.0, kMax);
    const bool is_last = std::abs(next - variance.value) < 1e-3 * variance.value + 1e-12;
    variance.value = next;
    if (is_last) break;
  }
  return variance;
}

/// The subject's equations as the sum over parts of the trials.
struct Parts {
  SubjectSystem system;
  MatrixXd gradients;  ///< One column per part.
};

std::optional<Parts> in_parts(const SubjectBundle& bundle,
                              const BundleSolver& solver,
                              BundleSolver::Linear& linear) {
  // Enough for a scatter, and each long enough for an exercise of its own.
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

/// Sets each tag's mean angles over its sightings, and a slide of zero.
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

/// Returns the columns of the slides of one group's tags, or of all, in ascending order.
std::vector<int> slide_columns(const SubjectBundle& bundle,
                               const SubjectColumns& columns,
                               std::optional<SlideGroup> group) {
  std::vector<int> out;
  for (const auto& [tag, slide] : bundle.slides) {
    if (group && slide_group(bundle.model.bone(tag)) != *group) continue;
    for (int i = 0; i < kSlideColumns; ++i) out.push_back(*columns.of_slide(tag) + i);
  }
  std::ranges::sort(out);
  return out;
}

using SlideSizes = std::array<double, kSlideGroups>;

/// Estimates the slide of skin per radian. Errors common to all sightings of one tag by
/// one camera are ignored: slides count from the tag's mean angles. A group with little
/// information on its slides gets the value of the others. Returns the present values if
/// the equations have no solution.
SlideSizes estimated_slides_m_per_rad(const SubjectBundle& bundle,
                                      std::span<const Camera> cameras) {
  const BundleSolver solver(bundle, cameras, {});
  BundleSolver::Linear linear;
  solver.linearise(bundle, linear);
  SubjectSystem system;
  if (!solver.reduce(linear, 0.0, system)) return bundle.slide_m_per_rad;
  MatrixXd all = system.hessian.selfadjointView<Eigen::Lower>();
  all.diagonal().array() += 1e-9;
  const double noise = stray2(bundle);
  VectorXd rates = VectorXd::Zero(all.rows());
  for (const auto& [tag, slide] : bundle.slides) {
    for (int i = 0; i < kSlideColumns; ++i) {
      rates[*solver.columns().of_slide(tag) + i] = slide.rate(i % 3, i / 3);
    }
  }
  const auto variance_of = [&](std::optional<SlideGroup> group) {
    // Without the prior of these slides, and with a slide of zero.
    MatrixXd free = all;
    VectorXd gradient = system.gradient;
    const std::vector<int> columns = slide_columns(bundle, solver.columns(), group);
    if (columns.empty()) return Variance{};
    for (const auto& [tag, slide] : bundle.slides) {
      const SlideGroup own = slide_group(bundle.model.bone(tag));
      if (group && own != *group) continue;
      const double size = bundle.slide_m_per_rad[static_cast<std::size_t>(own)];
      const double prior = bundle.prior_weight / (size * size);
      for (int i = 0; i < kSlideColumns; ++i) {
        const int column = *solver.columns().of_slide(tag) + i;
        free(column, column) -= prior;
        gradient[column] -= prior * rates[column];
      }
    }
    SlideSystem slides = slides_of(free, gradient, columns);
    slides.gradient -= slides.information * rates(columns);
    return slide_variance(slides, noise);
  };
  constexpr double kMin2 = kMinSlide_m_per_rad * kMinSlide_m_per_rad;
  const double usual = std::max(kMin2, variance_of(std::nullopt).value);
  SlideSizes sizes{};
  for (std::size_t group = 0; group < kSlideGroups; ++group) {
    // The groups' variances scatter around the common one by its own size.
    const Variance own = variance_of(static_cast<SlideGroup>(group));
    const double prior = 1.0 / (usual * usual);
    const double variance =
        (own.information * own.value + prior * usual) / (own.information + prior);
    sizes[group] =
        std::clamp(std::sqrt(variance), kMinSlide_m_per_rad, kMaxSlide_m_per_rad);
  }
  return sizes;
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
  const double effect = 1.0 + (squares / count - 1.0) * bundle.correlated_error_share;
  return effect * stray2(bundle);
}

bool refine_slides(SubjectBundle& bundle, std::span<const Camera> cameras) {
  constexpr int kIterations = 4;
  begin_slides(bundle);
  bundle.correlated_error_share = estimate_correlated_error_share(bundle, cameras);
  bundle.prior_weight = variance_scale(bundle);
  bundle.slide_m_per_rad.fill(kUsualSlide_m_per_rad);
  for (int round = 0; round < 2; ++round) {
    if (!adjust(bundle, cameras, kIterations)) return false;
    bundle.slide_m_per_rad = estimated_slides_m_per_rad(bundle, cameras);
  }
  return adjust(bundle, cameras, kIterations).has_value();
}

bool fill_sigmas(SubjectBundle& bundle, std::span<const Camera> cameras) {
  const BundleSolver solver(bundle, cameras, {});
  BundleSolver::Linear linear;
  solver.linearise(bundle, linear);
  const auto parts = in_parts(bundle, solver, linear);
  if (!parts) return false;
  const int size = solver.columns().size();
  MatrixXd all = parts->system.hessian.selfadjointView<Eigen::Lower>();
  all.diagonal().array() += 1e-9;
  all /= bundle.prior_weight;
  const std::optional<SubjectCovariance> subject = subject_covariance(
      all,
      parts->gradients / bundle.prior_weight,
      limb_root_gradients(bundle, solver.columns(), linear.frames) / bundle.prior_weight);
  if (!subject) return false;
  const auto variance_of = [&](int first, int count) {
    MatrixXd jacobian = MatrixXd::Zero(count, size);
    jacobian.middleCols(first, count).setIdentity();
    return std::max(0.0, subject->covariance_of(jacobian).trace()) / count;
  };
  for (int i = 0; i < kLengthCount; ++i) {
    bundle.length_sigma_m[static_cast<std::size_t>(i)] = std::sqrt(variance_of(i, 1));
  }
  for (const auto& [tag, pose] : bundle.model.segment_from_tag) {
    const int column = *solver.columns().of_tag(tag);
    bundle.tag_sigma[tag] = {std::sqrt(variance_of(column + 3, 3)),
                             std::sqrt(variance_of(column, 3))};
  }
  fill_centre_sigmas(*subject, solver.columns(), linear.frames, bundle);
  return true;
}

}  // namespace marey::reconstruct
