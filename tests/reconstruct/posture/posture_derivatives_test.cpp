// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/posture_derivatives.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "reconstruct/clusters/sightings.h"
#include "tests/reconstruct/random_posture.h"

namespace marey::reconstruct {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using marey::testing::Dice;

// Central differences of this step are exact to its square, and to rounding over it.
constexpr double kStep = 1e-5;
constexpr double kExact = 1e-8;

struct Scene {
  Lengths lengths;
  BodyConstants frame;
  Posture posture;
};

Scene random_scene(unsigned seed) {
  Dice dice(seed);
  const Lengths lengths = random_lengths(dice);
  const BodyConstants frame = askew_frame(dice);
  return {lengths, frame, random_posture(dice)};
}

UnfoldedPosture moved(const Scene& scene, int column, double by) {
  PostureVector step = PostureVector::Zero();
  step[column] = by;
  Posture posture = scene.posture;
  move(posture, step);
  UnfoldedPosture unfolded;
  unfolded.unfold(posture, scene.lengths, scene.frame);
  return unfolded;
}

Eigen::Matrix<double, 3, kPostureFreedom> dense(const SparseDerivative& d) {
  Eigen::Matrix<double, 3, kPostureFreedom> all;
  all.setZero();
  for (int i = 0; i < d.columns; ++i) {
    all.col(d.column[static_cast<std::size_t>(i)]) += d.value.col(i);
  }
  return all;
}

TEST(UnfoldedPosture, AgreesWithTheForwardKinematicsOfEveryBone) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Scene scene = random_scene(seed);
    UnfoldedPosture unfolded;
    unfolded.unfold(scene.posture, scene.lengths, scene.frame);
    for (const HumanBone bone : human_bones()) {
      const RigidTransform frame = world_from_bone(
          solved_segment(bone), scene.posture, scene.lengths, scene.frame);
      const glm::dvec3 p = frame * glm::dvec3(0.1, 0.2, 0.3);
      EXPECT_LT((unfolded.point(bone, {0.1, 0.2, 0.3}) - Vector3d(p.x, p.y, p.z)).norm(),
                1e-13)
          << name(bone);
    }
  }
}

TEST(UnfoldedPosture, GivesTheDerivativesOfPoints) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Scene scene = random_scene(seed);
    UnfoldedPosture unfolded;
    unfolded.unfold(scene.posture, scene.lengths, scene.frame);
    const Vector3d p_in_bone(0.05, -0.1, 0.07);
    for (const HumanBone bone : human_bones()) {
      SparseDerivative d;
      unfolded.derivative(bone, unfolded.point(bone, p_in_bone), d);
      const auto all = dense(d);
      for (int column = 0; column < kPostureFreedom; ++column) {
        const Vector3d difference =
            (moved(scene, column, kStep).point(bone, p_in_bone) -
             moved(scene, column, -kStep).point(bone, p_in_bone)) /
            (2.0 * kStep);
        EXPECT_LT((difference - all.col(column)).norm(), kExact)
            << name(bone) << ", column " << column;
      }
    }
  }
}

TEST(UnfoldedPosture, GivesTheDerivativesOfTurns) {
  const Scene scene = random_scene(11);
  UnfoldedPosture unfolded;
  unfolded.unfold(scene.posture, scene.lengths, scene.frame);
  for (const HumanBone bone : human_bones()) {
    SparseDerivative d;
    unfolded.turn_derivative(bone, d);
    const auto all = dense(d);
    for (int column = 0; column < kPostureFreedom; ++column) {
      const Matrix3d turn = moved(scene, column, kStep).rotation(bone) *
                            moved(scene, column, -kStep).rotation(bone).transpose();
      const Vector3d difference(
          turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
      EXPECT_LT((difference / (4.0 * kStep) - all.col(column)).norm(), kExact)
          << name(bone) << ", column " << column;
    }
  }
}

TEST(UnfoldedPosture, GivesTheDerivativesByTheBodysShape) {
  for (unsigned seed = 21; seed <= 25; ++seed) {
    const Scene scene = random_scene(seed);
    UnfoldedPosture unfolded;
    unfolded.unfold(scene.posture, scene.lengths, scene.frame);
    const Vector3d p_in_bone(0.05, -0.1, 0.07);
    const auto moved_by = [&](int column, double by, HumanBone bone) {
      Lengths lengths = scene.lengths;
      BodyConstants frame = scene.frame;
      if (column < kLengthCount) {
        lengths[static_cast<std::size_t>(column)] += by;
      } else {
        HingeShape& hinge =
            frame.hinges[static_cast<std::size_t>(column - kLengthCount) / 3];
        const std::array numbers{&hinge.upper_rad, &hinge.lower_rad, &hinge.rollback_m};
        *numbers[static_cast<std::size_t>(column - kLengthCount) % 3] += by;
      }
      UnfoldedPosture other;
      other.unfold(scene.posture, lengths, frame);
      return other.point(bone, p_in_bone);
    };
    for (const HumanBone bone : human_bones()) {
      SparseDerivative d;
      unfolded.shape_derivative(bone, unfolded.point(bone, p_in_bone), d);
      Eigen::Matrix<double, 3, kShapeCount> all;
      all.setZero();
      for (int i = 0; i < d.columns; ++i) {
        all.col(d.column[static_cast<std::size_t>(i)]) += d.value.col(i);
      }
      for (int column = 0; column < kShapeCount; ++column) {
        const Vector3d difference =
            (moved_by(column, kStep, bone) - moved_by(column, -kStep, bone)) /
            (2.0 * kStep);
        EXPECT_LT((difference - all.col(column)).norm(), kExact)
            << name(bone) << ", column " << column;
      }
    }
  }
}

TEST(StepBetween, IsUndoneByMove) {
  const Scene from = random_scene(12);
  Dice dice(13);
  PostureVector step;
  for (int i = 0; i < kPostureFreedom; ++i) step[i] = dice.between(-0.5, 0.5);
  Posture to = from.posture;
  move(to, step);
  EXPECT_LT((step_between(from.posture, to) - step).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(InverseLeftJacobian, IsTheDerivativeOfTheLogarithm) {
  for (const Vector3d& r : {Vector3d(0.0, 0.0, 0.0),
                            Vector3d(1e-3, -2e-3, 5e-4),
                            Vector3d(0.7, -1.1, 0.4),
                            Vector3d(-1.2, 2.0, 1.5)}) {
    const Matrix3d jacobian = inverse_left_jacobian(r);
    const auto log_of_moved = [&](int i, double by) {
      glm::dvec3 x(0.0);
      x[i] = by;
      return rotation_vector(rotation_from_vector(x) *
                             rotation_from_vector({r.x(), r.y(), r.z()}));
    };
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 d =
          (log_of_moved(i, kStep) - log_of_moved(i, -kStep)) / (2.0 * kStep);
      EXPECT_LT((Vector3d(d.x, d.y, d.z) - jacobian.col(i)).norm(), 1e-7);
    }
  }
}

}  // namespace
}  // namespace marey::reconstruct
