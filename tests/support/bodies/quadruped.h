// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/character.h"

namespace marey::testing {

/// An animal of the size of a large dog, 0.6 m high at the hips, standing on Y = 0 and
/// facing +Z: pelvis (the root), a back of five vertebrae to the withers, two of neck and
/// a head, a tail of four, and four legs of two bones and a paw. No joint is marked as a
/// human's bone, every joint's axes are the world's, and it rests in its T-pose.
///
/// Groups: head and tail; front legs (on the back, level 3) and hind legs (on the root);
/// back; root. All four legs can support. 30 kg.
[[nodiscard]] Character make_quadruped();

}  // namespace marey::testing
