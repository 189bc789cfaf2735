// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::app {

/// Where all pictures of a run are looked at from: half from the front of where the body
/// faces, half from its left, a little from above.
struct StripView {
  double heading_rad = 0.0;  ///< Of what counts as the front, about Y from +Z to +X.
};

/// A view of this motion: it faces as the hips do at its middle.
[[nodiscard]] StripView view_of(const Motion& motion, const retarget::BodyMap& map);

/// `count` frames, evenly spread. Fewer when there are fewer.
[[nodiscard]] std::vector<int> strip_frames(int frames, int count);

/// Pictures of a body at these frames side by side, as SVG: its bones as round limbs,
/// left ones blue and right ones red, the nearer before the further; the floor Y = 0 with
/// lines half a body apart that stay where they are, footprints of all stances on it, and
/// a point under what bears. Every body is drawn as tall as any other. Linear in joints
/// and stances. Precondition: `map` is the motion's skeleton's; frames are its poses'.
[[nodiscard]] std::string motion_strip(const Motion& motion,
                                       const retarget::BodyMap& map,
                                       const retarget::Contacts& contacts,
                                       std::span<const int> frames,
                                       const StripView& view);

}  // namespace marey::app
