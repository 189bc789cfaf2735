// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the posture of a frame of which nothing is known but markers.

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "reconstruct/marker_model.h"

namespace marey::reconstruct {

struct FoundPosture {
  Posture posture;
  double cost = 0.0;  ///< MarkerFrameSolver's, without a prior.
};

/// Finds postures from nothing: the body is laid onto the markers standing, sitting and
/// with its arms out, moved to fit, and limbs that do not are tried in other attitudes.
/// Allocates when it is made, not when it finds. Borrows the model.
class PostureFinder {
 public:
  explicit PostureFinder(const MarkerModel& model);

  /// Some 10 ms with 50 markers. Precondition: three markers or more.
  [[nodiscard]] FoundPosture find(std::span<const SeenMarker> seen);

  /// The same from a posture that should be near, and from nothing where it is not.
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
