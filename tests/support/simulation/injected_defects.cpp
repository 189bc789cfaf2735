// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/injected_defects.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"

namespace marey::testing {
namespace {

using B = HumanBone;

constexpr std::array<std::string_view, kDefectCount> kNames{"spike 5 cm",
                                                            "spike 10 cm",
                                                            "legs crossed",
                                                            "legs' channels exchanged",
                                                            "slide 10 cm/s",
                                                            "jitter 1 mm",
                                                            "jitter 3 mm",
                                                            "frozen arm 0.5 s",
                                                            "scale x 1.1",
                                                            "path x 1.1",
                                                            "scale x 100",
                                                            "floor + 3 cm",
                                                            "tilt 3 deg",
                                                            "forearm flipped",
                                                            "rate x 2",
                                                            "0.3 s missing",
                                                            "mirrored body"};

/// The generator of one defect. Distributions are written out, because those of the
/// standard library differ between implementations.
class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}

  double uniform(double from, double to) {
    return from + (to - from) * static_cast<double>(bits_() >> 11U) * 0x1.0p-53;
  }
  int whole(int from, int to) {
    return std::min(to, from + static_cast<int>(uniform(0.0, to - from + 1.0)));
  }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
    return radius * std::cos(uniform(0.0, 2.0 * std::numbers::pi));
  }
  glm::dvec3 normal3() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }

 private:
  std::mt19937_64 bits_;
};

std::vector<glm::dquat> rotations(const std::vector<RigidTransform>& world) {
  std::vector<glm::dquat> out;
  out.reserve(world.size());
  for (const RigidTransform& frame : world) out.push_back(frame.rotation);
  return out;
}

/// A motion under change.
class Injector {
 public:
  Injector(const Motion& clean, unsigned seed) : out_{clean, {}}, random_(seed) {
    out_.frames = {0, count() - 1};
  }

  std::optional<InjectedDefect> inject(Defect defect) {
    if (count() < 20 || count() < 1.5 * hz()) return std::nullopt;
    if (!apply(defect)) return std::nullopt;
    return std::move(out_);
  }

 private:
  [[nodiscard]] int count() const { return static_cast<int>(motion().poses.size()); }
  [[nodiscard]] double hz() const { return motion().rate.hz; }
  [[nodiscard]] const Motion& motion() const { return out_.motion; }
  [[nodiscard]] Pose& pose(int t) {
    return out_.motion.poses[static_cast<std::size_t>(t)];
  }
  [[nodiscard]] std::vector<RigidTransform> world(int t) {
    return world_from_joints(motion().skeleton, pose(t));
  }

  /// Chooses `length` frames that are five or more away from both ends.
  void choose(int length) {
    const int first = random_.whole(5, std::max(5, count() - 6 - length));
    out_.frames = {first, first + length - 1};
    out_.is_local = true;
  }

  bool apply(Defect defect) {
    switch (defect) {
      case Defect::kSpike5cm:
        return spike(0.05);
      case Defect::kSpike10cm:
        return spike(0.10);
      case Defect::kLegsCrossed:
        return cross_legs();
      case Defect::kLegChannels:
        return exchange_channels();
      case Defect::kSlide10cmS:
        return slide();
      case Defect::kJitter1mm:
        return jitter(0.001);
      case Defect::kJitter3mm:
        return jitter(0.003);
      case Defect::kFrozenArm:
        return freeze();
      case Defect::kScale110:
        return scale(1.1, 1.1);
      case Defect::kPathScale110:
        return scale(1.0, 1.1);
      case Defect::kScale100:
        return scale(100.0, 100.0);
      case Defect::kFloor3cm:
        for (Pose& p : out_.motion.poses) p.root_in_world.y += 0.03;
        return true;
      case Defect::kTilt3deg:
        return tilt();
      case Defect::kForearmFlip:
        return flip();
      case Defect::kDoubleRate:
        out_.motion.rate.hz *= 2.0;
        return true;
      case Defect::kCut300ms:
        return cut();
      case Defect::kMirrored:
        return mirror();
    }
    return false;
  }

