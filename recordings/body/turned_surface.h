// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "recordings/body/mesh.h"

namespace marey::recordings {

/// Returns the skin weights of some bones of make_humanoid()'s skeleton: scaled to sum 1,
/// largest first. Precondition: at most four weights above zero, at least one, bones
/// distinct.
[[nodiscard]] SkinWeights carried_by(
    std::initializer_list<std::pair<HumanBone, double>> bones);

/// A cross-section of a turned surface: a superellipse |x/a|^n + |y/b|^n = 1.
struct Ring {
  glm::dvec3 centre{0.0};
  glm::dvec3 along{0.0, 1.0, 0.0};  ///< Unit vector towards the next ring.
  glm::dvec3 front{0.0, 0.0, 1.0};  ///< Unit vector perpendicular to `along`.
  double half_width = 0.0;          ///< a, along front x along. [m]
  double half_depth = 0.0;          ///< b, along front. [m]
  /// n: 2 is an ellipse, a larger one is more rectangular.
  double exponent = 2.0;
  SkinWeights skin;
  std::size_t part = 0;  ///< MeshPart of the band from this ring to the next.
};

/// Collects closed surfaces into one mesh.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::vector<MeshMaterial> materials);

  /// Adds the surface through `rings`, closed by a fan at both ends. The first and last
  /// ring shrink to their centres. Returns the range of the new vertices: [first,
  /// second). Preconditions: at least three rings; `segments` is a multiple of four, so
  /// that the four extremes of a ring are vertices.
  std::pair<std::size_t, std::size_t> add_turned(std::span<const Ring> rings,
                                                 std::size_t segments);

  /// Adds an ellipsoid with the axis `along`, its half-axes as in Ring plus `half_height`
  /// along the axis. Uses `frame`'s centre, axes, widths, skin and part.
  void add_ellipsoid(const Ring& frame, double half_height, std::size_t segments);

  [[nodiscard]] SkinnedMesh& mesh() { return mesh_; }

 private:
  void add_ring(const Ring& ring, std::size_t segments);
  void add_pole(const Ring& ring);
  void add_triangle(std::size_t part, std::size_t a, std::size_t b, std::size_t c);
  void finish_normals(std::size_t first);

  SkinnedMesh mesh_;
};

}  // namespace marey::recordings
