// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "retarget/adapter.h"
#include "retarget/crowd.h"
#include "tests/support/random_bodies.h"

/// Crowds for tests: bodies of one structure and of different measures, and what is
/// asked of them from moment to moment.
namespace marey::retarget {

/// What is asked of one body at one moment.
struct CrowdQuestion {
  Pose reference;
  ConstraintSet wishes;  ///< Targets of this moment.
  std::optional<glm::dvec3> com_in_world;
};

struct CrowdMember {
  Character character;
  ConstraintSet wishes;                  ///< As the adapter is made with them.
  bool carries = false;                  ///< The first of its loads.
  std::vector<CrowdQuestion> questions;  ///< One per moment.
};

/// Which wishes the members have.
enum class CrowdWishes {
  kHands,       ///< Contacts of three importances, near to beyond reach.
  kSupports,    ///< A foot on a footprint, one where it began, a far hand.
  kRelations,   ///< Distances, spaces and orientations.
  kFading,      ///< As kHands; one in three members has one that comes and goes.
  kNobodyAsks,  ///< Wishes that are met already, or not active yet.
};

/// `count` bodies like `body`: every bone, mass and limit of its own. Humans and
/// quadrupeds that are make_quadruped()'s. The last moment asks as the first did.
[[nodiscard]] std::vector<CrowdMember> make_members(const Character& body,
                                                    CrowdWishes wishes,
                                                    std::size_t count,
                                                    std::size_t moments,
                                                    testing::Dice& dice);

/// Tells the adapter what is asked at a moment.
void ask(const CrowdQuestion& question, Adapter& adapter);

/// All that an adapter has to say.
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
/// What differs first, to the bit; empty: nothing.
[[nodiscard]] std::string difference(const CrowdAnswer& a, const CrowdAnswer& b);

/// Those that the processor at hand has.
[[nodiscard]] std::vector<LaneWidth> lane_widths();

}  // namespace marey::retarget
