// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/time.h"
#include "core/human/contacts.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/foot_place.h"

namespace marey::retarget {

struct FootPathOptions {
  /// Time over which the speed of a contact's displacement fades out after it, and in
  /// before it. Longer is smoother, and follows noise further. [s]
  double blend_s = 0.28;
};

/// Moves a foot's path onto its footprints.
///
/// Every stance gets one footprint, the mean of the reference foot's flat positions in
/// it. If the foot turns while it stands, the footprint turns with it about the point
/// that moves least (retarget/feet/footprint.h). While heel and ball bear, the foot is
/// exactly flat and on its footprint on the floor Y = 0, its ankle and toe joint at their
/// own resting heights. While only one bears, the foot turns about that joint as the
/// reference does; while a raised heel does not move, it turns only with its footprint.
/// Between stances the reference's path is kept, plus a displacement that joins the two
/// stances' own with continuous position and speed. The ankle and the toe joint are never
/// below their resting heights.
///
/// `reference` holds the foot in the posture to keep, one entry per frame of `contacts`;
/// the result has the same length. Linear in frames.
[[nodiscard]] std::vector<FootPlace> plan_foot_path(std::span<const FootPlace> reference,
                                                    const FootContacts& contacts,
                                                    const FootMap& foot,
                                                    double leg_length_m,
                                                    FrameRate rate,
                                                    const FootPathOptions& options = {});

}  // namespace marey::retarget
