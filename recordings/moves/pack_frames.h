// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/engine/motion_clip.h"

// Private to recordings/moves: numbers of a clip as bytes (docs/formats/moves.md).
// Little-endian; floats have 32 bits.
namespace marey::recordings {

/// Bytes of a frame with its place on the floor.
inline constexpr std::size_t kFrameBytes =
    kUsedRotations * 3 * 4 + (5 * 4 + 3 + 3) * 4 + (kUsedRotations * 3 + 7) / 8;

/// Serializes the frames, kFrameBytes each. For a rotation, the component with the largest
/// magnitude is left out; its place and its sign take three bits.
/// Precondition: one path entry per frame; rotations of unit length to 0.001.
[[nodiscard]] std::string pack_frames(std::span<const BlendPosture> frames,
                                      std::span<const ClipRoot> path);

struct UnpackedFrames {
  std::vector<BlendPosture> frames;
  std::vector<ClipRoot> path;
};

/// Parses the output of pack_frames(): rotations within 1e-6 rad, other numbers exact.
/// nullopt: another number of bytes, numbers that are not finite, or components that no
/// rotation has.
[[nodiscard]] std::optional<UnpackedFrames> unpack_frames(std::string_view bytes);

using ClipContacts = std::array<std::vector<ClipSpan>, 4>;

/// Serializes contacts: for each part of the feet, the number of spans (uint32), then
/// start and end of each.
[[nodiscard]] std::string pack_contacts(const ClipContacts& contacts);

/// Parses the output of pack_contacts(). nullopt: another number of bytes.
[[nodiscard]] std::optional<ClipContacts> unpack_contacts(std::string_view bytes);

/// Serializes the places of the spine's knots, 11 floats.
[[nodiscard]] std::string pack_layout(const PostureLayout& layout);

/// Parses the output of pack_layout(). nullopt: another number of bytes.
[[nodiscard]] std::optional<PostureLayout> unpack_layout(std::string_view bytes);

}  // namespace marey::recordings
