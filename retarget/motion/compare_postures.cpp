// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/motion/compare_postures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/contacts/measure_contacts.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using Frames = std::vector<RigidTransform>;

constexpr std::array<std::array<B, 2>, 8> kSegments{
    {{B::kLeftUpperArm, B::kLeftLowerArm},
     {B::kLeftLowerArm, B::kLeftHand},
     {B::kLeftUpperLeg, B::kLeftLowerLeg},
     {B::kLeftLowerLeg, B::kLeftFoot},
     {B::kRightUpperArm, B::kRightLowerArm},
     {B::kRightLowerArm, B::kRightHand},
     {B::kRightUpperLeg, B::kRightLowerLeg},
     {B::kRightLowerLeg, B::kRightFoot}}};

std::optional<glm::dvec3> place_of(const BodyMap& map, const Frames& frames, B bone) {
  const auto joint = map.joint_of[index(bone)];
  if (!joint) return std::nullopt;
  return frames[index(*joint)].translation;
}

std::optional<glm::dvec3> middle_of(const BodyMap& map, const Frames& frames, B left) {
  const auto a = place_of(map, frames, left);
  const auto b = place_of(map, frames, mirrored(left));
  if (!a || !b) return std::nullopt;
  return 0.5 * (*a + *b);
}

std::optional<glm::dvec3> way(std::optional<glm::dvec3> from,
                              std::optional<glm::dvec3> to) {
  if (!from || !to || glm::distance(*from, *to) < 1e-6) return std::nullopt;
  return glm::normalize(*to - *from);
}

std::optional<glm::dvec3> trunk_of(const BodyMap& map, const Frames& frames) {
  return way(middle_of(map, frames, B::kLeftUpperLeg),
             middle_of(map, frames, B::kLeftUpperArm));
}

/// Returns true if the feet point against the front defined by hips and trunk.
std::optional<bool> feet_backwards(const BodyMap& map, const Frames& frames) {
  const auto up = trunk_of(map, frames);
  const auto across = way(place_of(map, frames, B::kRightUpperLeg),
                          place_of(map, frames, B::kLeftUpperLeg));
  const auto feet =
      way(middle_of(map, frames, B::kLeftFoot), middle_of(map, frames, B::kLeftToes));
  if (!up || !across || !feet) return std::nullopt;
  return glm::dot(glm::cross(*across, *up), *feet) < 0.0;
}

struct Fastest {
  double speed_m_per_s = 0.0;
  B bone{};
  std::optional<int> frame{};
};

void keep_faster(const BodyMap& map,
                 const Frames& before,
                 const Frames& now,
                 double hz,
                 int frame,
                 Fastest& fastest) {
  for (const B bone : human_bones()) {
    const auto a = place_of(map, before, bone);
    const auto b = place_of(map, now, bone);
    if (!a || !b) continue;
    const double speed = glm::distance(*a, *b) * hz;
    if (speed > fastest.speed_m_per_s) fastest = {speed, bone, frame};
  }
}

/// Angles between a segment's directions on both bodies, over frames.
struct Apart {
  std::vector<double> angles_rad;
  std::vector<int> frames;
  double worst_rad = 0.0;
  std::optional<int> worst_frame{};

  void add(const glm::dvec3& a, const glm::dvec3& b, int frame) {
    angles_rad.push_back(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
    frames.push_back(frame);
    if (angles_rad.back() < worst_rad) return;
    worst_rad = angles_rad.back();
    worst_frame = frame;
  }
  DirectionFigures figures(B bone, double hz) const {
    DirectionFigures out{bone};
    if (angles_rad.empty()) return out;
    out.median_rad = median(angles_rad);
    out.worst_rad = worst_rad;
    out.worst_frame = worst_frame;
    // The minimum angle of each run of frames of this length.
    const std::size_t count = angles_rad.size();
    const std::size_t run = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::ceil(kSustained_s * hz)), 1, count);
    for (std::size_t first = 0; first + run <= count; ++first) {
      const bool is_on_end =
          frames[first + run - 1] - frames[first] == static_cast<int>(run) - 1;
      if (!is_on_end || angles_rad[first] <= out.sustained_rad) continue;
      const auto from = angles_rad.begin() + static_cast<std::ptrdiff_t>(first);
      const double min_angle =
          *std::min_element(from, from + static_cast<std::ptrdiff_t>(run));
      if (min_angle <= out.sustained_rad) continue;
      out.sustained_rad = min_angle;
      out.sustained_frame = frames[first];
    }
    return out;
  }
};

void keep_larger(const DirectionFigures& one, DirectionFigures& out) {
  if (!one.worst_frame) return;
  if (!out.worst_frame || one.median_rad > out.median_rad) out = one;
}

/// Returns a foot's horizontal direction; nullopt: the foot is too steep.
std::optional<glm::dvec3> level_foot(const glm::dvec3& ahead) {
  if (std::abs(std::asin(std::clamp(ahead.y, -1.0, 1.0))) > kSteepFoot_rad) {
    return std::nullopt;
  }
  return glm::normalize(glm::dvec3(ahead.x, 0.0, ahead.z));
}

