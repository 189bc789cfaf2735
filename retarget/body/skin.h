// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/base/ids.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// The parts of a body whose skin is measured. Left limbs before right ones.
enum class SkinPart : int {
  kHead,
  kTrunk,
  kWorn,  ///< Hair, skirts, tails: long chains below head or trunk.
  kLeftUpperArm,
  kLeftForearm,
  kLeftHand,
  kLeftThigh,
  kLeftShank,
  kLeftFoot,
  kRightUpperArm,
  kRightForearm,
  kRightHand,
  kRightThigh,
  kRightShank,
  kRightFoot,
};
inline constexpr int kSkinPartCount = 15;

[[nodiscard]] constexpr std::size_t index(SkinPart part) {
  return static_cast<std::size_t>(part);
}
/// Returns the same limb's part on a side, 0 left and 1 right.
/// Precondition: a left limb's part.
[[nodiscard]] constexpr SkinPart on_side(SkinPart left_part, int side) {
  return static_cast<SkinPart>(static_cast<int>(left_part) + 6 * side);
}
/// Returns the part's name in messages: "left foot".
[[nodiscard]] std::string_view name(SkinPart part);

/// A vertex of a skin at rest: its place, and the joints that carry it.
struct SkinVertex {
  glm::dvec3 p_in_world{0.0};  ///< In the rest pose. [m]
  std::array<JointIndex, 4> joints{};
  std::array<double, 4> weights{};  ///< >= 0, they sum to 1.
};

/// World Y of the lowest point of each part. [m]
using SkinLows = std::array<double, kSkinPartCount>;
/// Value of SkinLows for a part that has no skin, or none below the ceiling.
inline constexpr double kNoSkin_m = 1e9;

/// The skin of a body, prepared for measuring its lowest points: linear blend skinning of
/// the height alone, part by part, without the vertices that cannot be low.
class Skin {
 public:
  Skin() = default;
  /// Linear in vertices, and n log n in their number for the grouping.
  /// Precondition: `map` was made from `skeleton`; joints are of the skeleton.
  Skin(const Skeleton& skeleton,
       const BodyMap& map,
       std::span<const SkinVertex> vertices);

  [[nodiscard]] bool empty() const { return groups_.empty(); }
  [[nodiscard]] std::size_t vertex_count() const { return first_.size(); }

  /// Computes the lowest point of every part in a posture, exact for all points below
  /// `ceiling_m`. `rows` is scratch, one entry per joint. Allocates nothing; linear in
  /// the vertices near the ceiling and below.
  /// Precondition: one frame and one row per joint of the skeleton.
  void lows(std::span<const RigidTransform> world_from_joint,
            double ceiling_m,
            std::span<glm::dvec4> rows,
            SkinLows& out) const;

 private:
  struct Influence {
    std::uint32_t joint = 0;
    glm::dvec4 weighted{0.0};  ///< Place in the joint's frame and 1, times the weight.
  };
  /// Ball that contains all vertices of a group that one joint carries.
  struct Bound {
    std::uint32_t joint = 0;
    glm::dvec4 centre{0.0};  ///< In the joint's frame, and 1.
    double radius_m = 0.0;
  };
  /// Vertices of one main carrier, first to last - 1.
  struct Group {
    SkinPart part{};
    std::uint32_t first = 0, last = 0;
    std::uint32_t first_bound = 0, last_bound = 0;
  };
  void add_bounds(Group& group);

  std::vector<std::uint32_t> first_;  ///< First index of each vertex's influences.
  std::vector<Influence> influences_;
  std::vector<Bound> bounds_;
  std::vector<Group> groups_;
};

/// Returns the part to which the skin of each joint belongs. A joint without a bone
/// belongs to the limb it is below. Joints below head or trunk belong to it as well,
/// except chains of more than two, which are kWorn.
[[nodiscard]] std::vector<SkinPart> skin_parts(const Skeleton& skeleton,
                                               const BodyMap& map);

}  // namespace marey::retarget