  [[nodiscard]] std::optional<std::size_t> joint(B bone) const {
    const auto found = motion().skeleton.find(bone);
    if (!found) return std::nullopt;
    return index(*found);
  }

  // Turns one joint in the world; everything below it follows.
  void turn(int t, std::size_t j, const glm::dquat& by_in_world) {
    const auto frames = world(t);
    const auto& parent = motion().skeleton.joints[j].parent;
    const glm::dquat turned = by_in_world * frames[j].rotation;
    pose(t).parent_from_joint[j] =
        parent ? glm::normalize(glm::conjugate(frames[index(*parent)].rotation) * turned)
               : turned;
  }

  bool spike(double by_m) {
    const HumanLimb& limb = human_limbs()[static_cast<std::size_t>(random_.whole(0, 3))];
    const auto root = joint(limb.upper);
    const auto end = joint(limb.end);
    if (!root || !end) return false;
    choose(1);
    out_.bone = limb.end;
    const auto frames = world(out_.frames.first);
    const glm::dvec3 along = frames[*end].translation - frames[*root].translation;
    const double length_m = glm::length(along);
    const glm::dvec3 axis = glm::normalize(glm::cross(along, random_.normal3()));
    const double angle = 2.0 * std::asin(std::min(1.0, 0.5 * by_m / length_m));
    turn(out_.frames.first, *root, glm::angleAxis(angle, axis));
    return true;
  }

  bool cross_legs() {
    const HumanLimb& left = human_limbs()[2];
    const HumanLimb& right = human_limbs()[3];
    choose(10);
    for (int t = out_.frames.first; t <= out_.frames.last; ++t) {
      const auto before = world(t);
      for (const auto& [own, other] : {std::pair{left, right}, std::pair{right, left}}) {
        const auto upper = joint(own.upper);
        const auto lower = joint(own.lower);
        const auto end = joint(own.end);
        const auto knee = joint(other.lower);
        const auto foot = joint(other.end);
        if (!upper || !lower || !end || !knee || !foot) return false;
        const auto aim = [&](std::size_t j, std::size_t child, const glm::dvec3& to) {
          const auto now = world(t);
          turn(t,
               j,
               rotation_between(now[child].translation - now[j].translation,
                                to - now[j].translation));
        };
        aim(*upper, *lower, before[*knee].translation);
        aim(*lower, *end, before[*foot].translation);
        const auto now = world(t);
        turn(t, *end, before[*foot].rotation * glm::conjugate(now[*end].rotation));
      }
    }
    return true;
  }

  bool exchange_channels() {
    choose(10);
    for (const B bone :
         {B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot, B::kLeftToes}) {
      const auto left = joint(bone);
      const auto right = joint(mirrored(bone));
      if (!left || !right) continue;
      for (int t = out_.frames.first; t <= out_.frames.last; ++t) {
        std::swap(pose(t).parent_from_joint[*left], pose(t).parent_from_joint[*right]);
      }
    }
    return true;
  }

  bool slide() {
    const double angle = random_.uniform(0.0, 2.0 * std::numbers::pi);
    const glm::dvec3 velocity(0.1 * std::sin(angle), 0.0, 0.1 * std::cos(angle));
    for (int t = 0; t < count(); ++t) pose(t).root_in_world += velocity * (t / hz());
    return true;
  }

  // Moves each joint by its own noise: the root, and then each bone turns towards the
  // moved end of its first child.
  bool jitter(double sigma_m) {
    const Skeleton& skeleton = motion().skeleton;
    std::vector<std::optional<std::size_t>> child(skeleton.joints.size());
    for (std::size_t j = skeleton.joints.size(); j-- > 1;) {
      const Joint& one = skeleton.joints[j];
      if (one.parent && glm::length(one.parent_from_joint.translation) > 0.03) {
        child[index(*one.parent)] = j;
      }
    }
    for (int t = 0; t < count(); ++t) {
      const auto before = world(t);
      std::vector<glm::dvec3> moved;
      for (const RigidTransform& frame : before) {
        moved.push_back(frame.translation + sigma_m * random_.normal3());
      }
      std::vector<RigidTransform> after = before;
      for (std::size_t j = 0; j < after.size(); ++j) {
        const Joint& one = skeleton.joints[j];
        after[j].translation =
            one.parent ? after[index(*one.parent)] * one.parent_from_joint.translation
                       : moved[j];
        if (!child[j]) continue;
        const std::size_t c = *child[j];
        after[j].rotation =
            rotation_between(before[c].translation - before[j].translation,
                             moved[c] - after[j].translation) *
            before[j].rotation;
      }
      pose(t) = pose_from_world(skeleton, after[0].translation, rotations(after));
    }
    return true;
  }

