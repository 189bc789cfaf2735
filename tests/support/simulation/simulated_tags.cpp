// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/simulated_tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

namespace marey::testing {
namespace {

using B = HumanBone;

/// Usual places of tags on a segment of the left side or the middle.
struct TagPlacement {
  B segment;
  bool is_needed;
  double from_share;  ///< Share of the way to the segment's end.
  double to_share;
  double size;   ///< Over the session's largest.
  double slide;  ///< Over that of a thigh.
  std::vector<glm::dvec3> sides;
};

const std::vector<TagPlacement>& usual_placements() {
  static const std::vector<TagPlacement> list{
      {B::kHips,
       true,
       -0.2,
       0.5,
       1.0,
       0.5,
       {{0, 0, 1}, {0, 0, -1}, {0.8, 0, 0.6}, {-0.8, 0, 0.6}, {0.9, 0, -0.4}}},
      {B::kUpperChest,
       true,
       -0.1,
       0.4,
       1.0,
       0.4,
       {{0, 0, 1}, {0, 0, -1}, {0.45, 0, -0.9}, {-0.45, 0, -0.9}, {0.4, 0, 0.9}}},
      {B::kHead,
       false,
       0.4,
       0.7,
       0.8,
       0.05,
       {{0, 0.2, 1}, {0.9, 0.2, -0.4}, {-0.9, 0.2, -0.4}, {0, 0.2, -1}}},
      {B::kLeftUpperArm,
       true,
       0.3,
       0.75,
       0.8,
       0.7,
       {{0, 1, 0}, {0, 0.7, 0.7}, {0, 0.6, -0.8}}},
      {B::kLeftLowerArm,
       true,
       0.3,
       0.75,
       0.8,
       0.35,
       {{0, 1, 0}, {0, 0.7, 0.7}, {0, 0.6, -0.8}, {0, -0.4, -0.9}}},
      {B::kLeftHand, false, 0.3, 0.6, 0.7, 0.15, {{0, 1, 0}}},
      {B::kLeftUpperLeg,
       true,
       0.35,
       0.75,
       1.0,
       1.0,
       {{0, 0, 1}, {0.5, 0, 0.85}, {1, 0, 0}, {0.7, 0, -0.7}}},
      {B::kLeftLowerLeg,
       true,
       0.25,
       0.75,
       0.85,
       0.4,
       {{0, 0, 1}, {0.5, 0, 0.85}, {1, 0, -0.1}, {0.7, 0, -0.7}, {0, 0, -1}}},
      {B::kLeftFoot, false, 0.4, 0.8, 0.75, 0.15, {{0, 1, 0.3}}}};
  return list;
}

/// The limb that a bone belongs to, and its place in it (0 upper, 1 lower, 2 end).
std::optional<std::pair<std::size_t, int>> place_in_limb(B bone) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const HumanLimb& bones = human_limbs()[limb];
    if (bone == bones.upper) return std::pair(limb, 0);
    if (bone == bones.lower) return std::pair(limb, 1);
    if (bone == bones.end) return std::pair(limb, 2);
  }
  return std::nullopt;
}

/// The angles that pull at the skin of a segment.
std::vector<std::size_t> pulling_angles(B segment) {
  using L = LimbAngle;
  if (const auto place = place_in_limb(segment)) {
    const std::array<std::vector<L>, 3> angles{
        std::vector<L>{L::kRaise, L::kSwing, L::kSpin, L::kBend},
        std::vector<L>{L::kBend, L::kTwist, L::kEndFlexion},
        std::vector<L>{L::kEndFlexion, L::kEndDeviation}};
    std::vector<std::size_t> out;
    for (const L angle : angles[static_cast<std::size_t>(place->second)]) {
      out.push_back(limb_angle(place->first, angle));
    }
    return out;
  }
  if (segment == B::kHead) {
    return {index(Angle::kHeadX), index(Angle::kHeadY), index(Angle::kHeadZ)};
  }
  const std::size_t first = segment == B::kHips ? 2 : 0;
  return {index(Angle::kTrunkX),
          index(Angle::kTrunkY),
          index(Angle::kTrunkZ),
          limb_angle(first, L::kSwing),
          limb_angle(first + 1, L::kSwing),
          limb_angle(first, L::kRaise),
          limb_angle(first + 1, L::kRaise)};
}

