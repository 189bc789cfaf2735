// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "core/engine/motion_clip.h"

namespace marey::recordings {

/// Returns the mean speed of the hips over the floor, along their path. [m/s]
[[nodiscard]] double mean_speed_m_s(const MotionClip& clip);

/// Returns the supports that a clip has for at least 40 ms in all, as letters in this
/// order: N no foot, L left, R right, D both; "X" for a clip without contacts.
[[nodiscard]] std::string supports_of(const MotionClip& clip);

/// Returns the bytes that frames and contacts of a clip take in a base.
[[nodiscard]] std::size_t clip_bytes(const MotionClip& clip);

}  // namespace marey::recordings
