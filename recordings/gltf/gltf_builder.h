// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/motion.h"

namespace marey::recordings {

using Json = nlohmann::ordered_json;

/// Appends arrays to a glTF document's one buffer, and packs both as GLB.
class GltfBuilder {
 public:
  /// Borrows both; they must outlive the builder.
  GltfBuilder(Json& document, std::string& buffer)
      : document_(document), buffer_(buffer) {}

  /// Adds a buffer view of `bytes`, aligned to four; returns its index. `target` as in
  /// glTF, 0 for none.
  int add_view(std::string_view bytes, int target = 0);

  /// Adds an accessor of `type` ("VEC3") over floats, `components` per row; returns its
  /// index. `bounds` writes min and max, which positions and times must have.
  int add_floats(std::span<const float> values,
                 std::size_t components,
                 const char* type,
                 bool bounds,
                 int target = 0);

  /// Adds an accessor over integers up to `largest`, in the smallest type that holds
  /// them; returns its index.
  int add_integers(std::span<const std::uint32_t> values,
                   std::size_t components,
                   const char* type,
                   std::uint32_t largest,
                   int target);

  /// Returns the GLB file: header, document, buffer.
  [[nodiscard]] std::string glb() const;

 private:
  int add_accessor(Json accessor);

  Json& document_;
  std::string& buffer_;
};

inline constexpr int kVertexTarget = 34962;
inline constexpr int kIndexTarget = 34963;

/// Keys of one node: rotations of one joint, or positions of the root.
struct NodeTrack {
  int node = 0;
  std::vector<glm::dquat> rotations;
  std::vector<glm::dvec3> translations;
};

/// Creates the animation of these tracks, one key per frame at `rate`, the first at time
/// 0. Neighbouring quaternions have the same sign, so that linear blending takes the
/// shorter path. A track without keys adds no channel.
[[nodiscard]] Json make_animation(GltfBuilder& builder,
                                  std::span<const NodeTrack> tracks,
                                  std::size_t frames,
                                  FrameRate rate,
                                  std::string_view name);

}  // namespace marey::recordings
