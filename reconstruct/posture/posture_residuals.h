// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: residuals of a posture's cost.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "reconstruct/posture/posture.h"

namespace marey::reconstruct {

/// Returns the rotation vector of a unit quaternion, differentiable at the identity.
/// [rad]
template <class T>
Eigen::Matrix<T, 3, 1> log_rotation(const Eigen::Quaternion<T>& q) {
  const std::array<T, 4> wxyz{q.w(), q.x(), q.y(), q.z()};
  Eigen::Matrix<T, 3, 1> vector;
  ceres::QuaternionToAngleAxis(wxyz.data(), vector.data());
  return vector;
}

/// Separates Ceres' list of blocks: the posture's, then `extra` further ones.
template <class T>
struct PostureBlocks {
  std::array<const T*, kPoseParameterCount> of{};
  std::array<const T*, 2> extra{};

  PostureBlocks(std::span<const PoseParameter> parameters,
                const T* const* list,
                std::size_t extras) {
    for (std::size_t i = 0; i < parameters.size(); ++i)
      of[index(parameters[i])] = list[i];
    for (std::size_t i = 0; i < extras; ++i) extra[i] = list[parameters.size() + i];
  }
};

/// Creates a cost whose blocks are functor->parameters, the parameters_of() its bone,
/// then `Extra...`. Held blocks have no derivatives.
template <int Residuals, int... Extra, class Functor>
ceres::CostFunction* bone_cost(std::unique_ptr<Functor> functor) {
  const std::vector<PoseParameter> parameters = functor->parameters;
  // Passes of eight: most bones depend on 16 to 32 numbers.
  auto cost =
      std::make_unique<ceres::DynamicAutoDiffCostFunction<Functor, 8>>(functor.release());
  for (const PoseParameter parameter : parameters)
    cost->AddParameterBlock(block_size(parameter));
  (cost->AddParameterBlock(Extra), ...);
  cost->SetNumResiduals(Residuals);
  return cost.release();
}

/// Change of a rotation's speed over three frames, in sigmas. Speeds decay: the second
/// step is expected to be `correlation` times the first (an Ornstein-Uhlenbeck process).
struct RotationAcceleration {
  double sigma_rad;
  double correlation;

  template <class T>
  bool operator()(const T* before, const T* now, const T* after, T* residual) const {
    using Q = Eigen::Quaternion<T>;
    const Q a = Eigen::Map<const Q>(before);
    const Q b = Eigen::Map<const Q>(now);
    const Q c = Eigen::Map<const Q>(after);
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(residual);
    out = (log_rotation<T>(c * b.conjugate()) -
           T(correlation) * log_rotation<T>(b * a.conjugate())) /
          T(sigma_rad);
    return true;
  }
};

/// Change of the speed of N scalars over three frames, in sigmas.
template <int N>
struct Acceleration {
  double sigma;
  double correlation;

  template <class T>
  bool operator()(const T* before, const T* now, const T* after, T* residual) const {
    for (int i = 0; i < N; ++i) {
      residual[i] = (after[i] - now[i] - correlation * (now[i] - before[i])) / sigma;
    }
    return true;
  }
};

/// Step of a rotation from one frame to the next, in sigmas.
struct RotationStep {
  double sigma_rad;

  template <class T>
  bool operator()(const T* now, const T* after, T* residual) const {
    using Q = Eigen::Quaternion<T>;
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(residual);
    out = log_rotation<T>(Q(Eigen::Map<const Q>(after)) *
                          Q(Eigen::Map<const Q>(now)).conjugate()) /
          T(sigma_rad);
    return true;
  }
};

/// Step of N scalars from one frame to the next, in sigmas.
template <int N>
struct Step {
  double sigma;

  template <class T>
  bool operator()(const T* now, const T* after, T* residual) const {
    for (int i = 0; i < N; ++i) residual[i] = (after[i] - now[i]) / sigma;
    return true;
  }
};

/// Prior: rotation of `child` relative to `parent` is `parent_from_child`.
struct RelativeRotationPrior {
  glm::dquat parent_from_child;
  glm::dvec3 sigma_rad;  ///< About the child's own axes.

  template <class T>
  bool operator()(const T* parent, const T* child, T* residual) const {
    using Q = Eigen::Quaternion<T>;
    const Q p = Eigen::Map<const Q>(parent);
    const Q c = Eigen::Map<const Q>(child);
    const Q expected(T(parent_from_child.w),
                     T(parent_from_child.x),
                     T(parent_from_child.y),
                     T(parent_from_child.z));
    const auto off = log_rotation<T>((p * expected).conjugate() * c);
    for (int i = 0; i < 3; ++i) residual[i] = off[i] / sigma_rad[i];
    return true;
  }
};

/// Prior: rotation of the bone is `world_from_bone`.
struct RotationPrior {
  glm::dquat world_from_bone;
  double sigma_rad;

  template <class T>
  bool operator()(const T* rotation, T* residual) const {
    using Q = Eigen::Quaternion<T>;
    const Q expected(T(world_from_bone.w),
                     T(world_from_bone.x),
                     T(world_from_bone.y),
                     T(world_from_bone.z));
    const auto off =
        log_rotation<T>(expected.conjugate() * Q(Eigen::Map<const Q>(rotation)));
    for (int i = 0; i < 3; ++i) residual[i] = off[i] / T(sigma_rad);
    return true;
  }
};

/// Prior: a point is at `expected`.
struct PlacePrior {
  glm::dvec3 expected;
  double sigma_m;

  template <class T>
  bool operator()(const T* place, T* residual) const {
    for (int i = 0; i < 3; ++i) residual[i] = (place[i] - expected[i]) / sigma_m;
    return true;
  }
};

/// Prior: `middle` is half way between `lower` and `upper`, because a spine bends evenly.
struct HalfwayPrior {
  double sigma_rad;

  template <class T>
  bool operator()(const T* lower, const T* middle, const T* upper, T* residual) const {
    using Q = Eigen::Quaternion<T>;
    const Q half =
        detail::halfway<T>(Q(Eigen::Map<const Q>(lower)), Q(Eigen::Map<const Q>(upper)));
    const auto off = log_rotation<T>(half.conjugate() * Q(Eigen::Map<const Q>(middle)));
    for (int i = 0; i < 3; ++i) residual[i] = off[i] / T(sigma_rad);
    return true;
  }
};

/// Prior: a number is `expected`.
struct ScalarPrior {
  double expected;
  double sigma;

  template <class T>
  bool operator()(const T* value, T* residual) const {
    residual[0] = (value[0] - expected) / sigma;
    return true;
  }
};

/// Lower limit of a joint angle: no cost above `minimum_rad`, a spring below.
struct FlexionLimit {
  double minimum_rad;
  double sigma_rad;

  template <class T>
  bool operator()(const T* flexion, T* residual) const {
    residual[0] =
        flexion[0] < minimum_rad ? (flexion[0] - minimum_rad) / sigma_rad : T(0);
    return true;
  }
};

}  // namespace marey::reconstruct
