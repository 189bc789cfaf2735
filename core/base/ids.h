// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>

namespace marey {

/// The number printed in a fiducial tag, within the session's tag family.
enum class TagId : int {};

/// Position of a camera in the session's camera list.
enum class CameraId : int {};

/// Position of a joint in its Skeleton.
enum class JointIndex : int {};

[[nodiscard]] constexpr std::size_t index(CameraId id) {
  return static_cast<std::size_t>(id);
}
[[nodiscard]] constexpr std::size_t index(JointIndex id) {
  return static_cast<std::size_t>(id);
}
[[nodiscard]] constexpr int number(TagId id) {
  return static_cast<int>(id);
}

}  // namespace marey
