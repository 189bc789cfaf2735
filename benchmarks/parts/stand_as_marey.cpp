// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/parts/stand_as_marey.h"

#include "retarget/bones/identify_bones.h"
#include "retarget/bones/neutral_t_pose.h"
#include "retarget/bones/up_of_motion.h"

namespace marey {

Result<retarget::BodyFrame> stand_as_marey(const retarget::FileUnit& unit,
                                           Motion& motion) {
  auto bones = retarget::identify_bones(motion.skeleton);
  if (!bones) return bones.error();
  if (!motion.poses.empty() && !retarget::stands_at_rest(motion.skeleton, *bones)) {
    const auto* const known = retarget::named_neutral(motion.skeleton);
    retarget::set_rest_t_pose(
        motion, *bones, retarget::up_of_motion(motion, *bones).axis, known);
  }
  auto frame = retarget::find_body_frame(motion.skeleton, unit, {}, *bones);
  if (!frame) return frame.error();
  retarget::mark(*bones, motion.skeleton);
  retarget::put_into_frame(*frame, motion);
  return frame;
}

}  // namespace marey
