// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "retarget/adapt/adapter.h"
#include "retarget/adapt/crowd.h"
#include "tests/support/bodies/random_bodies.h"

/// Crowds for tests: bodies with one structure and different measures, and their inputs
/// at each moment.
namespace marey::retarget {

/// Inputs of one body at one moment.
struct CrowdQuestion {
  Pose reference;
  ConstraintSet wishes;  ///< Targets of this moment.
  std::optional<glm::dvec3> com_in_world;
};

struct CrowdMember {
  Character character;
  ConstraintSet wishes;                  ///< Constraints with which the adapter is made.
  bool carries = false;                  ///< Carries the first of its loads.
  std::vector<CrowdQuestion> questions;  ///< One per moment.
};

/// Types of the members' targets.
enum class CrowdTargets {
  kHands,      ///< Contacts of three importances, near to beyond reach.
  kSupports,   ///< A foot on a footprint, one where it began, a far hand.
  kRelations,  ///< Distances, spaces and orientations.
  kFading,     ///< As kHands; one in three members has one that fades in and out.
  kInactive,   ///< Targets that are met already, or not active yet.
};

/// `count` bodies like `body`, with individual bones, masses and limits. Humans, and
/// quadrupeds of make_quadruped(). The last moment equals the first.
[[nodiscard]] std::vector<CrowdMember> make_members(const Character& body,
                                                    CrowdTargets wishes,
                                                    std::size_t count,
                                                    std::size_t moments,
                                                    testing::Dice& dice);

/// Sets the inputs of a moment in the adapter.
void ask(const CrowdQuestion& question, Adapter& adapter);

/// Complete results of an adapter.
struct CrowdAnswer {
  Pose pose;
  AdaptReport report;
  std::vector<RigidTransform> world_from_joint;
  glm::dvec3 com_in_world{0.0};
  std::vector<ConstraintOutcome> outcomes;
};
[[nodiscard]] CrowdAnswer answer_of(Adapter& adapter,
                                    const ConstraintSet& wishes,
                                    const Pose& pose,
                                    const AdaptReport& report);
/// Returns the first difference, to the bit; empty if equal.
[[nodiscard]] std::string difference(const CrowdAnswer& a, const CrowdAnswer& b);

/// Returns the widths that this processor supports.
[[nodiscard]] std::vector<LaneWidth> lane_widths();

}  // namespace marey::retarget
