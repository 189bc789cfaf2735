// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/motion.h"
#include "recordings/motion/mot.h"

namespace marey::app {

/// The joint angles of a motion, as OpenSim reads them: motion.mot (docs/formats/README.md).
/// Time is (first_frame + i) / rate. nullopt when the body is not as marey makes it: all
/// 22 bones, at rest without rotations.
[[nodiscard]] std::optional<recordings::MotTable> angle_table(const Motion& motion,
                                                              std::string name);

}  // namespace marey::app
