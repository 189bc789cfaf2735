// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the terms that a posture is solved from.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "reconstruct/posture.h"

namespace marey::reconstruct {

/// Rotation vector of a unit quaternion, differentiable at the identity. [rad]
template <class T>
Eigen::Matrix<T, 3, 1> log_rotation(const Eigen::Quaternion<T>& q) {
  const std::array<T, 4> wxyz{q.w(), q.x(), q.y(), q.z()};
  Eigen::Matrix<T, 3, 1> vector;
  ceres::QuaternionToAngleAxis(wxyz.data(), vector.data());
  return vector;
}

/// Ceres' list of blocks, told apart: the posture's, then `extra` further ones.
template <class T>
struct PostureBlocks {
  std::array<const T*, kSlotCount> of{};
  std::array<const T*, 2> extra{};

  PostureBlocks(std::span<const Slot> slots, const T* const* list, std::size_t extras) {
    for (std::size_t i = 0; i < slots.size(); ++i) of[index(slots[i])] = list[i];
    for (std::size_t i = 0; i < extras; ++i) extra[i] = list[slots.size() + i];
  }
};

/// Blocks are functor->slots, which are slots_of(its bone), then `Extra...`. Of blocks
/// that are held nothing is derived.
template <int Residuals, int... Extra, class Functor>
ceres::CostFunction* bone_cost(std::unique_ptr<Functor> functor) {
  const std::vector<Slot> slots = functor->slots;
  // Passes of eight: most bones follow 16 to 32 numbers.
  auto cost =
      std::make_unique<ceres::DynamicAutoDiffCostFunction<Functor, 8>>(functor.release());
  for (const Slot slot : slots) cost->AddParameterBlock(block_size(slot));
  (cost->AddParameterBlock(Extra), ...);
  cost->SetNumResiduals(Residuals);
  return cost.release();
}

/// Change of a rotation's speed over three frames, in sigmas. Speeds die out: of the
/// first step only the share `keeps` is expected in the second (an Ornstein-Uhlenbeck
/// process).
struct RotationAcceleration {
  double sigma_rad;
  double keeps;

  template <class T>
  bool operator()(const T* before, const T* now, const T* after, T* residual) const {
    using Q = Eigen::Quaternion<T>;
    const Q a = Eigen::Map<const Q>(before);
    const Q b = Eigen::Map<const Q>(now);
    const Q c = Eigen::Map<const Q>(after);
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(residual);
    out = (log_rotation<T>(c * b.conjugate()) -
           T(keeps) * log_rotation<T>(b * a.conjugate())) /
          T(sigma_rad);
    return true;
  }
};

/// The same for N plain numbers.
template <int N>
struct Acceleration {
  double sigma;
  double keeps;

  template <class T>
  bool operator()(const T* before, const T* now, const T* after, T* residual) const {
    for (int i = 0; i < N; ++i) {
      residual[i] = (after[i] - now[i] - keeps * (now[i] - before[i])) / sigma;
    }
    return true;
  }
};

/// A rotation's step from one frame to the next is small.
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

/// The same for N plain numbers.
template <int N>
struct Step {
  double sigma;

  template <class T>
  bool operator()(const T* now, const T* after, T* residual) const {
    for (int i = 0; i < N; ++i) residual[i] = (after[i] - now[i]) / sigma;
    return true;
  }
};

/// `child` should be turned against `parent` by `parent_from_child`, give or take.
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

/// The bone should be turned as `world_from_bone`, give or take.
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

/// A point should be at `expected`, give or take.
struct PlacePrior {
  glm::dvec3 expected;
  double sigma_m;

  template <class T>
  bool operator()(const T* place, T* residual) const {
    for (int i = 0; i < 3; ++i) residual[i] = (place[i] - expected[i]) / sigma_m;
    return true;
  }
};

/// `middle` should be half way between `lower` and `upper`: a spine bends evenly.
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

/// A number should be near `expected`, give or take.
struct ScalarPrior {
  double expected;
  double sigma;

  template <class T>
  bool operator()(const T* value, T* residual) const {
    residual[0] = (value[0] - expected) / sigma;
    return true;
  }
};

/// A joint angle should not fall under `minimum_rad`: free above, a spring below.
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

/// The bone stands upright: its Y axis up; its Z axis level (always), its X axis level
/// (if `roll`).
struct UprightPrior {
  double sigma_rad;
  bool roll;

  template <class T>
  bool operator()(const T* world_from_bone, T* residual) const {
    using Q = Eigen::Quaternion<T>;
    const Q q = Eigen::Map<const Q>(world_from_bone);
    const Eigen::Matrix<T, 3, 1> up =
        q.conjugate() * Eigen::Matrix<T, 3, 1>(T(0), T(1), T(0));
    residual[0] = up.z() / T(sigma_rad);
    residual[1] = roll ? up.x() / T(sigma_rad) : T(0);
    return true;
  }
};

}  // namespace marey::reconstruct
