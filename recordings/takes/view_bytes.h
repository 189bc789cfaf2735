// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/live_instant.h"

// Private to recordings/: the cameras' detections of an instant, as bytes
// (docs/formats/live_takes.md).
namespace marey::recordings {

/// Serializes the views; replaces `out`. Numbers are exact.
void write_views(std::span<const CameraTags> views, std::vector<std::byte>& out);

/// Parses the output of write_views(). nullopt for bytes that it does not write:
/// incomplete or too long, cameras or tags out of order or beyond `cameras`, values that
/// are not finite.
[[nodiscard]] std::optional<std::vector<CameraTags>> read_views(
    std::span<const std::byte> bytes, std::size_t cameras);

}  // namespace marey::recordings
