// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bodies/quadruped.h"

#include <string>
#include <utility>

#include "core/base/assert.h"

namespace marey::testing {
namespace {

struct Builder {
  Character animal;

  JointIndex add(const std::string& name,
                 const std::string& parent,
                 const glm::dvec3& from_parent) {
    Joint joint;
    joint.name = name;
    if (!parent.empty()) joint.parent = at(parent);
    joint.parent_from_joint.translation = from_parent;
    animal.skeleton.joints.push_back(std::move(joint));
    return JointIndex{static_cast<int>(animal.skeleton.joints.size()) - 1};
  }
  [[nodiscard]] JointIndex at(const std::string& name) const {
    const auto joint = animal.skeleton.find(name);
    MAREY_ASSERT(joint.has_value());
    return *joint;
  }
  void weigh(const std::string& name, const glm::dvec3& p_in_joint, double kg) {
    animal.masses.push_back({at(name), p_in_joint, kg});
  }
  BodyGroup& group(const std::string& name, int level, std::optional<int> parent) {
    BodyGroup group;
    group.name = name;
    group.level = level;
    group.parent = parent;
    animal.groups.push_back(std::move(group));
    return animal.groups.back();
  }
};

// A chain of joints, `step` from each to the next; the first hangs on `parent`.
void add_run(Builder& b,
             const std::string& name,
             int count,
             const std::string& parent,
             const glm::dvec3& first,
             const glm::dvec3& step) {
  std::string above = parent;
  for (int i = 1; i <= count; ++i) {
    const std::string here = name + std::to_string(i);
    b.add(here, above, i == 1 ? first : step);
    above = here;
  }
}

BodyPart section(const Builder& b, const std::string& name, int count) {
  BodyPart part;
  part.kind = PartKind::kSection;
  for (int i = 1; i <= count; ++i) part.joints.push_back(b.at(name + std::to_string(i)));
  return part;
}

BodyPart segment(const Builder& b, const std::string& name) {
  return {PartKind::kSegment, {b.at(name)}};
}

void add_leg(Builder& b, const std::string& leg, const std::string& on, double side) {
  const bool front = leg.starts_with("front");
  b.add(leg + " upper", on, {0.09 * side, front ? -0.12 : -0.02, 0.0});
  b.add(leg + " lower", leg + " upper", {0.0, -0.25, 0.0});
  b.add(leg + " paw", leg + " lower", {0.0, front ? -0.22 : -0.26, 0.0});
  b.animal.skeleton.joints.back().tip_in_joint = glm::dvec3(0.0, -0.06, 0.09);
  b.weigh(leg + " upper", {0.0, -0.1, 0.0}, front ? 1.6 : 2.0);
  b.weigh(leg + " lower", {0.0, -0.1, 0.0}, 0.6);
  b.weigh(leg + " paw", {0.0, -0.03, 0.04}, 0.2);
}

// Elbows bend forward, as a turn of the foreleg about -X; knees backward.
void add_leg_group(Builder& b, const std::string& leg, int level, int parent) {
  BodyGroup& group = b.group(leg + " leg", level, parent);
  group.can_support = true;
  group.parts.push_back(segment(b, leg + " paw"));
  const double bends = leg.starts_with("front") ? -1.0 : 1.0;
  group.parts.push_back({PartKind::kLimb,
                         {b.at(leg + " upper"), b.at(leg + " lower"), b.at(leg + " paw")},
                         {bends, 0.0, 0.0}});
}

void add_joints(Builder& b) {
  b.add("pelvis", "", {0.0, 0.6, -0.3});
  add_run(b, "back", 5, "pelvis", {0.0, 0.02, 0.08}, {0.0, 0.005, 0.11});
  add_run(b, "neck", 2, "back5", {0.0, 0.06, 0.1}, {0.0, 0.1, 0.08});
  b.add("head", "neck2", {0.0, 0.09, 0.06});
  b.animal.skeleton.joints.back().tip_in_joint = glm::dvec3(0.0, -0.04, 0.2);
  add_run(b, "tail", 4, "pelvis", {0.0, 0.02, -0.1}, {0.0, -0.03, -0.09});
  for (const double side : {1.0, -1.0}) {
    const std::string hand = side > 0.0 ? "left" : "right";
    add_leg(b, "front " + hand, "back5", side);
    add_leg(b, "hind " + hand, "pelvis", side);
  }
}

void add_limits(Builder& b) {
  for (const char* leg : {"front left", "front right", "hind left", "hind right"}) {
    const std::string name(leg);
    JointLimit limit;
    limit.joint = b.at(name + " lower");
    const bool front = name.starts_with("front");
    limit.min_rad = {front ? -2.6 : -0.1, -0.3, -0.3};
    limit.max_rad = {front ? 0.1 : 2.6, 0.3, 0.3};
    b.animal.limits.push_back(limit);
  }
}

}  // namespace

Character make_quadruped() {
  Builder b;
  b.animal.name = "quadruped";
  add_joints(b);
  b.weigh("pelvis", {0.0, 0.0, 0.03}, 5.0);
  for (int i = 1; i <= 5; ++i) {
    b.weigh("back" + std::to_string(i), {0.0, -0.05, 0.055}, 2.2);
  }
  for (int i = 1; i <= 2; ++i) b.weigh("neck" + std::to_string(i), {0, 0.04, 0.03}, 0.7);
  b.weigh("head", {0.0, 0.0, 0.07}, 1.8);
  for (int i = 1; i <= 4; ++i)
    b.weigh("tail" + std::to_string(i), {0, -0.01, -0.04}, 0.1);

  // Light to heavy. The back is the sixth group, the root the last.
  constexpr int kBack = 6;
  constexpr int kRoot = 7;
  BodyGroup& head = b.group("head", 3, kBack);
  head.balances = false;
  head.parts = {segment(b, "head"), section(b, "neck", 2)};
  BodyGroup& tail = b.group("tail", 2, kRoot);
  tail.parts = {section(b, "tail", 4)};
  add_leg_group(b, "front right", 3, kBack);
  add_leg_group(b, "front left", 3, kBack);
  add_leg_group(b, "hind right", 2, kRoot);
  add_leg_group(b, "hind left", 2, kRoot);
  b.group("back", 2, kRoot).parts = {section(b, "back", 5)};
  b.group("root", 1, std::nullopt).parts = {segment(b, "pelvis")};
  add_limits(b);
  return std::move(b.animal);
}

}  // namespace marey::testing
