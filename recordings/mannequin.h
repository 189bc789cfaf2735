// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/skeleton.h"
#include "recordings/mesh.h"

namespace marey::recordings {

/// How a body differs from the average adult. Each ratio is against the average body of
/// the same stature, before the whole is scaled to `stature_m`: arm = 1.2 alone gives
/// arms a fifth longer and leaves the rest; leg = 1.2 makes the trunk smaller in turn,
/// because the stature stays.
struct MannequinOptions {
  double stature_m = 1.75;      ///< Floor to top of the head.
  double arm = 1.0;             ///< Upper arm, forearm and hand.
  double leg = 1.0;             ///< Thigh and shank.
  double foot = 1.0;            ///< Length of the foot; its height stays.
  double trunk = 1.0;           ///< Hips to neck.
  double head = 1.0;            ///< Neck and head.
  double shoulder_width = 1.0;  ///< Breadth between the shoulder joints.
  double hip_width = 1.0;       ///< Breadth between the hip joints.
};

/// The proportions of such a body. Its toe joints stand as high above the floor, in parts
/// of the stature before scaling, as the average adult's.
/// Precondition: every option > 0.
[[nodiscard]] Proportions mannequin_proportions(const MannequinOptions& options);

struct MannequinStyle {
  double girth = 1.0;                         ///< Thickness of every part; 1 is lean.
  glm::dvec3 body_colour{0.58, 0.40, 0.235};  ///< Linear.
  glm::dvec3 joint_colour{0.115, 0.13, 0.16};
  glm::dvec3 mark_colour{0.75, 0.16, 0.05};  ///< Nose and breast: shows the front.
};

/// An artist's mannequin bound to make_humanoid(proportions): closed turned shapes with
/// balls at the joints, skinned so that limbs and trunk bend smoothly. Works for any
/// proportions, also unequal sides and limbs off the axes; thickness follows the size of
/// the whole body, not the length of the part. Soles are at Y = 0, except those of a foot
/// whose toe joint is not at its usual height above the floor (within 2 % of the
/// stature). About 14 000 triangles. Same input, same bytes. Precondition: girth > 0; the
/// top of the head is above the feet.
[[nodiscard]] SkinnedMesh make_mannequin_mesh(const Proportions& proportions,
                                              const MannequinStyle& style = {});

}  // namespace marey::recordings
