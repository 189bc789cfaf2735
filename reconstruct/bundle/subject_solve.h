// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the joint refinement of fit_subject(): equations of a subject's
// bundle, their steps, and the descent.

#include <optional>
#include <span>
#include <vector>

#include "reconstruct/bundle/subject_bundle.h"
#include "reconstruct/bundle/subject_priors.h"
#include "reconstruct/bundle/subject_sight.h"

namespace marey::reconstruct {

/// Twist priors of a frame that is solved alone.
inline constexpr TwistPriors kFrameTwists{};

/// Returns the posture's columns that do not belong to the limb: not to its frame, its
/// bends and twists, and not to its extremity.
[[nodiscard]] std::vector<int> columns_outside(std::size_t limb);

/// Free unknowns of a solve.
struct BundleFreedom {
  /// Only this limb: its frame, bends, twists and extremity in every frame, its two
  /// lengths and its tags. All others are held. nullopt: everything is free.
  std::optional<std::size_t> limb;
  /// Starts from an initial estimate: steps are damped, so that they stay near its
  /// minimum.
  bool is_first = false;
};

/// Linearizes a bundle and solves for its steps.
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
  /// Eliminates all postures and returns the subject's equations. False if they are
  /// singular.
  [[nodiscard]] bool reduce(Linear& linear, double damping, SubjectSystem& out) const;
  /// Computes the step down. False if the equations are not positive definite.
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
  double frames_ = 1.0;    ///< All frames: they share the pose priors.
  double standing_ = 1.0;  ///< Standing frames: they share the standing terms.
  bool slides_ = false;
  std::vector<int> held_posture_;
  std::vector<bool> held_subject_;  ///< Empty: none.
};

/// Moves lengths, tag poses and postures to the nearest minimum of the robust cost
/// (Levenberg-Marquardt; a tag's eight residuals together have a Cauchy loss at 5 sigma),
/// and returns it; nullopt if the equations have no solution. Some 0.3 ms per frame and
/// iteration. Precondition: every tag of the model is sighted in some frame of the
/// bundle.
std::optional<double> adjust(SubjectBundle& bundle,
                             std::span<const Camera> cameras,
                             int max_iterations,
                             const BundleFreedom& freedom = {});

/// Returns the present cost of the bundle: half the squares of all terms.
[[nodiscard]] double cost_of(const SubjectBundle& bundle,
                             std::span<const Camera> cameras);

}  // namespace marey::reconstruct