  bool freeze() {
    choose(static_cast<int>(std::lround(0.5 * hz())) + 1);
    const HumanLimb& arm = human_limbs()[static_cast<std::size_t>(random_.whole(0, 1))];
    out_.bone = arm.lower;
    for (const B bone : {arm.upper, arm.lower, arm.end}) {
      const auto j = joint(bone);
      if (!j) return false;
      for (int t = out_.frames.first + 1; t <= out_.frames.last; ++t) {
        pose(t).parent_from_joint[*j] = pose(t - 1).parent_from_joint[*j];
      }
    }
    return true;
  }

  bool scale(double of_body, double of_path) {
    for (Joint& one : out_.motion.skeleton.joints) {
      one.parent_from_joint.translation *= of_body;
      if (one.tip_in_joint) *one.tip_in_joint *= of_body;
    }
    for (Pose& p : out_.motion.poses) p.root_in_world *= of_path;
    return true;
  }

  bool tilt() {
    const auto hips = joint(B::kHips);
    if (!hips) return false;
    const double angle = random_.uniform(0.0, 2.0 * std::numbers::pi);
    const glm::dquat turn =
        glm::angleAxis(3.0 * std::numbers::pi / 180.0,
                       glm::dvec3(std::cos(angle), 0.0, std::sin(angle)));
    // Below the hips, which may be far from the root.
    const glm::dvec3 start = world(0)[*hips].translation * glm::dvec3(1.0, 0.0, 1.0);
    for (Pose& p : out_.motion.poses) {
      p.root_in_world = start + turn * (p.root_in_world - start);
      p.parent_from_joint[0] = turn * p.parent_from_joint[0];
    }
    return true;
  }

  bool flip() {
    const HumanLimb& arm = human_limbs()[static_cast<std::size_t>(random_.whole(0, 1))];
    const auto j = joint(arm.lower);
    if (!j) return false;
    choose(3);
    out_.bone = arm.lower;
    const glm::dquat half_turn =
        glm::angleAxis(std::numbers::pi, glm::normalize(random_.normal3()));
    for (int t = out_.frames.first; t <= out_.frames.last; ++t) {
      pose(t).parent_from_joint[*j] = pose(t).parent_from_joint[*j] * half_turn;
    }
    return true;
  }

  bool cut() {
    const int missing = static_cast<int>(std::lround(0.3 * hz()));
    if (count() < missing + 20) return false;
    choose(missing);
    const auto first = out_.motion.poses.begin() + out_.frames.first;
    out_.motion.poses.erase(first, first + missing);
    out_.frames = {out_.frames.first - 1, out_.frames.first};
    return true;
  }

  // Reflection in X = 0 of rotations and places, with the names of before.
  bool mirror() {
    const auto reflect = [](const glm::dquat& q) {
      return glm::dquat(q.w, q.x, -q.y, -q.z);
    };
    for (Joint& one : out_.motion.skeleton.joints) {
      one.parent_from_joint.translation.x *= -1.0;
      one.parent_from_joint.rotation = reflect(one.parent_from_joint.rotation);
      if (one.tip_in_joint) one.tip_in_joint->x *= -1.0;
    }
    for (Pose& p : out_.motion.poses) {
      p.root_in_world.x *= -1.0;
      for (glm::dquat& q : p.parent_from_joint) q = reflect(q);
    }
    return true;
  }

  InjectedDefect out_;
  Random random_;
};

}  // namespace

std::string_view name(Defect defect) {
  return kNames[static_cast<std::size_t>(defect)];
}

std::optional<InjectedDefect> inject(const Motion& clean, Defect defect, unsigned seed) {
  return Injector(clean, seed).inject(defect);
}

}  // namespace marey::testing
