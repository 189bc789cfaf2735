// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/jump_figures.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "dynamics/jumps/find_jumps.h"

#include "core/base/format_text.h"
#include "core/character_spec.h"
#include "core/human/body_track.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_track.h"
#include "retarget/body/place_masses.h"

namespace marey::app {
namespace {

constexpr std::size_t kMinFrames = 4;
constexpr double kFallTolerance_m_s2 = 1.0;
/// Times of a slower clip are uncertain by more than the edges of feet.
constexpr double kMinRate_hz = 50.0;

bool has_unit(const std::vector<Finding>& findings, const std::string& unit) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.unit == unit;
  });
}

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

std::vector<Finding> assess_jump(const dynamics::Jump& jump, int number, FrameRate rate) {
  std::vector<Finding> out = jump.findings;
  const std::string where = "jump " + std::to_string(number);
  const double off_m_s2 = std::abs(jump.fall_m_s2 + dynamics::kStandardGravity_m_s2);
  if (off_m_s2 > kFallTolerance_m_s2 && !has_unit(out, "m/s^2")) {
    out.push_back(fair_finding("gravity",
                               where,
                               "the captured flight accelerates at " +
                                   format_text("%.1f m/s^2", jump.fall_m_s2) +
                                   ", not at -9.8",
                               "repair it with marey jump --ballistic")
                      .measured(jump.fall_m_s2, std::nullopt, "m/s^2"));
  }
  if (rate.hz < kMinRate_hz && !has_unit(out, "Hz")) {
    out.push_back(fair_finding("rate",
                               where,
                               "the motion has " + format_text("%.4g", rate.hz) +
                                   " frames per second: times are uncertain by a frame",
                               "")
                      .measured(rate.hz, kMinRate_hz, "Hz"));
  }
  for (Finding& finding : out) {
    if (finding.where.empty() || finding.where == "jump") finding.where = where;
  }
  return out;
}

}  // namespace marey::app
