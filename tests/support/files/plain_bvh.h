// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::testing {

/// A BVH file by its own numbers: world places of its joints, in the file's unit and
/// axes. Shares no code with recordings/, so that it can judge what is made of the file.
class PlainBvh {
 public:
  /// Throws std::runtime_error when the file is no BVH file.
  explicit PlainBvh(const std::filesystem::path& path);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::size_t frame_count() const { return frames_.size(); }
  [[nodiscard]] double frame_time_s() const { return frame_time_s_; }
  /// One place per joint.
  [[nodiscard]] std::vector<glm::dvec3> places(std::size_t frame) const;

 private:
  struct Channel {
    bool turns = false;
    int axis = 0;
  };
  std::vector<std::string> names_;
  std::vector<int> parents_;
  std::vector<glm::dvec3> offsets_;
  std::vector<std::vector<Channel>> channels_;
  std::vector<std::vector<double>> frames_;
  double frame_time_s_ = 0.0;
};

}  // namespace marey::testing
