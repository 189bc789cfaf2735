// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "benchmarks/adaptation/picture_scene.h"
#include "core/character.h"
#include "core/character_spec.h"
#include "core/constraint.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "recordings/body/mannequin.h"
#include "retarget/adapt/adapter.h"

namespace marey {

/// Makes the person of a picture. Prints the error and exits when it is no character.
[[nodiscard]] Character make_actor(const recordings::MannequinOptions& body = {},
                                   const CharacterTraits& traits = {});

/// Turns the bone from where its parent has it, about `axis` of the T-pose's axes.
void turn(Pose& pose,
          const Character& character,
          HumanBone bone,
          double angle_deg,
          const glm::dvec3& axis);

/// At ease: arms hang a little bent, knees give by `knee_deg`, soles on the floor.
[[nodiscard]] Pose standing(const Character& character, double knee_deg = 12.0);

[[nodiscard]] glm::dvec3 place_of(const Character& character,
                                  const Pose& pose,
                                  HumanBone bone);
[[nodiscard]] glm::dvec3 centre_of_mass(const Character& character,
                                        const Pose& pose,
                                        bool with_loads = false);

/// The joint of `bone` is wanted at `p_in_world`; its id is the bone's name.
[[nodiscard]] Constraint contact(HumanBone bone,
                                 const glm::dvec3& p_in_world,
                                 double importance = 1.0);
/// The foot stays where the reference has it, or stands on `footprint_in_world`.
[[nodiscard]] Constraint stance(
    HumanBone foot, const std::optional<glm::dvec3>& footprint_in_world = std::nullopt);

struct Adapted {
  Pose pose;
  glm::dvec3 com_in_world{0.0};  ///< Centre of mass of the body with its loads.
  retarget::AdaptReport report;
};

/// Adapts one posture with all loads of the character. Prints its errors on standard
/// output. Prints the error and exits when the adapter refuses.
[[nodiscard]] Adapted adapted(std::string_view who,
                              const Character& character,
                              const Pose& reference,
                              const ConstraintSet& constraints,
                              const retarget::AdaptOptions& options);

/// The centre of mass as a ball, with a plumb line to the floor. [m]
void show_centre_of_mass(PictureScene& scene,
                         const glm::dvec3& com_in_world,
                         Paint paint,
                         double floor_m = 0.0);

}  // namespace marey
