// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the normal equations of a subject's fit. Frames are coupled
// only through the subject, so each is eliminated separately (Schur complement; Triggs et
// al. 2000, section 6.1), and within a frame each limb before the trunk.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "reconstruct/bundle/subject_sight.h"
#include "reconstruct/posture/posture_equations.h"

namespace marey::reconstruct {

/// Derivative of a tag's place by its slide rates in one frame.
struct FrameSlide {
  int tag_column = 0;
  int slide_column = 0;
  SlideAngles factors{};  ///< [rad]
};

/// One frame's equations over its posture and the subject's unknowns, and their
/// elimination. In one frame a tag's slide is a shift of its place: its rates enter only
/// when the frame's equations are added to the subject's.
class FrameEquations {
 public:
  PostureEquations posture;

  /// Empties the equations; `columns` are the subject's columns that the frame's tags
  /// depend on, without slides.
  void begin(std::vector<int> columns, std::vector<FrameSlide> slides, int subject_size);
  void add(const SightedTag& sighted, int tag_column, double weight);
  /// Holds these unknowns of the posture.
  void hold(std::span<const int> posture_columns);

  /// Eliminates the frame's posture and adds the frame's information on the subject to
  /// its `hessian` (lower triangle) and `gradient`. False if the posture is not
  /// determined.
  [[nodiscard]] bool eliminate(double damping,
                               Eigen::MatrixXd& hessian,
                               Eigen::VectorXd& gradient);
  /// Computes the posture's step for a step of the subject. Precondition: eliminate().
  void step(const Eigen::VectorXd& subject, PostureVector& out) const;

  /// Adds to `out`, a derivative by the subject's unknowns (three rows), the derivative
  /// of a point of the body: directly (`by_shape`), and through the frame's posture with
  /// its sightings unchanged. Precondition: eliminate().
  void add_response(const SparseDerivative& by_posture,
                    const SparseDerivative& by_shape,
                    Eigen::MatrixXd& out) const;
  /// Adds to `out`, three rows, the subject's gradient for a shift of the root of a limb
  /// by each column of `shifts_in_world` [m] that the model does not contain.
  /// Precondition: eliminate().
  void add_root_shift(std::size_t limb,
                      const Eigen::Matrix3d& shifts_in_world,
                      Eigen::MatrixXd& out) const;

 private:
  /// A subject's column that a local column adds to, with a factor.
  struct Target {
    int column = 0;
    double factor = 1.0;
  };
  struct Part {
    Eigen::LLT<Eigen::MatrixXd> own;
    std::vector<int> columns;  ///< Local columns, of columns_, that the part depends on.
    Eigen::MatrixXd solved;    ///< L^-1 of [by trunk | by subject | gradient].
  };
  [[nodiscard]] bool eliminate_limb(std::size_t limb,
                                    double damping,
                                    Eigen::MatrixXd& trunk);
  void add_to(Eigen::MatrixXd& hessian, Eigen::VectorXd& gradient) const;
  using Pull = Eigen::Matrix<double, kPostureFreedom, 3>;
  void add_pull(const Pull& pull, Eigen::MatrixXd& local) const;
  void spread(const Eigen::MatrixXd& local, Eigen::MatrixXd& out) const;
  [[nodiscard]] std::span<const Target> targets_of(std::size_t local) const {
    return std::span(targets_).subspan(first_target_[local],
                                       first_target_[local + 1] - first_target_[local]);
  }

  std::vector<int> columns_;  ///< The subject's columns of this frame.
  std::vector<FrameSlide> slides_;
  std::vector<Target> targets_;
  std::vector<std::size_t> first_target_;  ///< First target of each of columns_, and the
                                           ///< end.
  std::vector<int> local_;    ///< Position of each of the subject's columns in columns_;
                              ///< -1 if absent.
  Eigen::MatrixXd cross_;     ///< Posture's unknowns by columns_.
  Eigen::MatrixXd subject_;   ///< columns_ by columns_, lower triangle.
  Eigen::VectorXd gradient_;  ///< Gradient by columns_.
  /// Per limb: which of columns_ it depends on.
  std::array<std::vector<bool>, 4> follows_;
  /// Derivatives of the posture's and the subject's gradients by a shift of each limb's
  /// root.
  std::array<Pull, 4> posture_by_root_;
  std::array<Eigen::MatrixXd, 4> subject_by_root_;
  std::array<Part, 4> limbs_;
  Part trunk_;
};

}  // namespace marey::reconstruct
