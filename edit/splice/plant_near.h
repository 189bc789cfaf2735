// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "edit/state/edit_state.h"
#include "edit/state/plant_feet.h"

#include "core/base/frame_range.h"
#include "retarget/feet/foot_place.h"

namespace marey::edit {

/// Report of plant_feet_near().
struct PlantNearReport {
  PlantReport plant;
  FrameRange changed;  ///< Frames whose feet may have moved; last < first: none.
};

/// Places of both feet, left and right, one per frame.
using FootWays = std::array<std::vector<retarget::FootPlace>, 2>;

/// Makes the feet stand still as plant_feet() does, but only in the stances that touch
/// the frames of `zone`, and in neighbours that follow within 0.15 s. The footprints are
/// those of `feet` in these stances; its other frames have no effect. Within the zone a
/// footprint does not turn, even if the foot does. The displacement of a foot at the
/// edges of its stances fades out over the swings before and after (0.4 s if the foot
/// does not stand there), with continuous speed and acceleration. A swinging foot is not
/// displaced further than its leg reaches with a bent knee. In a stance that goes on for
/// more than 0.5 s beyond the zone, the displacement is constant from there on: the foot
/// moves as it did before. Linear in frames. Precondition: the zone is within the motion;
/// one place per frame.
PlantNearReport plant_feet_near(EditState& state,
                                const FrameRange& zone,
                                const FootWays& feet);
/// The same for feet that stand where they are.
PlantNearReport plant_feet_near(EditState& state, const FrameRange& zone);

}  // namespace marey::edit
