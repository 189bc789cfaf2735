// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/character/check_groups.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/in_quotes.h"

namespace marey::retarget {
namespace {

constexpr double kNoLength = 1e-6;  // [m] A shorter bone has no direction.

bool hangs_on(const Skeleton& skeleton, JointIndex joint, JointIndex ancestor) {
  auto above = skeleton[joint].parent;
  while (above && *above != ancestor) above = skeleton[*above].parent;
  return above.has_value();
}

Status check_names(const CharacterCheck& check) {
  const auto& groups = check.character.groups;
  if (groups.empty()) {
    return check.refuse(
        "groups", "there are none", "give the table of the body's groups");
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::string& name = groups[g].name;
    if (name.empty()) {
      return check.refuse("group " + std::to_string(g), "it has no name", "name it");
    }
    for (std::size_t other = 0; other < g; ++other) {
      if (groups[other].name != name) continue;
      return check.refuse(
          "group " + in_quotes(name), "there are two of this name", "rename one");
    }
    if (groups[g].parts.empty()) {
      return check.refuse("group " + in_quotes(name), "it has no parts", "leave it out");
    }
  }
  return Done{};
}

Status check_hierarchy(const CharacterCheck& check) {
  const auto& groups = check.character.groups;
  const int count = static_cast<int>(groups.size());
  for (int g = 0; g < count; ++g) {
    const BodyGroup& group = groups[static_cast<std::size_t>(g)];
    const std::string called = "group " + in_quotes(group.name);
    int steps = 0;
    for (auto up = group.parent; up; up = groups[static_cast<std::size_t>(*up)].parent) {
      if (*up < 0 || *up >= count) {
        return check.refuse(called, "its parent is not a group", "correct its parent");
      }
      if (++steps <= count) continue;
      return check.refuse(called, "its parents form a cycle", "correct a parent");
    }
    const int above =
        group.parent ? groups[static_cast<std::size_t>(*group.parent)].level : 0;
    if (group.level != above + 1) {
      return check.refuse(called,
                          "its level is " + std::to_string(group.level) + ", not " +
                              std::to_string(above + 1),
                          "give the root level 1 and others one more than their parent");
    }
    if ((g + 1 == count) != (group.level == 1)) {
      return check.refuse(called,
                          group.level == 1 ? "it is the root but not the last group"
                                           : "it is the last group but not the root",
                          "put the one group of level 1 at the end");
    }
  }
  return Done{};
}

// Checks that lower joints are descendants of higher ones, without joints of the table
// between them.
Status check_chain(const CharacterCheck& check,
                   const std::string& called,
                   const std::vector<JointIndex>& joints) {
  for (std::size_t i = 1; i < joints.size(); ++i) {
    if (!hangs_on(check.character.skeleton, joints[i], joints[i - 1])) {
      return check.refuse(called,
                          check.called(joints[i]) + " is not a descendant of " +
                              check.called(joints[i - 1]),
                          "list the joints of the part from its root to its end");
    }
    auto between = check.character.skeleton[joints[i]].parent;
    for (; *between != joints[i - 1];
         between = check.character.skeleton[*between].parent) {
      if (check.group_of[index(*between)] < 0) continue;
      return check.refuse(
          called,
          check.called(*between) + " lies within the part and is in group " +
              in_quotes(
                  check.character
                      .groups[static_cast<std::size_t>(check.group_of[index(*between)])]
                      .name),
          "remove it from the table, or add it to the part");
    }
  }
  return Done{};
}

Status check_limb(const CharacterCheck& check,
                  const std::string& called,
                  const BodyPart& limb) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (glm::distance(check.place(limb.joints[i]), check.place(limb.joints[i + 1])) >=
        kNoLength) {
      continue;
    }
    return check.refuse(called,
                        "its bone from " + check.called(limb.joints[i]) + " to " +
                            check.called(limb.joints[i + 1]) + " has no length",
                        "choose joints at different positions");
  }
  const glm::dvec3& hinge = limb.hinge_in_upper;
  const glm::dvec3 bone_in_upper =
      inverse(check.world_from_joint[index(limb.joints[0])]) *
      check.place(limb.joints[1]);
  const double along = glm::dot(hinge, glm::normalize(bone_in_upper));
  // Comparisons are written so that NaN is rejected.
  if (!(std::abs(glm::length(hinge) - 1.0) < kRounded)) {
    return check.refuse(
        called, "its hinge is not a unit vector", "divide it by its length");
  }
  if (!(std::abs(along) < kRounded)) {
    return check.refuse(
        called,
        "its hinge is not perpendicular to " + check.called(limb.joints[0]),
        "give the axis about which the limb bends");
  }
  return Done{};
}

