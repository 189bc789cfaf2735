// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject_bundle.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "core/assert.h"
#include "core/quantile.h"
#include "reconstruct/length_terms.h"
#include "reconstruct/normal_matrix.h"
#include "reconstruct/posture_terms.h"

namespace marey::reconstruct {
namespace {

// Over a range-of-motion trial, elbows bend about one axis of the arm's skin; what turns
// about the bone would otherwise hide where along that axis the elbow lies.
constexpr TwistHabits kTrialTwists{0.1, 0.1, 0.08};

// The median length of a two-dimensional error whose coordinates have unit sigma.
constexpr double kMedianOfUnitNoise = 1.177;

/// A tag on a limb faces away from its bone: the line through its middle and along its
/// normal passes the bone's axis nearby. Without this an elbow that only bends could lie
/// anywhere along its hinge.
struct FacesBonePrior {
  glm::dvec3 along;
  double sigma_m;

  template <class T>
  bool operator()(const T* rotation, const T* place, T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Eigen::Quaternion<T>> q(rotation);
    const Vector normal = q * Vector(T(0), T(0), T(1));
    const Vector across = detail::vec<T>(along).cross(normal);
    const Vector p = Eigen::Map<const Vector>(place);
    // A tag that faces along the bone says nothing.
    const T sine = across.norm() + T(0.05);
    residual[0] = p.dot(across) / (sine * sigma_m);
    return true;
  }
};

void add_tag_priors(SubjectBundle& bundle, ceres::Problem& problem) {
  for (auto& [tag, pose] : bundle.model.segment_from_tag) {
    for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
      const HumanBone bone = bundle.model.bone(tag);
      if (bone != human_limbs()[limb].upper && bone != human_limbs()[limb].lower) {
        continue;
      }
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<FacesBonePrior, 1, 4, 3>(
                                   new FacesBonePrior{limb_axis(limb), 0.02}),
                               nullptr,
                               &pose.rotation.x,
                               &pose.translation.x);
    }
  }
}

void add_sightings(SubjectBundle& bundle,
                   BundleFrame& frame,
                   std::span<const Camera> cameras,
                   ceres::Problem& problem) {
  for (const TagSighting& sighting : frame.sightings) {
    const auto placed = bundle.model.segment_from_tag.find(sighting.tag);
    if (placed == bundle.model.segment_from_tag.end()) continue;
    const TagOnSegment& tag = bundle.model.tags[sighting.tag];
    const HumanBone bone = bundle.model.bone(sighting.tag);
    auto residual = std::make_unique<UnknownTagResidual>(UnknownTagResidual{
        bone,
        slots_of(bone),
        bundle.model.body,
        tag_image(cameras[index(sighting.camera)], *sighting.detection),
        tag.size_m});
    std::vector<double*> blocks = blocks_of(frame.posture, bone);
    blocks.push_back(bundle.model.lengths.data());
    blocks.push_back(&placed->second.rotation.x);
    blocks.push_back(&placed->second.translation.x);
    problem.AddResidualBlock(
        bone_cost<8, kLengthCount, 4, 3>(std::move(residual)), tag_loss(), blocks);
  }
}

void measure(SubjectBundle& bundle, std::span<const Camera> cameras) {
  std::vector<double> errors;
  double sum = 0.0;
  for (const BundleFrame& frame : bundle.frames) {
    for (const TagSighting& s : frame.sightings) {
      if (!bundle.model.place(s.tag)) continue;
      for (const double error :
           corner_errors_px(bundle.model, s, cameras, frame.posture)) {
        errors.push_back(error);
        sum += error * error;
      }
    }
  }
  if (errors.empty()) return;
  bundle.rms_px = std::sqrt(sum / static_cast<double>(errors.size()));
  bundle.median_px = median(std::move(errors));
}

/// Residuals larger than their sigmas say that the sigmas are too small: by how much.
double sigma_scale(const SubjectBundle& bundle) {
  double sum_px = 0.0;
  int count = 0;
  for (const BundleFrame& frame : bundle.frames) {
    for (const TagSighting& s : frame.sightings) {
      sum_px += s.detection->sigma_px;
      ++count;
    }
  }
  return count == 0
             ? 1.0
             : std::max(1.0, bundle.median_px * count / (kMedianOfUnitNoise * sum_px));
}

