// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "library/features/level_frame.h"

#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Measures of one frame from which relations follow. Lengths in leg lengths. nullopt:
/// the body lacks the bones.
struct RelationMeasures {
  struct Side {
    std::optional<double> hand_over_head;
    std::optional<double> hand_over_shoulder;
    std::optional<double> hand_over_elbow;
    std::optional<double> hand_before_trunk;
    double ankle_forward = 0.0;
    double knee_rad = 0.0;
    double foot_height = 0.0;  ///< Lower one of ankle and toes, over its rest.
  };
  std::array<Side, 2> sides;  ///< Left, right.
  std::optional<double> hands_apart;
  double hip_height = 0.0;
  std::optional<double> trunk_elevation_rad;
  double speed = 0.0;      ///< [L/s]
  double turn_rate = 0.0;  ///< Positive to the left. [rad/s]
};

/// Computes the measures of every frame; see find_relations().
[[nodiscard]] std::vector<RelationMeasures> measure_relations(
    const Motion& motion, const retarget::BodyMap& map, const Contacts& contacts);

}  // namespace marey::library
