// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/retarget/named_bodies.h"

#include "core/base/assert.h"
#include "core/human/average_proportions.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {

Skeleton named_body(const std::vector<std::string>& names) {
  MAREY_ASSERT(names.size() == human_bones().size());
  Skeleton body = make_humanoid(average_proportions(1.75));
  for (const HumanBone bone : human_bones()) {
    if (names[index(bone)].empty()) body = testing::without(body, bone);
  }
  for (Joint& joint : body.joints) {
    joint.name = names[index(*joint.bone)];
    joint.bone.reset();
  }
  return body;
}

Skeleton sided_body(const std::vector<std::string>& names,
                    const std::string& left,
                    const std::string& right) {
  MAREY_ASSERT(names.size() == 14);
  const auto side = [](std::string name, const std::string& word) {
    const std::size_t at = name.find("{side}");
    if (at != std::string::npos) name.replace(at, 6, word);
    return name;
  };
  std::vector<std::string> all(names.begin(), names.begin() + 6);
  for (const std::string& word : {left, right}) {
    for (std::size_t i = 6; i < 10; ++i) all.push_back(side(names[i], word));
  }
  for (const std::string& word : {left, right}) {
    for (std::size_t i = 10; i < 14; ++i) all.push_back(side(names[i], word));
  }
  return named_body(all);
}

Skeleton with_joint_above(const Skeleton& skeleton,
                          const std::string& below,
                          const std::string& name,
                          double share) {
  Skeleton out;
  std::vector<JointIndex> place;
  for (const Joint& original : skeleton.joints) {
    Joint joint = original;
    if (joint.parent) joint.parent = place[index(*joint.parent)];
    if (joint.name == below) {
      Joint between;
      between.name = name;
      between.parent = joint.parent;
      between.parent_from_joint.translation = share * joint.parent_from_joint.translation;
      joint.parent_from_joint.translation *= 1.0 - share;
      joint.parent = JointIndex{static_cast<int>(out.joints.size())};
      out.joints.push_back(between);
    }
    place.push_back(JointIndex{static_cast<int>(out.joints.size())});
    out.joints.push_back(joint);
  }
  return out;
}

}  // namespace marey::retarget
