// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/human/contacts.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/foot_place.h"

namespace marey::edit {

/// One place per frame; nullopt: the foot stays where it is.
using HeldFoot = std::vector<std::optional<retarget::FootPlace>>;

/// Returns where a foot must be so that it stands where it stood before a filter.
///
/// The ankle in contacts of the heel, the toe joint in contacts of the ball, and the
/// rotations of a flat foot and of toes on the floor are those before the filter,
/// smoothed within each contact apart (smooth_runs.h): a foot that stands still stays to
/// rounding, and the swing has no effect on it. Within 25 ms of an impact the foot goes
/// over to its unfiltered path. Between
/// contacts the displacement fades within 0.1 s with continuous speed. `before` and
/// `after` hold the foot in each frame. Linear in frames.
[[nodiscard]] HeldFoot held_foot(std::span<const retarget::FootPlace> before,
                                 std::span<const retarget::FootPlace> after,
                                 const FootContacts& contacts,
                                 const retarget::FootMap& foot,
                                 std::span<const int> impacts,
                                 double hz);

}  // namespace marey::edit
