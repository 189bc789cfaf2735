// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/jump/report_jump.h"

#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/degrees.h"
#include "core/base/format_text.h"

namespace marey::edit {
namespace {

constexpr double kJumpToMm = 1e3;
/// Smaller errors are not reported. [m]
constexpr double kShownShortLeg_m = 0.001;
constexpr double kShownFoot_m = 0.001;
constexpr double kShownCom_m = 0.005;

/// Adds a new value and the captured one.
void add_pair(OpReport& report, const char* name, double made, double captured) {
  report.figures.emplace_back(name, made);
  report.figures.emplace_back(std::string("captured_") + name, captured);
}

double level_distance_m(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::distance(glm::dvec2(a.x, a.z), glm::dvec2(b.x, b.z));
}

}  // namespace

void report_jump_plan(const dynamics::JumpReference& reference,
                      const dynamics::JumpPlan& plan,
                      OpReport& report) {
  const dynamics::Jump& captured = reference.jump();
  const double captured_lowest_s =
      captured.start.time_s +
      reference.push_model().lowest().at * reference.push_model().duration_s();
  add_pair(report, "start_s", plan.start_s(), captured.start.time_s);
  add_pair(report, "lowest_s", plan.lowest_s(), captured_lowest_s);
  add_pair(report, "takeoff_s", plan.takeoff().time_s, captured.takeoff.time_s);
  add_pair(report, "apex_s", plan.apex_s(), captured.apex_s);
  if (plan.touchdown()) {
    add_pair(report, "touchdown_s", plan.touchdown()->time_s, captured.touchdown->time_s);
    add_pair(report, "rest_s", plan.rest()->time_s, captured.rest->time_s);
    add_pair(report,
             "airtime_s",
             plan.touchdown()->time_s - plan.takeoff().time_s,
             captured.touchdown->time_s - captured.takeoff.time_s);
  }
  add_pair(
      report, "rise_m", plan.apex_m() - plan.takeoff().p_in_world.y, captured.rise_m());
  add_pair(report,
           "takeoff_m_s",
           plan.takeoff().velocity_m_s.y,
           captured.takeoff.velocity_m_s.y);
  if (captured.landing_feet_in_world) {
    const glm::dvec3 landing = *captured.landing_feet_in_world;
    add_pair(report,
             "length_m",
             level_distance_m(landing + plan.landing_moved_m(),
                              captured.takeoff_feet_in_world),
             level_distance_m(landing, captured.takeoff_feet_in_world));
  }
  add_pair(report,
           "lowest_m",
           plan.push().lowest().height_m,
           reference.push_model().lowest().height_m);
  add_pair(report,
           "push_g",
           plan.push().peak_force_m_s2() / plan.gravity_m_s2(),
           reference.push().peak_g);
  report.figures.emplace_back("captured_fall_m_s2", captured.fall_m_s2);
  for (const Finding& finding : captured.findings) report.findings.push_back(finding);
  for (const Finding& finding : plan.findings()) report.findings.push_back(finding);
}

void report_jump_body(const retarget::FollowComReport& body,
                      FrameRate rate,
                      OpReport& report) {
  report.figures.emplace_back("com_error_mm", kJumpToMm * body.worst_flight_com_m);
  report.figures.emplace_back("com_error_push_mm", kJumpToMm * body.worst_com_m);
  report.figures.emplace_back("slide_mm", kJumpToMm * body.worst_foot_m);
  report.figures.emplace_back("raised_heel_mm", kJumpToMm * body.raised_heel_m);
  report.figures.emplace_back("short_leg_mm", kJumpToMm * body.short_leg_m);
  if (body.worst_foot_m > kShownFoot_m) {
    report.findings.push_back(
        fair_finding("foot",
                     "feet",
                     "a foot leaves its place by up to " +
                         format_text("%.0f mm", kJumpToMm * body.worst_foot_m) +
                         ", the most at " +
                         format_text("%.2f s", body.worst_foot_frame / rate.hz) +
                         ", since the legs are too short there",
                     "choose a smaller change, or another push_s")
            .measured(kJumpToMm * body.worst_foot_m, std::nullopt, "mm"));
  }
  if (body.short_leg_m < kShownShortLeg_m && body.worst_com_m > kShownCom_m) {
    report.findings.push_back(
        fair_finding("folded_leg",
                     "legs",
                     "legs do not fold as far as planned; the centre of mass is off its "
                     "plan by up to " +
                         format_text("%.0f mm", kJumpToMm * body.worst_com_m) + " at " +
                         format_text("%.2f s", body.worst_com_frame / rate.hz),
                     "choose a smaller change, or another push_s")
            .measured(kJumpToMm * body.worst_com_m, std::nullopt, "mm"));
  }
  if (body.short_leg_m < kShownShortLeg_m) return;
  report.findings.push_back(
      fair_finding("short_leg",
                   "legs",
                   "a leg is too short by up to " +
                       format_text("%.0f mm", kJumpToMm * body.short_leg_m) + " in " +
                       std::to_string(body.short_leg_frames) + " frames, the most at " +
                       format_text("%.2f s", body.short_leg_frame / rate.hz) +
                       "; the centre of mass is off its plan by up to " +
                       format_text("%.0f mm", kJumpToMm * body.worst_com_m),
                   "choose a smaller change, or another push_s")
          .measured(kJumpToMm * body.short_leg_m, std::nullopt, "mm"));
}

void report_jump_momentum(const dynamics::MomentumRepair& repair, OpReport& report) {
  report.figures.emplace_back("momentum_kg_m2_s", repair.sd_after_kg_m2_s);
  report.figures.emplace_back("captured_momentum_kg_m2_s", repair.sd_before_kg_m2_s);
  report.figures.emplace_back("turn_deg", repair.largest_turn_rad * kDegreesPerRadian);
  if (repair.applied) return;
  if (repair.largest_turn_rad <= 0.0) {
    report.findings.push_back(
        fair_finding("momentum",
                     "flight",
                     "no rotation makes the angular momentum constant, so the captured "
                     "rotations are kept",
                     "check the rotations of the flight"));
    return;
  }
  report.findings.push_back(
      fair_finding(
          "momentum",
          "flight",
          "a constant angular momentum would turn the body by " +
              format_text("%.0f degrees", repair.largest_turn_rad * kDegreesPerRadian) +
              ", so the captured rotations are kept",
          "check the rotations of the flight")
          .measured(
              repair.largest_turn_rad * kDegreesPerRadian, std::nullopt, "degrees"));
}

}  // namespace marey::edit
