// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/tag_model.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "reconstruct/clusters/sightings.h"
#include "reconstruct/tags/tag_loss.h"

namespace marey::reconstruct {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Limit on one sighting's squares, relative to their expectation: outliers are not slip.
constexpr double kMaxCost = 9.0;
// Minimum derivative of a late posture by the posture; for a camera so early that its
// picture depends on the previous posture alone.
constexpr double kMinFollowed = 0.2;

/// Converts a step of move_bones() to one of move().
PostureVector in_unknowns(const PostureVector& step,
                          const Posture& posture,
                          const Lengths& lengths) {
  PostureVector out = step;
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    out.segment<3>(column_of(kLimbParameters[limb].frame)) -=
        step[column_of(kLimbParameters[limb].flexion)] *
        upper_by_flexion(posture, limb, lengths);
  }
  return out;
}

/// Returns the step per frame of a body in this posture, as in move_bones().
PostureVector step_at(const Posture& posture,
                      const Drift& drift,
                      const Lengths& lengths) {
  const PostureVector moved = bone_step_between(*drift.expected, posture, lengths);
  PostureVector step = drift.step;
  for (const PoseParameter parameter : kAllPoseParameters) {
    const int column = column_of(parameter);
    const Matrix3d& gain = drift.gain[index(parameter)];
    if (tangent_size(parameter) == 3) {
      step.segment<3>(column) += gain * moved.segment<3>(column);
    } else {
      step[column] += gain(0, 0) * moved[column];
    }
  }
  return step;
}

/// Returns `prior` with an unknown phase of the movement, parameter by parameter.
PosturePrior without_phase(const PosturePrior& prior, const PostureVector& step) {
  // Larger than any lag, and small enough for regular equations.
  constexpr double kPhaseSigma_frames = 10.0;
  PosturePrior out = prior;
  for (const PoseParameter parameter : kAllPoseParameters) {
    const int column = column_of(parameter);
    Vector3d along = Vector3d::Zero();
    along.head(tangent_size(parameter)) = step.segment(column, tangent_size(parameter));
    Matrix3d& information = out.information[index(parameter)];
    const Vector3d known = information * along;
    information -= known * known.transpose() /
                   (along.dot(known) + 1.0 / (kPhaseSigma_frames * kPhaseSigma_frames));
  }
  return out;
}

}  // namespace

TagModel to_tag_model(const Body& body, std::span<const Camera> cameras) {
  TagModel model;
  model.lengths = lengths_of(body.proportions);
  model.body = body_constants(body);
  for (const PlacedTag& placed : body.tags) {
    ModelTag tag{
        placed.tag, solved_segment(placed.tag.segment), placed.segment_from_tag, {}};
    for (int c = 0; c < 4; ++c) {
      tag.corners_in_bone[static_cast<std::size_t>(c)] =
          eigen(tag.bone_from_tag * corner_in_tag(c, placed.tag.size_m));
    }
    model.tags.push_back(tag);
  }
  std::stable_sort(
      model.tags.begin(), model.tags.end(), [](const ModelTag& a, const ModelTag& b) {
        return a.tag.id < b.tag.id;
      });
  model.cameras.assign(cameras.begin(), cameras.end());
  for (const Camera& camera : cameras) model.sights.emplace_back(camera);
  return model;
}

std::optional<std::size_t> limb_of(HumanBone bone) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const HumanLimb& bones = human_limbs()[limb];
    if (bone == bones.upper || bone == bones.lower || bone == bones.end) return limb;
  }
  return std::nullopt;
}

TagFrameSolver::TagFrameSolver(const TagModel& model)
    : model_(&model), by_camera_(model.cameras.size()) {}

const UnfoldedPosture& TagFrameSolver::unfold(const Posture& posture) {
  unfolded_.unfold(posture, model_->lengths, model_->body);
  return unfolded_;
}