void add_skin(GluedTag& tag,
              double share,
              double slide_m,
              std::span<const Attitude> range,
              const Attitude& reference,
              Dice& dice) {
  if (slide_m <= 0.0) return;
  const glm::dvec3 normal = tag.segment_from_tag.rotation * glm::dvec3(0, 0, 1);
  for (const std::size_t angle : pulling_angles(tag.tag.segment)) {
    glm::dvec3 slide = dice.direction() * dice.between(0.3, 1.0);
    // Skin slides over the soft tissue more than it lifts off.
    slide -= 0.7 * glm::dot(slide, normal) * normal;
    tag.pulls.push_back({angle, slide});
  }
  double sum = 0.0;
  for (const Attitude& attitude : range) {
    glm::dvec3 slide(0.0);
    for (const GluedTag::Pull& pull : tag.pulls) {
      slide += (attitude[pull.angle] - reference[pull.angle]) * pull.slide_per_rad;
    }
    sum += glm::dot(slide, slide);
  }
  // Joints that hardly move are not to pull wildly when they do.
  const double rms = std::max(std::sqrt(sum / static_cast<double>(range.size())), 0.15);
  for (GluedTag::Pull& pull : tag.pulls) pull.slide_per_rad *= slide_m / rms;
  tag.wobble_s2 = 0.4 * slide_m / 8.0;
  const auto place = place_in_limb(tag.tag.segment);
  if (!place || place->first >= 2 || place->second == 2) return;
  // Skin near the body follows an arm's turn about itself only partly.
  const double maximum = place->second == 0 ? 0.35 : 0.15;
  tag.lag = maximum * (1.0 - share) * std::min(1.0, slide_m / 0.005);
  tag.lag_angle =
      limb_angle(place->first, place->second == 0 ? LimbAngle::kSpin : LimbAngle::kTwist);
  tag.lag_axis = {1, 0, 0};
}

RigidTransform glue(const SkinPoint& skin, double plate_m, Dice& dice) {
  const glm::dvec3 into = -skin.out;
  const glm::dvec3 helper =
      std::abs(into.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 right = glm::normalize(glm::cross(into, helper));
  const glm::dvec3 down = glm::cross(into, right);
  const glm::dquat straight = glm::quat_cast(glm::dmat3(right, down, into));
  const double quarters = std::floor(dice.between(0.0, 4.0));
  const glm::dquat in_plane = rotation_from_vector(
      {0.0, 0.0, 0.5 * std::numbers::pi * quarters + dice.noise(0.15)});
  return {glm::normalize(straight * dice.turn(glm::radians(15.0)) * in_plane),
          skin.p_in_bone + plate_m * skin.out};
}

/// The side for the next tag: mostly the one that is farthest from those in use.
glm::dvec3 next_side(const std::vector<glm::dvec3>& sides,
                     const std::vector<glm::dvec3>& used,
                     Dice& dice) {
  const auto any = static_cast<std::size_t>(
      dice.between(0.0, static_cast<double>(sides.size()) - 1e-9));
  if (used.empty() || dice.between(0, 1) < 0.3) return sides[any];
  const auto nearest = [&](const glm::dvec3& side) {
    double maximum = -1.0;
    for (const glm::dvec3& other : used) {
      maximum = std::max(maximum, glm::dot(glm::normalize(side), glm::normalize(other)));
    }
    return maximum;
  };
  return *std::min_element(
      sides.begin(), sides.end(), [&](const glm::dvec3& a, const glm::dvec3& b) {
        return nearest(a) < nearest(b);
      });
}

/// Plates are larger than black squares, and do not lie one over the other.
bool has_room(const GluedTag& tag, const std::vector<GluedTag>& others) {
  return std::none_of(others.begin(), others.end(), [&](const GluedTag& other) {
    return other.tag.segment == tag.tag.segment &&
           glm::distance(other.segment_from_tag.translation,
                         tag.segment_from_tag.translation) <
               0.55 * (other.tag.size_m + tag.tag.size_m);
  });
}

/// Ids without an order, tag36h11's.
std::vector<int> shuffled_ids(Dice& dice) {
  std::vector<int> ids;
  for (int id = 0; id < 120; ++id) ids.push_back(id);
  for (std::size_t i = ids.size() - 1; i > 0; --i) {
    std::swap(ids[i],
              ids[static_cast<std::size_t>(dice.between(0, static_cast<double>(i) + 1))]);
  }
  return ids;
}

}  // namespace