/// Information on the subject's own blocks: frames share nothing but the subject, so they
/// are eliminated one by one (Schur complement).
std::optional<Eigen::MatrixXd> subject_information(SubjectBundle& bundle,
                                                   ceres::Problem& problem) {
  std::vector<double*> blocks;
  std::vector<int> frame_sizes;
  for (BundleFrame& frame : bundle.frames) {
    int size = 0;
    for (const Slot slot : kAllSlots) {
      double* block = frame.posture.block(slot);
      if (!problem.HasParameterBlock(block)) continue;
      blocks.push_back(block);
      size += tangent_size(slot);
    }
    frame_sizes.push_back(size);
  }
  blocks.push_back(bundle.model.lengths.data());
  int subject_size = kLengthCount;
  for (auto& [tag, pose] : bundle.model.segment_from_tag) {
    blocks.push_back(&pose.rotation.x);
    blocks.push_back(&pose.translation.x);
    subject_size += 6;
  }
  const auto normal = normal_matrix(problem, std::move(blocks));
  if (!normal) return std::nullopt;
  const int first_subject = static_cast<int>(normal->cols()) - subject_size;
  Eigen::MatrixXd subject =
      normal->block(first_subject, first_subject, subject_size, subject_size);
  int start = 0;
  for (const int size : frame_sizes) {
    Eigen::MatrixXd own = normal->block(start, start, size, size);
    own.diagonal().array() += 1e-9;
    const Eigen::MatrixXd cross = normal->block(start, first_subject, size, subject_size);
    subject -= cross.transpose() * own.ldlt().solve(cross);
    start += size;
  }
  subject.diagonal().array() += 1e-9;
  return subject;
}

bool fill_sigmas(SubjectBundle& bundle, ceres::Problem& problem) {
  const auto information = subject_information(bundle, problem);
  if (!information) return false;
  const Eigen::MatrixXd covariance = information->ldlt().solve(
      Eigen::MatrixXd::Identity(information->rows(), information->cols()));
  const double scale = sigma_scale(bundle);
  const auto variance = [&](int i) { return std::max(0.0, covariance(i, i)); };
  for (int i = 0; i < kLengthCount; ++i) {
    bundle.length_sigma_m[static_cast<std::size_t>(i)] = scale * std::sqrt(variance(i));
  }
  int column = kLengthCount;
  for (const auto& [tag, pose] : bundle.model.segment_from_tag) {
    const auto rms = [&](int from) {
      return scale *
             std::sqrt((variance(from) + variance(from + 1) + variance(from + 2)) / 3.0);
    };
    // Ceres' quaternion tangent is half the rotation vector.
    bundle.tag_sigma[tag] = {rms(column + 3), 2.0 * rms(column)};
    column += 6;
  }
  return true;
}

}  // namespace

bool adjust(SubjectBundle& bundle,
            std::span<const Camera> cameras,
            int max_iterations,
            bool sigmas) {
  ceres::Problem problem;
  for (BundleFrame& frame : bundle.frames) {
    add_sightings(bundle, frame, cameras, problem);
    add_habits(frame.posture, bundle.model.lengths, problem, kTrialTwists);
    if (frame.standing) add_standing(frame.posture, bundle.model.lengths, problem);
    set_manifolds(frame.posture, problem);
  }
  for (auto& [tag, pose] : bundle.model.segment_from_tag) {
    MAREY_ASSERT(problem.HasParameterBlock(&pose.rotation.x));
    problem.SetManifold(&pose.rotation.x, new ceres::EigenQuaternionManifold);
  }
  add_length_habits(bundle.usual,
                    usual_length_sigmas_m(bundle.usual),
                    bundle.model.lengths,
                    problem);
  add_tag_priors(bundle, problem);
  ceres::Solver::Summary summary;
  ceres::Solver::Options options = solver_options(max_iterations);
  options.function_tolerance = 1e-5;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return false;
  measure(bundle, cameras);
  return !sigmas || fill_sigmas(bundle, problem);
}

}  // namespace marey::reconstruct
