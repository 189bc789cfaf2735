// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "dynamics/balance/support_polygon.h"
#include "dynamics/balance/zero_moment_point.h"
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/time.h"

namespace marey::dynamics {

struct KeepZmpOptions {
  ZmpOptions zmp{};  ///< Options of ground_reactions().
  /// Distance that zero moment points keep from the edges of the support area, at most a
  /// quarter of the area's width.
  double margin_m = 0.010;
  /// Weight of the acceleration of the displacement against the displacement. [s^2]
  double smoothness_s2 = 0.1;
  /// Factor of that weight in flight, where no force can act on the centre of mass.
  double flight_factor = 10.0;
  /// Largest displacement along X and along Z, `displaced_xz_m` included.
  double max_shift_m = 0.25;
  /// Price of a metre outside, per frame, against square metres of displacement. The
  /// default leaves no frame outside if that is possible.
  double price_m = 100.0;
  /// Larger displacements than this are made only if they leave no frame outside;
  /// otherwise the price is reduced, twice at most.
  double modest_shift_m = 0.15;
  int max_iterations = 80;
};

/// One motion. Spans have one value per frame; the last two may be empty.
struct KeepZmpInput {
  std::span<const glm::dvec3> com_in_world;
  std::span<const GroundReaction> reactions;
  std::span<const SupportPolygon> supports;
  FrameRate rate;
  /// Existing displacement of the centre of mass from the reference. The sum with the new
  /// one is kept small. Empty: none.
  std::span<const glm::dvec2> displaced_xz_m{};
  /// Effect on each frame, 0 to 1: at 0 a frame is not displaced, and its zero moment
  /// point is not considered. Empty: 1 everywhere.
  std::span<const double> freedom{};
};

struct KeepZmpResult {
  /// Displacement of the centre of mass to add, per frame, X and Z. [m]
  std::vector<glm::dvec2> shift_xz_m;
  /// Loaded frames with a support area whose predicted zero moment point stays outside.
  std::vector<int> unmet_frames;
  double worst_unmet_m = 0.0;  ///< Largest distance outside among these.
  /// Loaded frames without a support area, or with a point or a line; not considered.
  int without_area_frames = 0;
  double max_shift_m = 0.0;  ///< Largest displacement, `displaced_xz_m` included.
  double price_m = 0.0;      ///< Price at which the displacement was computed.
  int iterations = 0;
};

/// Computes the smallest smooth horizontal displacement d(t) of the centre of mass that
/// puts the zero moment point into the support area, smaller by a margin, in every frame
/// that is loaded: minimises the sum of d^2 and (smoothness * second derivative of d)^2,
/// and its speed at both ends.
/// A displacement moves the zero moment point by d - (height / (vertical acceleration +
/// gravity)) * second derivative of d, with the derivative of ground_reactions(), so the
/// problem is a convex quadratic programme. It is solved for both axes at once by an
/// interior-point method whose steps are solved by a band matrix. Distances to the areas
/// that cannot be overcome within max_shift_m are kept small in sum and reported.
///
/// The displacement is 0 everywhere if all points are inside already. Deterministic.
/// Linear in frames; quadratic in frames per window of derivatives.
/// Preconditions: rate and smoothness above 0; reactions are those of ground_reactions()
/// with options.zmp; `displaced_xz_m` and `freedom` have a value per frame or are empty.
[[nodiscard]] KeepZmpResult keep_zmp(const KeepZmpInput& input,
                                     const KeepZmpOptions& options = {});

}  // namespace marey::dynamics