/// Compares both feet: by their toe joints if both bodies have them, else by the
/// rotations of their ankles.
class FeetComparison {
 public:
  FeetComparison(const BodyMap& from, const BodyMap& to) : from_(from), to_(to) {}

  void add(const Frames& a, const Frames& b, int frame) {
    for (std::size_t side = 0; side < 2; ++side) {
      const B foot = foot_bone(static_cast<int>(side));
      const B toes = toes_bone(static_cast<int>(side));
      auto u = way(place_of(from_, a, foot), place_of(from_, a, toes));
      auto v = way(place_of(to_, b, foot), place_of(to_, b, toes));
      if (!u || !v) {
        u = ahead(from_, a, foot);
        v = ahead(to_, b, foot);
      }
      if (!u || !v) continue;
      u = level_foot(*u);
      v = level_foot(*v);
      if (u && v) feet_[side].add(*u, *v, frame);
    }
  }
  [[nodiscard]] DirectionFigures figures(std::size_t side, double hz) const {
    return feet_[side].figures(foot_bone(static_cast<int>(side)), hz);
  }

 private:
  static std::optional<glm::dvec3> ahead(const BodyMap& map,
                                         const Frames& frames,
                                         B foot) {
    const auto joint = map.joint_of[index(foot)];
    if (!joint) return std::nullopt;
    return rotation_from_t_pose(map, frames, *joint) * glm::dvec3(0, 0, 1);
  }

  const BodyMap& from_;
  const BodyMap& to_;
  std::array<Apart, 2> feet_;
};

}  // namespace

std::string_view segment_name(const DirectionFigures& direction) {
  return direction.bone == B::kSpine ? "trunk" : name(direction.bone);
}

PostureFigures compare_postures(const Motion& source,
                                const BodyMap& from,
                                const Motion& made,
                                const BodyMap& to) {
  MAREY_ASSERT(source.poses.size() == made.poses.size());
  std::array<Apart, kSegments.size()> segments;
  Apart trunk;
  Apart neck;
  Frames a(source.skeleton.joints.size());
  Frames b(made.skeleton.joints.size());
  Frames a_before;
  Frames b_before;
  Fastest fastest;
  Fastest source_fastest;
  FeetComparison feet(from, to);
  double exchanged = 0.0;
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    world_from_joints(source.skeleton, source.poses[t], a);
    world_from_joints(made.skeleton, made.poses[t], b);
    const int frame = static_cast<int>(t);
    for (std::size_t s = 0; s < kSegments.size(); ++s) {
      const auto [upper, lower] = kSegments[s];
      const auto u = way(place_of(from, a, upper), place_of(from, a, lower));
      const auto v = way(place_of(to, b, upper), place_of(to, b, lower));
      if (u && v) segments[s].add(*u, *v, frame);
    }
    const auto lean = trunk_of(from, a);
    const auto own_lean = trunk_of(to, b);
    if (lean && own_lean) trunk.add(*lean, *own_lean, frame);
    const auto nape = way(place_of(from, a, B::kNeck), place_of(from, a, B::kHead));
    const auto own_nape = way(place_of(to, b, B::kNeck), place_of(to, b, B::kHead));
    if (nape && own_nape) neck.add(*nape, *own_nape, frame);
    feet.add(a, b, frame);
    const auto back = feet_backwards(from, a);
    const auto own_back = feet_backwards(to, b);
    if (back && own_back && *back != *own_back) exchanged += 1.0;
    if (t > 0) {
      keep_faster(from, a_before, a, source.rate.hz, frame, source_fastest);
      keep_faster(to, b_before, b, made.rate.hz, frame, fastest);
    }
    a_before = a;
    b_before = b;
  }
  PostureFigures out;
  const double hz = source.rate.hz;
  for (std::size_t s = 0; s < kSegments.size(); ++s) {
    out.segments[s] = segments[s].figures(kSegments[s][0], hz);
    // Four per side: two of the arm, then two of the leg.
    keep_larger(out.segments[s], s % 4 < 2 ? out.arms : out.legs);
  }
  std::size_t next = kSegments.size();
  out.trunk = out.segments[next++] = trunk.figures(B::kSpine, hz);
  out.segments[next++] = neck.figures(B::kNeck, hz);
  for (std::size_t side = 0; side < 2; ++side) {
    const DirectionFigures foot = out.segments[next++] = feet.figures(side, hz);
    if (!out.feet.worst_frame || foot.sustained_rad > out.feet.sustained_rad) {
      out.feet = foot;
    }
  }
  if (!source.poses.empty()) {
    out.exchanged_share = exchanged / static_cast<double>(source.poses.size());
  }
  out.max_speed = fastest.speed_m_per_s / head_height_m(made.skeleton, to);
  out.fastest_bone = fastest.bone;
  out.fastest_frame = fastest.frame;
  out.source_max_speed =
      source_fastest.speed_m_per_s / head_height_m(source.skeleton, from);
  out.source_fastest_bone = source_fastest.bone;
  out.source_fastest_frame = source_fastest.frame;
  return out;
}

}  // namespace marey::retarget
