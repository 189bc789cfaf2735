// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/motion.h"
#include "recordings/motion/mot.h"

namespace marey::app {

/// Returns the joint angles of a motion as OpenSim reads them: motion.mot
/// (docs/formats/joint_angles.md). Time is (first_frame + i) / rate. nullopt: the
/// skeleton is not one of marey's own, with all 22 bones and a rest pose without
/// rotations.
[[nodiscard]] std::optional<recordings::MotTable> angle_table(const Motion& motion,
                                                              std::string name);

}  // namespace marey::app
