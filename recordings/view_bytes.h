// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/live_instant.h"

// Private to recordings/: what cameras saw of an instant, as bytes (docs/formats.md).
namespace marey::recordings {

/// Replaces `out`. Numbers are kept exactly.
void write_views(std::span<const CameraTags> views, std::vector<std::byte>& out);

/// What write_views() wrote. nullopt for bytes that it would not write: cut short or too
/// long, cameras or tags out of order or beyond `cameras`, values that are not finite.
[[nodiscard]] std::optional<std::vector<CameraTags>> read_views(
    std::span<const std::byte> bytes, std::size_t cameras);

}  // namespace marey::recordings
