// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "app/shell/console.h"
#include "core/base/result.h"

namespace marey::app {

struct InspectBodyOptions {
  std::optional<std::filesystem::path> bone_map;  ///< Instead of the one beside the body.
  std::string neutral;                            ///< read_neutral()'s word, or empty.
  bool write_map = false;                         ///< Store FILE's map beside it.
  std::filesystem::path picture;                  ///< .svg or .png; empty for none.

  [[nodiscard]] bool asks() const {
    return bone_map.has_value() || write_map || !neutral.empty() || !picture.empty();
  }
};

/// What a body's file holds: joints, motion, and under "body" which joint is which bone,
/// why and how surely, its unit, up, front, stature and warnings, or "declined" with the
/// reason. Writes the map and the picture.
/// Errors: the file cannot be read; the map or the neutral that is given does not fit the
/// body; a map or a picture is asked for and there is none of the body, or the disk has no
/// room.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_body(
    const std::filesystem::path& file,
    const InspectBodyOptions& options,
    Console& console);

/// The same for reading: a line per bone.
[[nodiscard]] nlohmann::ordered_json bones_as_lines(nlohmann::ordered_json inspected);

}  // namespace marey::app