void TagFrameSolver::unfold_all(const Posture& posture, const Drift* drift) {
  PostureVector step;
  if (drift) step = step_at(posture, *drift, model_->lengths);
  unfold(posture);
  if (drift) {
    step_ = in_unknowns(step, posture, model_->lengths);
    Posture next = posture;
    move(next, step_);
    next_.unfold(next, model_->lengths, model_->body);
  }
  for (std::size_t limb = 0; drift && limb < kLimbParameters.size(); ++limb) {
    upper_by_flexion_[limb] = upper_by_flexion(posture, limb, model_->lengths);
  }
  for (std::size_t c = 0; c < by_camera_.size(); ++c) {
    Seen& seen = by_camera_[c];
    seen.late = drift != nullptr;
    if (!drift) continue;
    const double late = drift->late_frames[c];
    Posture later = posture;
    move_bones(later, late * step, model_->lengths);
    seen.unfolded.unfold(later, model_->lengths, model_->body);
    for (const PoseParameter parameter : kAllPoseParameters) {
      const int size = tangent_size(parameter);
      const double gain =
          drift->gain[index(parameter)].topLeftCorner(size, size).trace() / size;
      seen.follows.segment(column_of(parameter), size)
          .setConstant(std::max(kMinFollowed, 1.0 + late * gain));
    }
  }
}

bool TagFrameSolver::sight(const SeenTag& seen,
                           const SolveInputs& inputs,
                           double sigma_scale,
                           TagSighted& out) const {
  const ModelTag& tag = model_->tags[seen.tag];
  const Seen& by = by_camera_[seen.camera];
  const UnfoldedPosture& unfolded = by.late ? by.unfolded : unfolded_;
  const double scale = 1.0 / (sigma_scale * seen.detection.sigma_px);
  for (std::size_t c = 0; c < 4; ++c) {
    out.corners_in_world[c] = unfolded.point(tag.bone, tag.corners_in_bone[c]);
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> px_by_world;
    if (!model_->sights[seen.camera].project(
            out.corners_in_world[c], pixel, px_by_world)) {
      return false;
    }
    const glm::dvec2& corner = seen.detection.corners_px[c];
    const auto row = static_cast<Eigen::Index>(2 * c);
    out.residual.segment<2>(row) = scale * (pixel - Eigen::Vector2d(corner.x, corner.y));
    out.by_shift.middleRows<2>(row) = scale * px_by_world;
  }
  out.explained.setZero();
  const double variance_m2 = stray_m2(seen, inputs);
  if (variance_m2 > 0.0) {
    Matrix3d inside = out.by_shift.transpose() * out.by_shift;
    inside.diagonal().array() += 1.0 / variance_m2;
    out.explained = inside.inverse();
  }
  return true;
}

/// Returns the variance of a tag's place about that on a rigid body at the time of the
/// picture: its slip, and its movement within the uncertainty of that time. [m^2]
double TagFrameSolver::stray_m2(const SeenTag& seen, const SolveInputs& inputs) const {
  const ModelTag& tag = model_->tags[seen.tag];
  const double slip_m = inputs.slips_m ? (*inputs.slips_m)[index(tag.bone)] : 0.0;
  double variance_m2 = seen.cameras * slip_m * slip_m;
  if (inputs.drift && !inputs.drift->late_sigma_frames.empty()) {
    const Vector3d& corner = tag.corners_in_bone[0];
    const Vector3d moved =
        next_.point(tag.bone, corner) - unfolded_.point(tag.bone, corner);
    const double sigma = inputs.drift->late_sigma_frames[seen.camera];
    const double speed_m = inputs.drift->speed_sigma_m;
    variance_m2 += sigma * sigma * (moved.squaredNorm() + speed_m * speed_m);
  }
  return variance_m2;
}

/// Fills derivative_ from one sighting. Preconditions: unfold_all(); the tag is in front
/// of the camera.
void TagFrameSolver::derive(const SeenTag& seen, const TagSighted& sighted) {
  const Seen& by = by_camera_[seen.camera];
  const UnfoldedPosture& unfolded = by.late ? by.unfolded : unfolded_;
  const HumanBone bone = model_->tags[seen.tag].bone;
  for (std::size_t c = 0; c < 4; ++c) {
    unfolded.derivative(bone, sighted.corners_in_world[c], point_);
    const auto row = static_cast<Eigen::Index>(2 * c);
    derivative_.value.middleRows<2>(row).leftCols(point_.columns).noalias() =
        sighted.by_shift.middleRows<2>(row).lazyProduct(
            point_.value.leftCols(point_.columns));
  }
  derivative_.columns = point_.columns;
  derivative_.column = point_.column;
}