Status check_parts(const CharacterCheck& check, const BodyGroup& group) {
  const std::string called = "group " + in_quotes(group.name);
  for (const BodyPart& part : group.parts) {
    const std::size_t n = part.joints.size();
    if (part.kind == PartKind::kSegment && n != 1) {
      return check.refuse(called, "a segment is one joint", "list it alone");
    }
    if (part.kind == PartKind::kLimb && n != 3) {
      return check.refuse(
          called, "a limb is three joints", "list its upper, lower and end joint");
    }
    if (n == 0) {
      return check.refuse(called, "a section has no joints", "leave it out");
    }
    Status chained = check_chain(check, called, part.joints);
    if (!chained) return chained;
    if (part.kind != PartKind::kLimb) continue;
    if (Status limb = check_limb(check, called, part); !limb) return limb;
  }
  return Done{};
}

// Returns true for a limb's end that is also a segment: the hand that rotates on the
// wrist.
bool is_in_two_parts(const BodyGroup& group, JointIndex joint) {
  int ends = 0;
  int segments = 0;
  int all = 0;
  for (const BodyPart& part : group.parts) {
    for (const JointIndex& one : part.joints) {
      if (one != joint) continue;
      ++all;
      if (part.kind == PartKind::kSegment) ++segments;
      if (part.kind == PartKind::kLimb && &one == &part.joints.back()) ++ends;
    }
  }
  return all > 2 || (all == 2 && (ends != 1 || segments != 1));
}

Status claim_joints(CharacterCheck& check, int g) {
  const auto& groups = check.character.groups;
  const BodyGroup& group = groups[static_cast<std::size_t>(g)];
  const std::string called = "group " + in_quotes(group.name);
  for (const BodyPart& part : group.parts) {
    for (const JointIndex joint : part.joints) {
      if (!check.has(joint)) {
        return check.refuse(
            called,
            "the skeleton has no joint " + std::to_string(static_cast<int>(joint)),
            "name one of its joints");
      }
      int& owner = check.group_of[index(joint)];
      if (owner >= 0 && owner != g) {
        return check.refuse(called,
                            check.called(joint) + " is also in group " +
                                in_quotes(groups[static_cast<std::size_t>(owner)].name),
                            "leave it in one of them");
      }
      owner = g;
      if (!is_in_two_parts(group, joint)) continue;
      return check.refuse(
          called, check.called(joint) + " is in two parts", "leave it in one of them");
    }
  }
  return Done{};
}

}  // namespace

Error CharacterCheck::refuse(const std::string& element,
                             std::string cause,
                             std::string next) const {
  std::string where = "character";
  if (!character.name.empty()) where.append(" ").append(in_quotes(character.name));
  return bad_input(where.append(": ").append(element), std::move(cause), std::move(next));
}

bool CharacterCheck::has(JointIndex joint) const {
  const int i = static_cast<int>(joint);
  return i >= 0 && static_cast<std::size_t>(i) < character.skeleton.joints.size();
}

std::string CharacterCheck::called(JointIndex joint) const {
  const std::string& name = character.skeleton[joint].name;
  if (!name.empty()) return std::string("joint ").append(in_quotes(name));
  return "joint " + std::to_string(static_cast<int>(joint));
}

Status check_groups(CharacterCheck& check) {
  if (Status names = check_names(check); !names) return names;
  if (Status order = check_hierarchy(check); !order) return order;
  const auto& groups = check.character.groups;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Status claimed = claim_joints(check, static_cast<int>(g));
    if (!claimed) return claimed;
  }
  for (const BodyGroup& group : groups) {
    if (Status parts = check_parts(check, group); !parts) return parts;
  }
  return Done{};
}

}  // namespace marey::retarget
