// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/bones/body_frame.h"
#include "retarget/bones/identify_bones.h"

namespace marey {

/// Marks the bones of a motion that was read, and puts it into marey's frame, as `marey`
/// does. What it did to the frame. Errors: identify_bones()'s and find_body_frame()'s.
[[nodiscard]] Result<retarget::BodyFrame> stand_as_marey(const retarget::FileUnit& unit,
                                                         Motion& motion);

}  // namespace marey
