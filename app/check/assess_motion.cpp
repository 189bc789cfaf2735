// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_motion.h"

#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/base/in_quotes.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "core/transform.h"

namespace marey::app {
namespace {

constexpr double kMaxTurn_rad_s = 45.0;
constexpr double kMaxSpeed_m_s = 25.0;

/// Worst step from one frame to the next, relative to the limits.
struct Leap {
  double in_limits = 1.0;
  std::string what;
  std::size_t frame = 0;  ///< Second frame of the step; 0 is the trial's first.
  int frames = 0;         ///< Number of frames with a step beyond the limits.
  std::size_t last = 0;   ///< The last of them.

  /// Adds a step. Precondition: the steps of one frame come from parents to children.
  void add_step(double here_in_limits, std::size_t at, const auto& words) {
    if (here_in_limits <= 1.0) return;
    frames += at != last ? 1 : 0;
    last = at;
    // Children of a turning segment turn by the same angle; the parent is reported.
    if (here_in_limits <= in_limits * (1.0 + 1e-9)) return;
    in_limits = here_in_limits;
    frame = at;
    what = words();
  }
};

}  // namespace

std::vector<Finding> assess_motion(const ReportTrial& trial) {
  if (trial.bodies.empty()) return {};
  const ReportBody& body = trial.bodies.front();
  const Motion& motion = body.motion;
  if (body.uncertainty.size() != motion.poses.size()) return {};
  const double hz = trial.rate.hz;
  Leap leap;
  std::vector<RigidTransform> before;
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    std::vector<RigidTransform> now = world_from_joints(motion.skeleton, motion.poses[f]);
    for (std::size_t b = 0; f > 0 && b < kHumanBoneCount; ++b) {
      const auto is_measured = [&](std::size_t frame) {
        return body.uncertainty[frame].size() > b &&
               body.uncertainty[frame][b].source == Source::kMeasured;
      };
      if (!is_measured(f - 1) || !is_measured(f)) continue;
      const HumanBone bone = human_bones()[b];
      const double turn_rad = glm::length(
          rotation_vector(glm::conjugate(before[b].rotation) * now[b].rotation));
      leap.add_step(turn_rad * hz / kMaxTurn_rad_s, f, [&] {
        return "segment " + in_quotes(name(bone)) + " turns by " +
               std::to_string(std::lround(glm::degrees(turn_rad))) + " degrees";
      });
      const double moved_m = glm::distance(before[b].translation, now[b].translation);
      leap.add_step(moved_m * hz / kMaxSpeed_m_s, f, [&] {
        return "joint " + in_quotes(name(bone)) + " travels by " +
               std::to_string(std::lround(1e3 * moved_m)) + " mm";
      });
    }
    before = std::move(now);
  }
  if (leap.frames == 0) return {};
  const int second = trial.first_frame + static_cast<int>(leap.frame);
  std::string cause = leap.what + " between frames " + std::to_string(second - 1) +
                      " and " + std::to_string(second) + ", faster than a body can move";
  const int others = leap.frames - 1;
  if (others > 0) {
    cause += " (" + std::to_string(others) + " other frame" + (others > 1 ? "s" : "") +
             " also)";
  }
  return {poor_finding(
      "leap",
      "trial " + trial.name,
      std::move(cause),
      "look at these frames in report.html, and check that two cameras see the tags of "
      "that segment there; a second tag on it helps")};
}

}  // namespace marey::app