/// Extends derivative_ to a camera that sees the body later than it is solved: it also
/// depends on the step, in which the limbs' upper bones are independent (move_bones()).
void TagFrameSolver::scale_late(const SeenTag& seen) {
  const Seen& by = by_camera_[seen.camera];
  if (!by.late) return;
  const auto limb = limb_of(model_->tags[seen.tag].bone);
  for (int i = 0; i < derivative_.columns; ++i) {
    const int column = derivative_.column[static_cast<std::size_t>(i)];
    if (!limb || column != column_of(kLimbParameters[*limb].flexion)) {
      derivative_.value.col(i) *= by.follows[column];
      continue;
    }
    // The columns of its frame are the three before, and already scaled.
    const double share =
        by.follows[column] / by.follows[column_of(kLimbParameters[*limb].frame)];
    derivative_.value.col(i) *= by.follows[column];
    derivative_.value.col(i) +=
        (1.0 - share) * derivative_.value.middleCols<3>(i - 3) * upper_by_flexion_[*limb];
  }
}

void TagFrameSolver::accumulate(std::span<const SeenTag> seen,
                                const SolveInputs& inputs,
                                const Posture& posture,
                                const FrameLimits& limits,
                                PostureEquations& out) {
  unfold_all(posture, inputs.drift);
  out.clear();
  TagSighted sighted;
  for (const SeenTag& one : seen) {
    if (!sight(one, inputs, limits.sigma_scale, sighted)) {
      out.cost += tag_cost(kBehind2);
      continue;
    }
    const double squared = sighted.squared();
    out.cost += tag_cost(squared);
    derive(one, sighted);
    scale_late(one);
    derivative_.add_to(sighted, tag_weight(squared), out);
  }
  out.add_posture_priors(posture, unfolded_, model_->twists, limits.prior_share);
  if (inputs.prior) out.add_prior(posture, model_->lengths, *inputs.prior);
}

double TagFrameSolver::solve(std::span<const SeenTag> seen,
                             const SolveInputs& inputs,
                             Posture& posture,
                             const FrameLimits& limits) {
  return descent_.run(
      [&](const Posture& at, PostureEquations& out) {
        accumulate(seen, inputs, at, limits, out);
      },
      limits,
      posture);
}

const PostureEquations& TagFrameSolver::evaluate(std::span<const SeenTag> seen,
                                                 const SolveInputs& inputs,
                                                 const Posture& posture,
                                                 const FrameLimits& limits) {
  accumulate(seen, inputs, posture, limits, evaluated_);
  return evaluated_;
}

void TagFrameSolver::fit(std::span<const SeenTag> seen,
                         const SolveInputs& inputs,
                         const Posture& posture,
                         std::span<SightingFit> fits) {
  unfold_all(posture, inputs.drift);
  TagSighted sighted;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    fits[i] = {kBehind2, 1e3};
    if (!sight(seen[i], inputs, 1.0, sighted)) continue;
    fits[i].squared = sighted.squared();
    fits[i].rms_px =
        seen[i].detection.sigma_px * std::sqrt(sighted.residual.squaredNorm() / 4.0);
  }
}

