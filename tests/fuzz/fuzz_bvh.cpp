// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "recordings/motion/bvh.h"

namespace {

using namespace marey;
using namespace marey::recordings;

/// Asserts that a written motion is read back unchanged: the joints' places to six
/// decimals, and the rate.
void read_again(const Motion& first) {
  const Result<BvhMotion> second = parse_bvh(bvh_text(first), "again.bvh");
  MAREY_ASSERT(second.has_value());
  const Motion& motion = second->motion;
  MAREY_ASSERT(std::abs(motion.rate.hz - first.rate.hz) <= 1e-4 * first.rate.hz);
  MAREY_ASSERT(motion.poses.size() == first.poses.size());
  MAREY_ASSERT(motion.skeleton.joints.size() == first.skeleton.joints.size());
  double reach_m = 1.0;
  for (const Joint& joint : first.skeleton.joints) {
    reach_m += glm::length(joint.parent_from_joint.translation);
  }
  for (std::size_t i = 0; i < first.poses.size(); ++i) {
    const auto a = world_from_joints(first.skeleton, first.poses[i]);
    const auto b = world_from_joints(motion.skeleton, motion.poses[i]);
    // Depth first both, so that joints have their order.
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double apart_m = glm::distance(a[k].translation, b[k].translation);
      MAREY_ASSERT(apart_m <= 1e-7 * reach_m * static_cast<double>(a.size()));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<BvhMotion> read = parse_bvh(text, "fuzz.bvh");
  if (!read) return 0;
  const std::size_t rotations =
      read->motion.poses.size() * read->motion.skeleton.joints.size();
  const auto& joints = read->motion.skeleton.joints;
  // A joint 10 km away and its place again take more decimals than a file has.
  const bool near = std::all_of(joints.begin(), joints.end(), [](const Joint& joint) {
    return glm::length(joint.parent_from_joint.translation) < 100.0;
  });
  if (rotations < 1000 && joints.size() < 200 && near) read_again(read->motion);
  return 0;
}
