// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the linear steps of a subject's bundle.

#include <span>
#include <vector>

#include "reconstruct/subject_bundle.h"
#include "reconstruct/subject_priors.h"

namespace marey::reconstruct {

/// Of a frame by itself.
inline constexpr TwistHabits kFrameTwists{};

/// Of a tag behind the camera that saw it: wrong, but not impossible to leave.
inline constexpr double kBehind2 = 8e6;

/// Half the robust square of a tag's eight residuals (Cauchy's loss), and its weight in
/// the normal equations.
[[nodiscard]] double robust_cost(double squared);
[[nodiscard]] double robust_weight(double squared);

/// Returns the posture's columns that do not belong to the limb: neither to its frame,
/// its bends and twists nor to its extremity.
[[nodiscard]] std::vector<int> columns_outside(std::size_t limb);

class BundleSolver {
 public:
  BundleSolver(const SubjectBundle& bundle,
               std::span<const Camera> cameras,
               const BundleFreedom& freedom);

  /// All equations at one state of the bundle.
  struct Linear {
    std::vector<FrameEquations> frames;
    SubjectSystem subject;
    double cost = 0.0;
  };
  struct Step {
    Eigen::VectorXd subject;
    std::vector<PostureVector> postures;
  };

  /// Fills `out`; returns its cost.
  double linearise(const SubjectBundle& bundle, Linear& out) const;
  /// The subject's equations once all postures are free. False where they have none.
  [[nodiscard]] bool reduce(Linear& linear, double damping, SubjectSystem& out) const;
  /// The step down. False where the equations are not positive definite.
  [[nodiscard]] bool step(Linear& linear, double damping, Step& out) const;
  void move(const Step& step, SubjectBundle& bundle) const;

  [[nodiscard]] const SubjectColumns& columns() const { return columns_; }

 private:
  void hold_all_but(std::size_t limb, const BodyModel& model);
  void linearise_frame(const SubjectBundle& bundle,
                       const BundleFrame& frame,
                       FrameEquations& out) const;

  SubjectSight sight_;
  SubjectColumns columns_;
  double frames_ = 1.0;    ///< That say the same of habits,
  double standing_ = 1.0;  ///< and of how a person stands.
  bool slides_ = false;
  std::vector<int> held_posture_;
  std::vector<bool> held_subject_;  ///< Empty: none.
};

}  // namespace marey::reconstruct
