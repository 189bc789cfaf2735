// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/bones/body_frame.h"
#include "retarget/bones/identify_bones.h"

namespace marey {

/// Marks the bones of a motion from a file, and transforms it into marey's frame, in the
/// same way as `marey`. Returns the transform. Errors: identify_bones()'s and
/// find_body_frame()'s.
[[nodiscard]] Result<retarget::BodyFrame> stand_as_marey(const retarget::FileUnit& unit,
                                                         Motion& motion);

}  // namespace marey