void TagFrameSolver::lateness(std::span<const SeenTag> seen,
                              const SolveInputs& inputs,
                              const Posture& posture,
                              const FrameLimits& limits,
                              std::span<Lateness> out) {
  std::fill(out.begin(), out.end(), Lateness{});
  if (!inputs.drift) return;
  Drift drift = *inputs.drift;
  // The lags are the unknowns here, so their uncertainty is left out.
  drift.late_sigma_frames = {};
  // The prediction depends on earlier pictures with the same lags, so it does not measure
  // how late a picture is. Without this, one lag of all cameras seems observable.
  drift.step = step_at(posture, drift, model_->lengths);
  for (Matrix3d& gain : drift.gain) gain.setZero();
  std::optional<PosturePrior> prior;
  if (inputs.prior) prior = without_phase(*inputs.prior, drift.step);
  const SolveInputs own{prior ? &*prior : nullptr, &drift, inputs.slips_m};
  accumulate(seen, own, posture, limits, evaluated_);
  if (!late_factor_.factor(evaluated_.hessian, 0.0)) return;
  TagSighted sighted;
  for (const SeenTag& one : seen) {
    if (!sight(one, own, 1.0, sighted)) continue;
    const double squared = sighted.squared();
    const double weight = tag_weight(squared);
    derive(one, sighted);
    Eigen::Matrix<double, 8, 1> speed = Eigen::Matrix<double, 8, 1>::Zero();
    for (int i = 0; i < derivative_.columns; ++i) {
      speed += step_[derivative_.column[static_cast<std::size_t>(i)]] *
               derivative_.value.col(i);
    }
    const Eigen::Matrix<double, 8, 1> weighted = weight * sighted.weighted(speed);
    scale_late(one);
    Lateness& here = out[one.camera];
    here.gradient += weighted.dot(sighted.residual);
    here.information += weighted.dot(speed);
    for (int i = 0; i < derivative_.columns; ++i) {
      const int column = derivative_.column[static_cast<std::size_t>(i)];
      here.by_posture[column] += weighted.dot(derivative_.value.col(i));
    }
  }
  // The step of the posture with all delays taken as exact.
  PostureVector step;
  late_factor_.step(evaluated_.gradient, step);
  for (Lateness& here : out) here.gradient += here.by_posture.dot(step);
}

void TagFrameSolver::slips(std::span<const SeenTag> seen,
                           const SolveInputs& inputs,
                           const Posture& posture,
                           const PostureCovariance& covariance,
                           std::span<SlipScore> out) {
  std::fill(out.begin(), out.end(), SlipScore{});
  unfold_all(posture, inputs.drift);
  TagSighted sighted;
  for (const SeenTag& one : seen) {
    if (!sight(one, inputs, 1.0, sighted)) continue;
    derive(one, sighted);
    scale_late(one);
    const std::size_t bone = index(model_->tags[one.tag].bone);
    const double slip_m = inputs.slips_m ? (*inputs.slips_m)[bone] : 0.0;
    // Per metre of slip: the remainder after the corners' errors and the slip, minus the
    // part that the posture absorbs.
    const Matrix3d shared = sighted.by_shift.transpose() * sighted.by_shift;
    const Matrix3d weighted = shared - shared * sighted.explained * shared;
    const Matrix3d gives = covariance.of(by_slip(sighted));
    const Matrix3d kept = weighted - gives;
    // If several cameras see one slip, each sighting counts as if its slip were larger.
    const double overrated =
        (one.cameras - 1.0) * slip_m * slip_m * weighted.squaredNorm();
    const double expected = kept.trace() - overrated;
    if (!(expected > 0.0)) continue;
    const Vector3d pull =
        sighted.by_shift.transpose() * sighted.weighted(sighted.residual);
    out[bone].excess += std::min(pull.squaredNorm(), kMaxCost * expected) - expected;
    out[bone].information += kept.squaredNorm();
    out[bone].count += 1.0;
  }
}

/// Computes the derivative of the pull of a tag's slip by the posture, from derivative_.
const SparseDerivative& TagFrameSolver::by_slip(const TagSighted& sighted) {
  point_.columns = derivative_.columns;
  point_.column = derivative_.column;
  const Eigen::Matrix<double, 3, 8> weighted =
      sighted.by_shift.transpose() -
      (sighted.by_shift.transpose() * sighted.by_shift * sighted.explained) *
          sighted.by_shift.transpose();
  point_.value.leftCols(point_.columns).noalias() =
      weighted.lazyProduct(derivative_.value.leftCols(point_.columns));
  return point_;
}

}  // namespace marey::reconstruct
