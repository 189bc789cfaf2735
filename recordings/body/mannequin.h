// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/skeleton.h"
#include "recordings/body/mesh.h"

namespace marey::recordings {

/// Deviation of a body from the average adult. Each ratio is relative to the average body
/// of the same stature, before the whole is scaled to `stature_m`: arm = 1.2 alone makes
/// the arms a fifth longer and leaves the rest; leg = 1.2 also makes the trunk smaller,
/// because the stature is fixed.
struct MannequinOptions {
  double stature_m = 1.75;      ///< Floor to top of the head.
  double arm = 1.0;             ///< Upper arm, forearm and hand.
  double leg = 1.0;             ///< Thigh and shank.
  double foot = 1.0;            ///< Length of the foot; its height is fixed.
  double trunk = 1.0;           ///< Hips to neck.
  double head = 1.0;            ///< Neck and head.
  double shoulder_width = 1.0;  ///< Width between the shoulder joints.
  double hip_width = 1.0;       ///< Width between the hip joints.
};

/// Returns the proportions of a body. The height of its toe joints, as a fraction of the
/// stature before scaling, is the average adult's. Precondition: every option > 0.
[[nodiscard]] Proportions mannequin_proportions(const MannequinOptions& options);

struct MannequinStyle {
  /// Thickness factor of every part; 1 is lean.
  double girth = 1.0;
  glm::dvec3 body_colour{0.58, 0.40, 0.235};  ///< Linear RGB.
  glm::dvec3 joint_colour{0.115, 0.13, 0.16};
  glm::dvec3 mark_colour{0.75, 0.16, 0.05};  ///< Nose and chest marker: shows the front.
};

/// Creates an artist's mannequin bound to make_humanoid(proportions): closed surfaces
/// with spheres at the joints, skinned so that limbs and trunk bend smoothly. Supports
/// any proportions, including asymmetric ones and limbs off the axes; thickness follows
/// the size of the whole body, not the length of the part. Soles are at Y = 0, except
/// those of a foot whose toe joint is not at its standard height above the floor (within
/// 2 % of the stature). About 14 000 triangles. Same input, same bytes. Preconditions:
/// girth > 0; the top of the head is above the feet.
[[nodiscard]] SkinnedMesh make_mannequin_mesh(const Proportions& proportions,
                                              const MannequinStyle& style = {});

}  // namespace marey::recordings
