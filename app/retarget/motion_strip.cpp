// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget/motion_strip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "app/pages/page_text.h"
#include "core/base/frame_range.h"
#include "core/pose.h"
#include "retarget/contacts/measure_contacts.h"

namespace marey::app {
namespace {

using B = HumanBone;
using retarget::BodyMap;

// Size of a picture, in body heights.
constexpr double kHalfWidth = 0.54;
constexpr double kAbove = 1.36;
constexpr double kBelow = 0.3;

/// Orthographic view, in body heights: x to the right, y downward, depth towards the eye.
struct Eye {
  glm::dvec3 right;
  glm::dvec3 up;
  glm::dvec3 to_eye;
  double height_m;
  glm::dvec3 middle_in_world{0.0};  ///< Point on the floor at the picture's middle.

  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& p_in_world) const {
    const glm::dvec3 d = (p_in_world - middle_in_world) / height_m;
    return {glm::dot(d, right), -glm::dot(d, up), glm::dot(d, to_eye)};
  }
};

Eye eye_of(const StripView& view, double height_m) {
  constexpr double kFromFront_rad = 0.9;
  constexpr double kFromAbove_rad = 0.22;
  const double yaw = view.heading_rad + kFromFront_rad;
  const glm::dvec3 level{std::sin(yaw), 0.0, std::cos(yaw)};
  const glm::dvec3 y{0.0, 1.0, 0.0};
  const glm::dvec3 to_eye =
      std::cos(kFromAbove_rad) * level + std::sin(kFromAbove_rad) * y;
  const glm::dvec3 right = glm::normalize(glm::cross(y, level));
  return {right, glm::cross(to_eye, right), to_eye, height_m};
}

enum class Side { kMiddle, kLeft, kRight };

struct Limb {
  glm::dvec3 from;
  glm::dvec3 to;
  double width;  ///< [heights]
  Side side = Side::kMiddle;
};

const char* class_of(Side side) {
  if (side == Side::kLeft) return "left";
  return side == Side::kRight ? "right" : "trunk";
}

/// The body's bones in the world for one posture.
class Posed {
 public:
  Posed(const Motion& motion, const BodyMap& map, int frame)
      : motion_(motion),
        map_(map),
        world_(world_from_joints(motion.skeleton,
                                 motion.poses[static_cast<std::size_t>(frame)])) {}

  [[nodiscard]] std::optional<glm::dvec3> at(B bone) const {
    const auto joint = map_.joint_of[index(bone)];
    if (!joint) return std::nullopt;
    return world_[index(*joint)].translation;
  }
  [[nodiscard]] glm::dvec3 hips() const { return world_[index(map_.hips())].translation; }
  /// Returns the tip of a chain's last bone: the file's, else the point `along_m` beyond.
  [[nodiscard]] std::optional<glm::dvec3> tip(B bone, B before, double along_m) const {
    const auto joint = map_.joint_of[index(bone)];
    if (!joint) return std::nullopt;
    const RigidTransform& world = world_[index(*joint)];
    if (const auto& tip = motion_.skeleton[*joint].tip_in_joint) return world * *tip;
    const auto from = at(before);
    if (!from || glm::distance(*from, world.translation) < 1e-6) return std::nullopt;
    return world.translation + along_m * glm::normalize(world.translation - *from);
  }

