// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: re-acquisition of a posture from markers, without a prior.

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "reconstruct/markers/marker_model.h"

namespace marey::reconstruct {

struct FoundPosture {
  Posture posture;
  double cost = 0.0;  ///< MarkerFrameSolver's, without a prior.
};

/// Finds postures without a prior: aligns a standing, a sitting and a T-posed body with
/// the markers, minimizes the cost of each, and tries limbs that do not fit in other
/// attitudes. Allocates in the constructor, not in find(). Borrows the model.
class MarkerPoseRelocalizer {
 public:
  explicit MarkerPoseRelocalizer(const MarkerModel& model);

  /// Finds the posture. Some 10 ms with 50 markers. Precondition: three markers or more.
  [[nodiscard]] FoundPosture find(std::span<const SeenMarker> seen);

  /// Finds the posture from one that should be near, and without a prior if it is not.
  [[nodiscard]] FoundPosture find_near(const Posture& near,
                                       std::span<const SeenMarker> seen);

 private:
  [[nodiscard]] Posture laid_on(const Posture& attitude,
                                std::span<const SeenMarker> seen);
  void retry_limbs(std::span<const SeenMarker> seen, FoundPosture& best);
  [[nodiscard]] bool misfits(std::span<const SeenMarker> seen, const Posture& posture);
  [[nodiscard]] bool limb_misfits(std::size_t limb,
                                  std::span<const SeenMarker> seen,
                                  const Posture& posture);
  [[nodiscard]] double anneal(std::span<const SeenMarker> seen,
                              double first_scale,
                              Posture& posture);

  const MarkerModel* model_;
  MarkerFrameSolver solver_;
  std::vector<glm::dvec3> p_in_body_;
  std::vector<glm::dvec3> p_in_world_;
  std::vector<double> weights_;
};

}  // namespace marey::reconstruct
