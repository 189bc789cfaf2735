// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "core/constraint.h"

namespace marey {

/// A point that does not move. Positions of paths are in SceneTarget::frame.
struct FixedPath {
  glm::dvec3 position_m{0.0};
};

/// middle + amplitude * sin(2 pi frequency t + phase), for each axis; t: time of the
/// scene.
struct LissajousPath {
  glm::dvec3 middle_m{0.0};
  glm::dvec3 amplitude_m{0.0};
  glm::dvec3 frequency_hz{0.0};
  glm::dvec3 phase_rad{0.0};
};

/// Course between the points of a polyline.
enum class PathCourse {
  kLinear,  ///< Constant speed.
  kSmooth,  ///< smooth_step(): at rest at every point, with continuous acceleration.
  kHold,    ///< Stays, then jumps to the next point at its time.
};

/// Points over time. Before the first and after the last one the target rests.
struct PolylinePath {
  std::vector<double> times_s{};  ///< Ascending, at least one.
  std::vector<glm::dvec3> positions_m;
  PathCourse course = PathCourse::kLinear;
};

/// A point of another body. Several bodies (a group) use it member by member: the k-th
/// user has the k-th body; a single body serves all users.
struct BodyPointPath {
  std::string body{};  ///< Id of a body, of a group or of a member.
  BodyPoint point{};
  /// The point is that of the step before, so that bodies may depend on each other.
  bool last_step = false;
};

using TargetPath = std::variant<FixedPath, LissajousPath, PolylinePath, BodyPointPath>;

enum class TargetFrame {
  kWorld,
  /// Each user's own start: its place on the floor and its heading.
  kBody,
};

/// A target that actions and figures refer to.
struct SceneTarget {
  std::string id{};
  TargetPath path{};
  TargetFrame frame = TargetFrame::kWorld;
  /// With TargetFrame::kBody: positions are those for a body of this stature. They are
  /// multiplied by the user's stature divided by this one. nullopt: metres for every
  /// body.
  std::optional<double> for_stature_m{};
  /// On the page, a user can drag it; the path no longer applies from then on. Never true
  /// for a BodyPointPath.
  bool drag = false;
  int line = 0;  ///< In the scene's file; 0: unknown.
};

/// Returns the position on a path at a time of the scene, in the target's frame [m];
/// nullopt for a BodyPointPath. Logarithmic in the number of points.
[[nodiscard]] std::optional<glm::dvec3> path_at(const TargetPath& path, double time_s);

}  // namespace marey
