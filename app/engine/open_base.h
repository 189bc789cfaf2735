// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "engine/clips/motion_base.h"

#include "core/base/result.h"

namespace marey::app {

using OpenedBase = Result<std::shared_ptr<const engine::MotionBase>>;

/// Reads a base of clips and checks that they can be played. Errors, with the file: those
/// of read_moves() and MotionBase::make().
[[nodiscard]] OpenedBase open_base(const std::filesystem::path& file);

}  // namespace marey::app
