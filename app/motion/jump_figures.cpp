// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/jump_figures.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "dynamics/jumps/find_jumps.h"

#include "core/character_spec.h"
#include "core/human/body_track.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_track.h"
#include "retarget/body/place_masses.h"

namespace marey::app {
namespace {

constexpr std::size_t kMinFrames = 4;
}  // namespace

std::optional<std::vector<dynamics::Jump>> find_motion_jumps(const Motion& motion) {
  if (motion.poses.size() < kMinFrames || !(motion.rate.hz > 0.0)) return std::nullopt;
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) return std::nullopt;
  const auto masses = retarget::place_masses(motion.skeleton, *map, MassSpec{});
  if (!masses) return std::nullopt;
  const BodyTrack track = retarget::body_track(motion, *map, *masses);
  const bool is_finite = std::all_of(
      track.com_in_world.begin(), track.com_in_world.end(), [](const glm::dvec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
      });
  if (!is_finite) return std::nullopt;
  return dynamics::find_jumps(track);
}

std::vector<Finding> findings_of_jump_number(const dynamics::Jump& jump, int number) {
  std::vector<Finding> out = jump.findings;
  for (Finding& finding : out) {
    if (finding.where.empty()) finding.where = "jump " + std::to_string(number);
  }
  return out;
}

}  // namespace marey::app
