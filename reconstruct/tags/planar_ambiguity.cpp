// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/planar_ambiguity.h"

#include <Eigen/Cholesky>

#include "reconstruct/clusters/locate_rigid.h"

namespace marey::reconstruct {
namespace {

// Largest turn of an end in a thirtieth of a second: separates two poses of one tag if
// both fit the picture.
constexpr double kTurnPerFrame_rad = 0.3;
constexpr int kSteps = 8;
// Poses that are further apart than this are different. [rad]
constexpr double kOther_rad = 0.1;

}  // namespace

PlanarPoseAmbiguity::PlanarPoseAmbiguity(const TagModel& model)
    : model_(&model), solver_(model) {
  own_.reserve(model.tags.size() * model.cameras.size());
}

/// Minimizes the cost over the end's rotation alone; returns that cost.
double PlanarPoseAmbiguity::refine(const ChainEnd& end,
                                   const TagFrameSolver::SolveInputs& inputs,
                                   const glm::dquat& before,
                                   Posture& posture) {
  const int column = column_of(end.parameter);
  const double information = 1.0 / (kTurnPerFrame_rad * kTurnPerFrame_rad);
  const Eigen::Quaterniond held(before.w, before.x, before.y, before.z);
  double minimum = std::numeric_limits<double>::infinity();
  Posture at = posture;
  for (int i = 0; i < kSteps; ++i) {
    const PostureEquations& all = solver_.evaluate(own_, inputs, at);
    const Eigen::Vector3d off = log_of(quaternion(at, end.parameter) * held.conjugate());
    const double cost = all.cost + 0.5 * information * off.squaredNorm();
    if (!(cost < minimum)) break;
    const bool done = cost > 0.999 * minimum;
    minimum = cost;
    posture = at;
    if (done) break;
    const Eigen::Matrix3d turned = inverse_left_jacobian(off);
    Eigen::Matrix3d hessian =
        all.hessian.block<3, 3>(column, column).selfadjointView<Eigen::Lower>();
    hessian += information * turned.transpose() * turned;
    const Eigen::Vector3d gradient =
        all.gradient.segment<3>(column) + information * turned.transpose() * off;
    PostureVector step = PostureVector::Zero();
    step.segment<3>(column) = -hessian.llt().solve(gradient);
    move(at, step);
  }
  return minimum;
}

bool PlanarPoseAmbiguity::reconsider(const ChainEnd& end,
                                     std::span<const SeenTag> seen,
                                     const TagFrameSolver::SolveInputs& inputs,
                                     const glm::dquat& before,
                                     Posture& posture) {
  own_.clear();
  for (const SeenTag& one : seen) {
    if (model_->tags[one.tag].bone == end.bone) own_.push_back(one);
  }
  if (own_.size() != 1) return false;
  const ModelTag& tag = model_->tags[own_[0].tag];
  const auto poses =
      planar_poses(model_->cameras[own_[0].camera], own_[0].detection, tag.tag.size_m);
  if (!poses) return false;
  TagFrameSolver::SolveInputs own = inputs;
  own.prior = nullptr;
  const glm::dquat was = posture.rotation(end.parameter);
  Posture best = posture;
  double minimum = refine(end, own, before, best);
  for (const RigidTransform& world_from_tag : *poses) {
    Posture other = posture;
    other.set_rotation(end.parameter,
                       glm::normalize(world_from_tag.rotation *
                                      glm::conjugate(tag.bone_from_tag.rotation)));
    const double cost = refine(end, own, before, other);
    if (!(cost < minimum)) continue;
    minimum = cost;
    best = other;
  }
  const glm::dquat turn = glm::conjugate(was) * best.rotation(end.parameter);
  if (glm::length(rotation_vector(turn)) < kOther_rad) return false;
  posture.set_rotation(end.parameter, best.rotation(end.parameter));
  return true;
}

}  // namespace marey::reconstruct