 private:
  const Motion& motion_;
  const BodyMap& map_;
  std::vector<RigidTransform> world_;
};

/// Adds limbs from bone to bone along a chain; missing bones are skipped.
void add_chain(const Posed& posed,
               std::initializer_list<std::pair<B, double>> chain,
               Side side,
               std::vector<Limb>& limbs) {
  std::optional<glm::dvec3> before;
  double width = 0.0;
  for (const auto& [bone, next_width] : chain) {
    const auto here = posed.at(bone);
    if (!here) continue;
    if (before) limbs.push_back({*before, *here, width, side});
    before = here;
    width = next_width;
  }
}

std::vector<Limb> limbs_of(const Posed& posed, double height_m) {
  std::vector<Limb> limbs;
  add_chain(posed,
            {{B::kHips, 0.13},
             {B::kSpine, 0.13},
             {B::kChest, 0.14},
             {B::kUpperChest, 0.12},
             {B::kNeck, 0.06},
             {B::kHead, 0.0}},
            Side::kMiddle,
            limbs);
  if (const auto top = posed.tip(B::kHead, B::kNeck, 0.08 * height_m)) {
    const glm::dvec3 head = *posed.at(B::kHead);
    limbs.push_back({head, head + 0.6 * (*top - head), 0.12, Side::kMiddle});
  }
  for (const bool is_left : {true, false}) {
    const Side side = is_left ? Side::kLeft : Side::kRight;
    const auto pick = [&](B left, B right) { return is_left ? left : right; };
    add_chain(posed,
              {{pick(B::kLeftShoulder, B::kRightShoulder), 0.06},
               {pick(B::kLeftUpperArm, B::kRightUpperArm), 0.055},
               {pick(B::kLeftLowerArm, B::kRightLowerArm), 0.045},
               {pick(B::kLeftHand, B::kRightHand), 0.0}},
              side,
              limbs);
    const B hand = pick(B::kLeftHand, B::kRightHand);
    if (const auto tip =
            posed.tip(hand, pick(B::kLeftLowerArm, B::kRightLowerArm), 0.08 * height_m)) {
      limbs.push_back({*posed.at(hand), *tip, 0.035, side});
    }
    add_chain(posed,
              {{B::kHips, 0.11},
               {pick(B::kLeftUpperLeg, B::kRightUpperLeg), 0.085},
               {pick(B::kLeftLowerLeg, B::kRightLowerLeg), 0.06},
               {pick(B::kLeftFoot, B::kRightFoot), 0.045},
               {pick(B::kLeftToes, B::kRightToes), 0.0}},
              side,
              limbs);
    const B toes = pick(B::kLeftToes, B::kRightToes);
    if (const auto tip =
            posed.tip(toes, pick(B::kLeftFoot, B::kRightFoot), 0.03 * height_m)) {
      limbs.push_back({*posed.at(toes), *tip, 0.035, side});
    }
  }
  return limbs;
}

std::string line(const glm::dvec3& a, const glm::dvec3& b, const std::string& rest) {
  return text_of("<path d=\"M%.3f %.3f", a.x, a.y) + text_of("L%.3f %.3f\"", b.x, b.y) +
         rest + "/>";
}

std::string draw(std::vector<Limb> limbs, const Eye& eye) {
  std::stable_sort(limbs.begin(), limbs.end(), [&](const Limb& a, const Limb& b) {
    return eye(a.from + a.to).z < eye(b.from + b.to).z;
  });
  std::string out;
  for (const Limb& limb : limbs) {
    const glm::dvec3 a = eye(limb.from);
    const glm::dvec3 b = eye(limb.to);
    out +=
        line(a, b, text_of(" class=\"edge\" stroke-width=\"%.3f\"", limb.width + 0.022));
    out += line(a,
                b,
                std::string(" class=\"") + class_of(limb.side) +
                    text_of("\" stroke-width=\"%.3f\"", limb.width));
  }
  return out;
}

/// Returns floor lines half a body apart, which are fixed in the world.
std::string floor_of(const Eye& eye) {
  const double step_m = 0.5 * eye.height_m;
  std::string out =
      line({-kHalfWidth, 0.0, 0.0}, {kHalfWidth, 0.0, 0.0}, " class=\"ground\"");
  const auto grid_of = [&](double x) { return step_m * std::round(x / step_m); };
  const glm::dvec3 at{
      grid_of(eye.middle_in_world.x), 0.0, grid_of(eye.middle_in_world.z)};
  for (int i = -3; i <= 3; ++i) {
    const double off = i * step_m;
    const double reach = 3.0 * step_m;
    out += line(eye(at + glm::dvec3(off, 0.0, -reach)),
                eye(at + glm::dvec3(off, 0.0, reach)),
                " class=\"grid\"");
    out += line(eye(at + glm::dvec3(-reach, 0.0, off)),
                eye(at + glm::dvec3(reach, 0.0, off)),
                " class=\"grid\"");
  }
  return out;
}

glm::dvec3 on_floor(const glm::dvec3& p) {
  return {p.x, 0.0, p.z};
}

/// The footprint of a stance: ankle to ball, on the floor.
struct Footprint {
  glm::dvec3 heel;
  glm::dvec3 ball;
  Side side;
};

std::vector<Footprint> footprints_of(const Motion& motion,
                                     const BodyMap& map,
                                     const Contacts& contacts) {
  const auto paths = retarget::contact_paths(motion, map);
  std::vector<Footprint> out;
  for (std::size_t side = 0; side < 2; ++side) {
    if (paths[side].empty() || paths[side + 2].empty()) continue;
    for (const FrameRange& run : contacts.feet[side].stance) {
      const auto middle = static_cast<std::size_t>((run.first + run.last) / 2);
      if (middle >= paths[side].size()) continue;
      out.push_back({on_floor(paths[side][middle]),
                     on_floor(paths[side + 2][middle]),
                     side == 0 ? Side::kLeft : Side::kRight});
    }
  }
  return out;
}

bool holds(const std::vector<FrameRange>& runs, int frame) {
  return std::ranges::any_of(runs, [=](const FrameRange& run) {
    return run.first <= frame && frame <= run.last;
  });
}

/// Returns points on the floor below the bearing feet.
std::string bearing_of(const Posed& posed,
                       const Contacts& contacts,
                       int frame,
                       const Eye& eye) {
  std::string out;
  const auto mark = [&](std::optional<glm::dvec3> at) {
    if (!at) return;
    const glm::dvec3 p = eye(on_floor(*at));
    out += text_of(
        "<circle class=\"bears\" cx=\"%.3f\" cy=\"%.3f\" r=\"0.022\"/>", p.x, p.y);
  };
  for (std::size_t side = 0; side < 2; ++side) {
    if (holds(contacts.feet[side].heel, frame)) {
      mark(posed.at(retarget::kContactBones[side]));
    }
    if (holds(contacts.feet[side].ball, frame)) {
      mark(posed.at(retarget::kContactBones[side + 2]));
    }
  }
  return out;
}

}  // namespace

