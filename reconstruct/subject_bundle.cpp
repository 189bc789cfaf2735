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

// A clavicle turns about one end, and its scapula slides on the rib cage: the point that
// a shoulder moves about as a whole may be anywhere between.
constexpr double kShoulderBase_m = 0.05;
constexpr double kNeckForward_m = 0.012;

// Share of the variance of a corner's error that is the same in all pictures that one
// camera takes of the tag: lens, print and light. A choice: rendered tags that move show
// up to a seventh (docs/measurements.md).
constexpr double kCommonShare = 0.03;

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
      // Ceres' quaternion tangent is half the rotation vector; -turn x arm = arm x turn.
      jacobian.middleCols<3>(column) += 2.0 * cross;
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
  fill_centre_sigmas(covariance, scale, bundle);
  return true;
}

}  // namespace

bool adjust(SubjectBundle& bundle,
            std::span<const Camera> cameras,
            int max_iterations,
            bool sigmas) {
  ceres::Problem problem;
  // A collar bone of this person's may well rest otherwise than usual, in all frames
  // alike: together they count as one, or they would move the shoulders' centres.
  for (BundleFrame& frame : bundle.frames) {
    add_sightings(bundle, frame, cameras, problem);
    add_habits(frame.posture,
               bundle.model.lengths,
               problem,
               kTrialTwists,
               std::sqrt(static_cast<double>(bundle.frames.size())));
    if (frame.standing) add_standing(frame.posture, bundle.model.lengths, problem);
    set_manifolds(frame.posture, problem);
  }
  for (auto& [tag, pose] : bundle.model.segment_from_tag) {
    MAREY_ASSERT(problem.HasParameterBlock(&pose.rotation.x));
    problem.SetManifold(&pose.rotation.x, new ceres::EigenQuaternionManifold);
  }
  Lengths sigmas_m = usual_length_sigmas_m(bundle.usual);
  for (const Length length :
       {Length::kShoulderOut, Length::kShoulderUp, Length::kShoulderForward}) {
    sigmas_m[index(length)] = kShoulderBase_m;
  }
  sigmas_m[index(Length::kNeckForward)] = kNeckForward_m;
  add_length_habits(bundle.usual, sigmas_m, bundle.model.lengths, problem);
  add_tag_priors(bundle, problem);
  ceres::Solver::Summary summary;
  ceres::Solver::Options options = solver_options(max_iterations);
  // Where a limb's middle joint lies along it hardly changes the cost, and converges
  // last.
  options.function_tolerance = sigmas ? 1e-7 : 1e-5;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return false;
  measure(bundle, cameras);
  return !sigmas || fill_sigmas(bundle, problem);
}

}  // namespace marey::reconstruct
