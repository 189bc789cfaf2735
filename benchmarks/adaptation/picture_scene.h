// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "recordings/body/mesh.h"

namespace marey {

/// Colours in addition to the mannequin's own. Marks inside a body are drawn through its
/// surface.
enum class Paint {
  kTarget,        ///< Target of a point.
  kOtherTarget,   ///< Target of another point.
  kCentreOfMass,  ///< Centre of mass of the posture. Inside a body.
  kWantedCentre,  ///< Target of the centre of mass. Inside a body.
  kGround,
  kPath,
  kLoad,
};

/// Direction from which a picture is taken, without perspective.
struct PictureView {
  double azimuth_deg = 0.0;    ///< From +Z, in front of a body that faces +Z, to +X.
  double elevation_deg = 8.0;  ///< Above the horizontal.
};

/// Posed bodies and marks without motion, as one mesh.
class PictureScene {
 public:
  PictureScene(std::string name, PictureView view);

  /// Returns the shift along the floor that is `way_m` to the right in the picture. [m]
  [[nodiscard]] glm::dvec3 to_the_right(double way_m) const;

  /// Adds a mannequin in `pose`, shifted by `shift_m`.
  /// Precondition: the skeleton is one of make_humanoid()'s.
  void add_body(const Skeleton& skeleton, const Pose& pose, const glm::dvec3& shift_m);
  void add_ball(const glm::dvec3& centre_in_world, double radius_m, Paint paint);
  /// Adds a straight round rod. Precondition: the ends are apart.
  void add_rod(const glm::dvec3& from_in_world,
               const glm::dvec3& to_in_world,
               double radius_m,
               Paint paint);
  void add_box(const glm::dvec3& min_in_world,
               const glm::dvec3& max_in_world,
               Paint paint);
  /// Adds text that faces the viewer, centred at `p_in_world`.
  void add_label(std::string text, const glm::dvec3& p_in_world);

  /// Writes `folder`/NAME.glb, and NAME.json with view and labels.
  [[nodiscard]] Status write(const std::filesystem::path& folder) const;

 private:
  struct Label {
    std::string text;
    glm::dvec3 p_in_world;
  };
  /// A surface of revolution about the way from `from` to `to`.
  struct ProfilePoint {
    double along_m;
    double radius_m;
    double slope_along;  ///< Component of the normal along the axis, -1 to 1.
  };
  void add_turned(const glm::dvec3& from_in_world,
                  const glm::dvec3& axis,
                  const std::vector<ProfilePoint>& profile,
                  Paint paint);
  void add_vertex(const glm::dvec3& p_in_world, const glm::dvec3& normal_in_world);

  std::string name_;
  PictureView view_;
  recordings::SkinnedMesh mesh_;
  std::vector<Label> labels_;
};

}  // namespace marey
