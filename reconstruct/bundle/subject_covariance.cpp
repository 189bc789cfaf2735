// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/subject_covariance.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "reconstruct/posture/point_sigma.h"
#include "reconstruct/posture/posture_steps.h"

namespace marey::reconstruct {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Two standard deviations of a mean of three squares from twelve parts.
constexpr double kSurely = 1.5;
// Enough postures of an exercise for a mean over them.
constexpr std::size_t kFrames = 16;

/// The covariance of a linear function, by both methods.
struct BothCovariances {
  MatrixXd model;
  MatrixXd scatter;

  void add(const MatrixXd& jacobian, const SubjectCovariance& subject) {
    model += jacobian * subject.covariance * jacobian.transpose();
    const double parts = static_cast<double>(subject.part_solutions.cols());
    const MatrixXd moved = jacobian * subject.part_solutions;
    scatter += moved * moved.transpose() * (parts / (parts - 1.0));
  }
  [[nodiscard]] const MatrixXd& better() const {
    return scatter.trace() > kSurely * model.trace() ? scatter : model;
  }
};

BothCovariances no_covariance(Eigen::Index size) {
  return {MatrixXd::Zero(size, size), MatrixXd::Zero(size, size)};
}

bool has_tags(const SubjectBundle& bundle, HumanBone bone) {
  return std::ranges::any_of(bundle.model.segment_from_tag, [&](const auto& placed) {
    return bundle.model.bone(placed.first) == bone;
  });
}

/// Returns the frames of the moving trial that show the bone; all of them if it has no
/// tags.
std::vector<std::size_t> frames_of(const SubjectBundle& bundle, HumanBone bone) {
  const bool is_tagged = has_tags(bundle, bone);
  std::vector<std::size_t> frames;
  for (std::size_t f = 0; f < bundle.frames.size(); ++f) {
    const BundleFrame& frame = bundle.frames[f];
    const bool shows = std::ranges::any_of(frame.sightings, [&](const TagSighting& s) {
      return bundle.model.bone(s.tag) == bone && bundle.model.place(s.tag);
    });
    if (!frame.standing && (shows || !is_tagged)) frames.push_back(f);
  }
  std::vector<std::size_t> some;
  const std::size_t n = std::min(frames.size(), kFrames);
  for (std::size_t i = 0; i < n; ++i) {
    some.push_back(frames[(2 * i + 1) * frames.size() / (2 * n)]);
  }
  return some;
}

/// Returns the rates of all slides, in the order of their columns.
VectorXd slide_rates(const SubjectBundle& bundle, const SubjectColumns& columns) {
  VectorXd rates = VectorXd::Zero(columns.size() - columns.without_slides());
  for (const auto& [tag, slide] : bundle.slides) {
    for (int i = 0; i < kSlideColumns; ++i) {
      rates[*columns.of_slide(tag) + i - columns.without_slides()] =
          slide.rate(i % 3, i / 3);
    }
  }
  return rates;
}

}  // namespace

MatrixXd SubjectCovariance::covariance_of(const MatrixXd& jacobian) const {
  BothCovariances both = no_covariance(jacobian.rows());
  both.add(jacobian, *this);
  return both.better();
}

std::optional<SubjectCovariance> subject_covariance(const MatrixXd& normal,
                                                    const MatrixXd& gradients,
                                                    const MatrixXd& common) {
  const Eigen::LLT<MatrixXd> factor(normal);
  if (factor.info() != Eigen::Success) return std::nullopt;
  SubjectCovariance subject;
  subject.covariance = factor.solve(MatrixXd::Identity(normal.rows(), normal.cols()));
  subject.part_solutions = factor.solve(gradients);
  const MatrixXd shared = factor.solve(common);
  subject.covariance += shared * shared.transpose();
  if (!subject.covariance.allFinite()) return std::nullopt;
  return subject;
}

MatrixXd limb_root_gradients(const SubjectBundle& bundle,
                             const SubjectColumns& columns,
                             const std::vector<FrameEquations>& frames) {
  // Glide of the shoulder's centre. [m/rad]
  constexpr double kShoulderGlide_m = 0.006;
  constexpr int kAngles = 3;
  MatrixXd glides = MatrixXd::Zero(columns.size(), 4 * 3 * kAngles);
  const double hip_m =
      slide_share(HumanBone::kHips) *
      bundle.slide_m_per_rad[static_cast<std::size_t>(SlideGroup::kTrunk)];
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const PoseParameter trunk = limb < 2 ? PoseParameter::kThorax : PoseParameter::kHips;
    const double size_m = limb < 2 ? kShoulderGlide_m : hip_m;
    std::vector<Eigen::Vector3d> turns;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const BundleFrame& frame : bundle.frames) {
      turns.push_back(log_of(quaternion(frame.posture, trunk).conjugate() *
                             quaternion(frame.posture, kLimbParameters[limb].frame)));
      mean += turns.back() / static_cast<double>(bundle.frames.size());
    }
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const Eigen::Matrix3d world_from_trunk =
          quaternion(bundle.frames[f].posture, trunk).toRotationMatrix();
      MatrixXd rows = MatrixXd::Zero(3, columns.size());
      frames[f].add_root_shift(limb, size_m * world_from_trunk, rows);
      for (int angle = 0; angle < kAngles; ++angle) {
        const auto first = 3 * (kAngles * static_cast<Eigen::Index>(limb) + angle);
        glides.middleCols(first, 3) += (turns[f][angle] - mean[angle]) * rows.transpose();
      }
    }
  }
  return glides;
}

void fill_centre_sigmas(const SubjectCovariance& subject,
                        const SubjectColumns& columns,
                        const std::vector<FrameEquations>& frames,
                        SubjectBundle& bundle) {
  const VectorXd rates = slide_rates(bundle, columns);
  UnfoldedPosture unfolded;
  SparseDerivative by_posture;
  SparseDerivative by_shape;
  for (const HumanBone joint : human_bones()) {
    const HumanBone bone = solved_segment(joint);
    const auto up = parent(bone);
    bundle.centre_sigma_m[index(joint)].reset();
    if (!has_tags(bundle, bone) && !(up && has_tags(bundle, *up))) continue;
    const std::vector<std::size_t> chosen = frames_of(bundle, bone);
    if (chosen.empty()) continue;
    BothCovariances sum = no_covariance(3);
    Eigen::Matrix3d slid = Eigen::Matrix3d::Zero();
    for (const std::size_t f : chosen) {
      unfolded.unfold(bundle.frames[f].posture, bundle.model.lengths, bundle.model.body);
      unfolded.derivative(bone, unfolded.origin(bone), by_posture);
      unfolded.shape_derivative(bone, unfolded.origin(bone), by_shape);
      MatrixXd jacobian = MatrixXd::Zero(3, columns.size());
      frames[f].add_response(by_posture, by_shape, jacobian);
      sum.add(jacobian, subject);
      // Motions are solved without slides.
      const Eigen::Vector3d slide = jacobian.rightCols(rates.size()) * rates;
      slid += slide * slide.transpose();
    }
    const Eigen::Matrix3d covariance =
        (sum.better() + slid) / static_cast<double>(chosen.size());
    bundle.centre_sigma_m[index(joint)] = point_sigma_m(covariance);
  }
}

}  // namespace marey::reconstruct