StripView view_of(const Motion& motion, const retarget::BodyMap& map) {
  StripView view;
  if (motion.poses.empty()) return view;
  const auto world =
      world_from_joints(motion.skeleton, motion.poses[motion.poses.size() / 2]);
  const glm::dvec3 left = world[index(map.leg(0).upper)].translation -
                          world[index(map.leg(1).upper)].translation;
  const glm::dvec3 front = glm::cross(left, glm::dvec3(0.0, 1.0, 0.0));
  view.heading_rad = std::atan2(front.x, front.z);
  return view;
}

std::vector<int> strip_frames(int frames, int count) {
  std::vector<int> out;
  const int shown = std::min(frames, count);
  for (int i = 0; i < shown; ++i) {
    out.push_back(
        static_cast<int>((2 * i + 1) * static_cast<long long>(frames) / (2 * shown)));
  }
  return out;
}

std::string motion_strip(const Motion& motion,
                         const retarget::BodyMap& map,
                         const Contacts& contacts,
                         std::span<const int> frames,
                         const StripView& view) {
  Eye eye = eye_of(view, retarget::head_height_m(motion.skeleton, map));
  const std::vector<Footprint> footprints = footprints_of(motion, map, contacts);
  const auto count = static_cast<double>(frames.size());
  std::string out = text_of("<svg class=\"strip\" viewBox=\"0 0 %.3f %.3f\">",
                            2.0 * kHalfWidth * count,
                            kAbove + kBelow);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Posed posed(motion, map, frames[i]);
    eye.middle_in_world = on_floor(posed.hips());
    out += text_of("<svg x=\"%.3f\" width=\"%.3f\" height=\"%.3f\"",
                   2.0 * kHalfWidth * static_cast<double>(i),
                   2.0 * kHalfWidth,
                   kAbove + kBelow) +
           text_of(" viewBox=\"%.3f %.3f %.3f", -kHalfWidth, -kAbove, 2.0 * kHalfWidth) +
           text_of(" %.3f\">", kAbove + kBelow) + floor_of(eye);
    for (const Footprint& print : footprints) {
      const glm::dvec3 heel = eye(print.heel);
      if (std::abs(heel.x) > 2.0 * kHalfWidth) continue;
      out += line(heel,
                  eye(print.ball),
                  std::string(" class=\"print ") + class_of(print.side) + "\"");
    }
    out += draw(limbs_of(posed, eye.height_m), eye) +
           bearing_of(posed, contacts, frames[i], eye) + "</svg>";
  }
  return out + "</svg>\n";
}

}  // namespace marey::app
