// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>

namespace marey::testing {

struct GlbFile;

/// A GLB file moved by its first animation, evaluated from the file's own numbers by the
/// glTF specification: node matrices, linear blend skinning of all skins and primitives
/// with all their JOINTS_n. Shares no code with recordings/ or retarget/, so that it can
/// judge them.
class PosedGlb {
 public:
  /// Throws std::runtime_error when the file is no GLB with a skin, or has unsupported
  /// content: sparse accessors, external buffers, cubic splines.
  explicit PosedGlb(const std::filesystem::path& path);

  /// The times of the animation's keys, of the channel that has most; empty: none. [s]
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] const std::vector<std::string>& node_names() const { return names_; }
  /// Returns the first node of that name.
  [[nodiscard]] std::optional<std::size_t> node(const std::string& name) const;

  /// Poses the nodes at a time. Without an animation they rest.
  void pose(double time_s);
  /// World place of a node in the present pose.
  [[nodiscard]] glm::dvec3 place(std::size_t node) const;

  struct Lowest {
    double y_m = 1e9;
    std::string node;  ///< The joint that carries most of that vertex.
  };
  /// The lowest vertex of all skins in the present pose.
  [[nodiscard]] Lowest lowest() const;
  [[nodiscard]] std::size_t vertex_count() const;

 private:
  struct Node {
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
    std::optional<glm::dmat4> matrix;
    int parent = -1;
  };
  struct Channel {
    std::size_t node = 0;
    char path = 'r';  ///< t, r or s.
    bool steps = false;
    std::vector<double> times;
    std::vector<double> values;
  };
  struct Influence {
    std::size_t joint = 0;  ///< In the skin.
    double weight = 0.0;
  };
  struct SkinnedPart {
    std::vector<std::size_t> joints;  ///< Nodes.
    std::vector<glm::dmat4> inverse_bind;
    std::vector<glm::dvec3> places;
    std::vector<std::vector<Influence>> influences;
  };

  void read_nodes(const GlbFile& file);
  void read_skin(const GlbFile& file, const nlohmann::json& node);
  void read_animation(const GlbFile& file, const nlohmann::json& animation);

  std::vector<std::string> names_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> order_;  ///< Parents first.
  std::vector<Channel> channels_;
  std::vector<SkinnedPart> parts_;
  std::vector<double> times_;
  std::vector<glm::dmat4> world_;
};

}  // namespace marey::testing
