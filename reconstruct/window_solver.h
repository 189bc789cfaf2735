// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: all frames of a trial together, window by window.

#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "reconstruct/body_model.h"
#include "reconstruct/posture_doubt.h"
#include "reconstruct/tag_slip.h"

namespace marey::reconstruct {

struct WindowSize {
  std::size_t frames = 90;
  std::size_t overlap = 30;  ///< Frames that the next window solves again.
};

/// Moves tracked postures to the least reprojection over overlapping windows in which all
/// frames move together, and with them the cameras' clocks. Borrows everything.
class WindowSolver {
 public:
  /// `offsets_s` per camera; those with `given` stay. `postures` one per frame.
  WindowSolver(const BodyModel& model,
               std::span<const Camera> cameras,
               const Sightings& sightings,
               std::vector<double> offsets_s,
               std::vector<bool> given,
               std::vector<Posture>& postures);

  /// One constant per camera, from the stretch with most movement. Does nothing when all
  /// are given.
  void estimate_offsets();

  /// All windows in turn: a window's first frames continue the one before, which is final
  /// by then. Then again, with what was found of how tags slip. `progress` counts frames.
  /// False when a window has no usable minimum.
  [[nodiscard]] bool solve(const WindowSize& size, const Progress& progress);

  /// Solves the frames from `first` on again, starting from `candidate`, with the two
  /// neighbours on each side held; `candidate` becomes the solution, the postures stay.
  /// Returns by how much it costs more than they do (half of the sum of squares in
  /// sigmas): negative where it explains the frames better. nullopt when it has no usable
  /// minimum. Precondition: solve() has returned true.
  [[nodiscard]] std::optional<double> solve_again(std::size_t first,
                                                  std::vector<Posture>& candidate);

  /// Distance from where the camera saw each corner of a sighting to where it should have
  /// at its own time; empty for a tag behind the camera. [px]
  [[nodiscard]] std::vector<double> errors_px(std::size_t frame,
                                              std::size_t sighting) const;

  [[nodiscard]] const std::vector<double>& offsets_s() const { return offsets_s_; }
  /// 0 where the offset is given.
  [[nodiscard]] const std::vector<double>& clock_sigmas_s() const {
    return clock_sigmas_s_;
  }
  [[nodiscard]] const std::vector<bool>& offset_given() const { return given_; }
  /// Per frame, of the windows' covariance, scaled by what is left; after solve().
  [[nodiscard]] const std::vector<BoneSigmas>& sigmas() const { return sigmas_; }
  /// Likewise of the tags where the posture carries them, without their slip.
  [[nodiscard]] const std::vector<TagSigmas>& tag_sigmas() const { return tag_sigmas_; }
  /// Of each segment's tags; after solve().
  [[nodiscard]] const SlipSigmas& slips_m() const { return slips_m_; }

 private:
  void find_velocities();
  void find_clock_sigmas(std::span<Posture> postures, ceres::Problem& problem);
  [[nodiscard]] std::size_t liveliest(std::size_t count) const;
  [[nodiscard]] bool pass(const WindowSize& size,
                          SlipEstimate& estimate,
                          const Progress& progress);
  [[nodiscard]] bool weigh(std::size_t first,
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
  /// How fast each corner of each sighting of each frame crosses its image. [px/s]
  std::vector<std::vector<std::array<glm::dvec2, 4>>> velocities_;
  std::vector<BoneSigmas> sigmas_;
  std::vector<TagSigmas> tag_sigmas_;
  SlipSigmas slips_m_{};
  /// Of the sightings of a window, by its frame.
  struct Weighed {
    ceres::ResidualBlockId id = nullptr;
    TagSlip slip;
    HumanBone bone{};
  };
  std::vector<std::vector<Weighed>> weighed_;
};

}  // namespace marey::reconstruct
