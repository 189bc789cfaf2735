// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: all frames of a trial together, window by window.

#include <optional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "reconstruct/tags/body_model.h"
#include "reconstruct/tags/posture_covariance.h"
#include "reconstruct/tags/soft_tissue_noise.h"

namespace marey::reconstruct {

struct WindowSize {
  std::size_t frames = 90;
  std::size_t overlap = 30;  ///< Frames that the next window solves again.
};

/// Minimizes the reprojection error of tracked postures, and the cameras' clock offsets,
/// over overlapping windows in which all frames are free. Borrows all arguments.
class WindowSolver {
 public:
  /// `offsets_s` has one entry per camera; those with `given` are held. `postures` has
  /// one entry per frame.
  WindowSolver(const BodyModel& model,
               std::span<const Camera> cameras,
               const Sightings& sightings,
               std::vector<double> offsets_s,
               std::vector<bool> given,
               std::vector<Posture>& postures);

  /// Estimates one constant offset per camera from the interval with most movement. Does
  /// nothing if all are given.
  void estimate_offsets();

  /// Solves all windows in order: a window's first frames continue the previous window,
  /// which is final by then. Then solves them again with the estimated slip of the tags.
  /// `progress` counts frames. False if a window has no usable minimum.
  [[nodiscard]] bool solve(const WindowSize& size, const Progress& progress);

  /// Solves the frames from `first` on again, starting from `candidate`, with the two
  /// neighbours on each side held; `candidate` becomes the solution, the postures stay.
  /// Returns the cost of the candidate minus that of the postures (half of the sum of
  /// squares in sigmas): negative if it explains the frames better. nullopt if it has no
  /// usable minimum. Precondition: solve() has returned true.
  [[nodiscard]] std::optional<double> solve_again(std::size_t first,
                                                  std::vector<Posture>& candidate);

  /// Computes the distance of each seen corner of a sighting from its expected position
  /// at the camera's own time; empty for a tag behind the camera. [px]
  [[nodiscard]] std::vector<double> errors_px(std::size_t frame,
                                              std::size_t sighting) const;

  [[nodiscard]] const std::vector<double>& offsets_s() const { return offsets_s_; }
  /// 0 if the offset is given.
  [[nodiscard]] const std::vector<double>& clock_sigmas_s() const {
    return clock_sigmas_s_;
  }
  [[nodiscard]] const std::vector<bool>& offset_given() const { return given_; }
  /// Per frame, from the windows' covariance, scaled by the residuals; valid after
  /// solve().
  [[nodiscard]] const std::vector<BoneSigmas>& sigmas() const { return sigmas_; }
  /// Sigmas of the tags as carried by the posture, without their slip; valid after
  /// solve().
  [[nodiscard]] const std::vector<TagSigmas>& tag_sigmas() const { return tag_sigmas_; }
  /// Slip of each segment's tags; valid after solve().
  [[nodiscard]] const SlipSigmas& slips_m() const { return slips_m_; }

 private:
  void find_velocities();
  void find_clock_sigmas(std::span<Posture> postures, ceres::Problem& problem);
  [[nodiscard]] std::size_t fastest_interval(std::size_t count) const;
  [[nodiscard]] bool pass(const WindowSize& size,
                          SlipEstimate& estimate,
                          const Progress& progress);
  [[nodiscard]] bool add_slip_evidence(std::size_t first,
                                       std::span<const Eigen::MatrixXd> covariances,
                                       ceres::Problem& problem,
                                       SlipEstimate& estimate);
  void build(std::size_t first,
             std::size_t count,
             std::size_t held,
             ceres::Problem& problem);
  void hold_offsets(bool all, ceres::Problem& problem);

  const BodyModel* model_;
  std::span<const Camera> cameras_;
  const Sightings* sightings_;
  std::vector<double> offsets_s_;
  std::vector<bool> given_;
  std::vector<double> clock_sigmas_s_;
  std::vector<Posture>* postures_;
  /// Image velocity of each corner of each sighting of each frame. [px/s]
  std::vector<std::vector<std::array<glm::dvec2, 4>>> velocities_;
  std::vector<BoneSigmas> sigmas_;
  std::vector<TagSigmas> tag_sigmas_;
  SlipSigmas slips_m_{};
  /// Residual blocks of a window's sightings, by its frame.
  struct TagResidualBlock {
    ceres::ResidualBlockId id = nullptr;
    TagSlip slip;
    HumanBone bone{};
  };
  std::vector<std::vector<TagResidualBlock>> residual_blocks_;
};

}  // namespace marey::reconstruct
