// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "benchmarks/adaptation/picture_scene.h"

/// The figures of docs/adaptation.md, after figures of Kulpa 2005. Each function prints
/// the errors of its postures.
namespace marey {

inline constexpr double kTarget_m = 0.045;  ///< Radius of the balls.
/// Place of the label of a figure that stands at Z = 0, from the figure's place.
inline constexpr glm::dvec3 kLabel{0, -0.10, 0.1};
/// View from the right side: a person facing +Z looks to the right of the picture.
inline constexpr PictureView kSide{-78.0, 7.0};

[[nodiscard]] PictureScene draw_control();      ///< Figure 3.7: priority and blend.
[[nodiscard]] PictureScene draw_root_share();   ///< 4.11: how far the root goes along.
[[nodiscard]] PictureScene draw_flexibility();  ///< 4.13: bending by hamstrings.
[[nodiscard]] PictureScene draw_stair();        ///< 4.18: a walk onto a step.
[[nodiscard]] PictureScene draw_balance();      ///< 5.1: reaching far.
[[nodiscard]] PictureScene draw_strategies();   ///< 5.5: groups or root keep the balance.
[[nodiscard]] PictureScene draw_crowd();        ///< 7.3: other bodies, the same targets.
[[nodiscard]] PictureScene draw_loads();        ///< 7.5: loads in the hands.

}  // namespace marey
