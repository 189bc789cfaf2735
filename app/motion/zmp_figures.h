// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dynamics/balance/support_polygon.h"
#include <nlohmann/json_fwd.hpp>

#include "core/character.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// Zero moment points of a motion.
struct MotionZmp {
  dynamics::ZmpFigures figures{};
  /// Centre of mass and zero moment point per frame, with the support area of contacts
  /// from strike to toe-off.
  std::vector<retarget::BalanceFrame> frames;
};

/// Computes the zero moment points of a motion, as `edit::zmp_track()`. Linear in frames.
/// Precondition: `map`, `contacts` and `masses` belong to the motion; the sum of the
/// masses is above 0.
[[nodiscard]] MotionZmp motion_zmp(const Motion& motion,
                                   const retarget::BodyMap& map,
                                   const Contacts& contacts,
                                   std::span<const PointMass> masses);

/// Applies motion_zmp() with detected contacts and the masses of de Leva's table.
/// nullopt: the body has no legs or masses, or the motion fewer than two frames.
[[nodiscard]] std::optional<MotionZmp> find_motion_zmp(const Motion& motion);

/// Returns the figures for reports: loaded_frames, supported_frames, outside_frames,
/// inside_percent, worst_outside_mm, worst_frame (absent if no point is outside).
[[nodiscard]] nlohmann::ordered_json zmp_json(const dynamics::ZmpFigures& figures);

}  // namespace marey::app
