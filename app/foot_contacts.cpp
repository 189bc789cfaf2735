// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/foot_contacts.h"

#include <cstddef>
#include <vector>

#include "core/humanoid.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"

namespace marey::app {

recordings::NpzContacts foot_contacts(const Motion& motion) {
  recordings::NpzContacts out;
  const auto map = retarget::map_body(motion.skeleton);
  if (!map || motion.poses.empty()) return out;
  const retarget::Contacts contacts = retarget::detect_contacts(motion, *map);
  for (const HumanBone bone : {HumanBone::kLeftFoot,
                               HumanBone::kLeftToes,
                               HumanBone::kRightFoot,
                               HumanBone::kRightToes}) {
    out.names.emplace_back(name(bone));
  }
  out.bears.assign(out.names.size() * motion.poses.size(), 0);
  const auto mark = [&](const std::vector<retarget::FrameInterval>& intervals,
                        std::size_t place) {
    for (const auto& [first, last] : intervals) {
      for (int frame = first; frame <= last; ++frame) {
        out.bears[static_cast<std::size_t>(frame) * out.names.size() + place] = 1;
      }
    }
  };
  for (std::size_t side = 0; side < 2; ++side) {
    mark(contacts.feet[side].heel, 2 * side);
    mark(contacts.feet[side].ball, 2 * side + 1);
  }
  return out;
}

}  // namespace marey::app