std::vector<GluedTag> glue_tags(const SimulatedBody& body,
                                std::span<const SoftTissuePart> soft_tissue,
                                const TagStyle& style,
                                std::span<const Attitude> range,
                                const Attitude& reference,
                                Dice& dice) {
  const std::vector<int> ids = shuffled_ids(dice);
  std::vector<GluedTag> tags;
  const auto add = [&](const TagPlacement& placement, bool right) {
    const B segment = right ? mirrored(placement.segment) : placement.segment;
    // The session's style limits the tags per segment. Single tags are omitted at random.
    int count = placement.is_needed ? style.max_per_segment : 1;
    if (count > 1 && dice.between(0, 1) < 0.25) --count;
    if (!placement.is_needed && dice.between(0, 1) < 0.3) count = 0;
    std::vector<glm::dvec3> used;
    constexpr int kAttempts = 6;
    for (int attempt = 0; attempt < kAttempts && count > 0; ++attempt) {
      glm::dvec3 side = next_side(placement.sides, used, dice);
      used.push_back(side);
      side = dice.turn(0.25) * side;
      if (right) side.x = -side.x;
      const double share = dice.between(placement.from_share, placement.to_share);
      const glm::dvec3 end = end_of(segment, body.proportions);
      const SkinPoint skin = skin_point(soft_tissue, segment, share * end, side);
      GluedTag tag;
      tag.tag = {TagId{ids[tags.size()]},
                 segment,
                 std::max(0.05, std::round(1e3 * placement.size * style.size_m) * 1e-3)};
      tag.segment_from_tag = glue(skin, dice.between(0.003, 0.015), dice);
      // Another tag that is glued there leaves no room.
      if (!has_room(tag, tags)) continue;
      const double slide_m = placement.slide * style.slide_m * dice.between(0.5, 1.0);
      add_skin(tag, std::max(0.0, share), slide_m, range, reference, dice);
      tags.push_back(std::move(tag));
      --count;
    }
  };
  for (const TagPlacement& placement : usual_placements()) {
    add(placement, false);
    if (mirrored(placement.segment) != placement.segment) add(placement, true);
  }
  std::sort(tags.begin(), tags.end(), [](const GluedTag& a, const GluedTag& b) {
    return a.tag.id < b.tag.id;
  });
  return tags;
}

RigidTransform segment_from_tag(const GluedTag& tag,
                                const Attitude& attitude,
                                const Attitude& reference,
                                const glm::dvec3& acceleration) {
  glm::dvec3 slide = -tag.wobble_s2 * acceleration;
  for (const GluedTag::Pull& pull : tag.pulls) {
    slide += (attitude[pull.angle] - reference[pull.angle]) * pull.slide_per_rad;
  }
  RigidTransform out = tag.segment_from_tag;
  out.translation += slide;
  if (tag.lag_angle) {
    const double turned = attitude[*tag.lag_angle] - reference[*tag.lag_angle];
    out =
        RigidTransform{rotation_from_vector(-tag.lag * turned * tag.lag_axis), {}} * out;
  }
  return out;
}

}  // namespace marey::testing
