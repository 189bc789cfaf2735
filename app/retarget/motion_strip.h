// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// Viewing direction of all pictures of a run: halfway between the body's front and its
/// left, slightly from above.
struct StripView {
  double heading_rad = 0.0;  ///< Heading of the body's front, about Y from +Z to +X.
};

/// Returns a view whose front is the heading of the hips in the motion's middle frame.
[[nodiscard]] StripView view_of(const Motion& motion, const retarget::BodyMap& map);

/// Returns `count` evenly spaced frames, or all frames if there are fewer.
[[nodiscard]] std::vector<int> strip_frames(int frames, int count);

/// Returns pictures of a body at these frames, side by side, as SVG. Bones are round
/// limbs, left ones blue and right ones red, drawn from far to near. The floor Y = 0 has
/// lines half a body apart that are fixed in the world, the footprints of all stances,
/// and a point under each bearing foot. All bodies are drawn equally tall. Linear in
/// joints and stances. Precondition: `map` is of the motion's skeleton; `frames` are
/// indices of its poses.
[[nodiscard]] std::string motion_strip(const Motion& motion,
                                       const retarget::BodyMap& map,
                                       const Contacts& contacts,
                                       std::span<const int> frames,
                                       const StripView& view);

}  // namespace marey::app
