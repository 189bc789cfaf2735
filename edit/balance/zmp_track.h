// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "dynamics/balance/support_polygon.h"
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::edit {

/// Floor and feet against which zero moment points are judged.
struct ZmpGround {
  /// Contacts from strike to toe-off, or as detected where these are longer.
  Contacts loaded;
  double floor_height_m = 0.0;  ///< Height of the soles of standing feet, world Y.
};
/// Computes the ground from the contacts of retarget::detect_contacts(), whose edges move
/// to those of retarget::find_contact_edges(). Without contacts the floor is at 0. Linear
/// in frames. Precondition: `map` and `contacts` were made from the motion.
[[nodiscard]] ZmpGround zmp_ground(const Motion& motion,
                                   const retarget::BodyMap& map,
                                   const Contacts& contacts);

/// Zero moment points and support areas of a motion, one per frame.
struct ZmpTrack {
  std::vector<glm::dvec3> com_in_world;  ///< [m]
  std::vector<dynamics::GroundReaction> reactions;
  std::vector<dynamics::SupportPolygon> supports;  ///< As retarget::balance_frames().
};
/// Computes the track. Linear in frames. Preconditions: those of
/// dynamics::centroidal_states() and retarget::balance_frames().
[[nodiscard]] ZmpTrack zmp_track(const Motion& motion,
                                 const retarget::BodyMap& map,
                                 std::span<const PointMass> masses,
                                 const ZmpGround& ground);

}  // namespace marey::edit
