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
  std::optional<std::filesystem::path> bone_map;  ///< Replaces the one next to the body.
  std::string neutral;                            ///< For read_neutral(), or empty.
  bool write_map = false;                         ///< Writes the map next to FILE.
  std::filesystem::path picture;                  ///< .svg or .png; empty for none.

  [[nodiscard]] bool asks() const {
    return bone_map.has_value() || write_map || !neutral.empty() || !picture.empty();
  }
};

/// Returns the content of a body's file: joints, motion, its jumps, its zero moment
/// points
/// ("zmp", zmp_json()), and under "body" the joint of each bone with reason and
/// confidence, unit, up axis, front, stature and warnings, or "declined" with the reason.
/// Writes the map and the picture if the options request them. Errors: the file cannot be
/// read; the given map or neutral pose does not fit the body; a map or a picture is
/// requested and the body has none; the disk is full.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_body(
    const std::filesystem::path& file,
    const InspectBodyOptions& options,
    Console& console);

/// Returns the result of inspect_body() in readable form, with one line per bone.
[[nodiscard]] nlohmann::ordered_json bones_as_lines(nlohmann::ordered_json inspected);

}  // namespace marey::app
