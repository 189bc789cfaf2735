// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/retime.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "edit/state/check_op_keys.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include "edit/state/resolve_moment.h"

#include "core/base/format_text.h"
#include "core/time_warp.h"

namespace marey::edit {
namespace {

constexpr double kMinSpeed = 0.05;
constexpr double kMaxSpeed = 20.0;
constexpr double kMaxFrames = 5e6;
/// An instant this near to a frame is the frame's. [frames]
constexpr double kRetimeOnFrame = 1e-9;

Status check_speed(double speed, const char* key) {
  if (speed >= kMinSpeed && speed <= kMaxSpeed) return Done{};
  return bad_input(key,
                   "asks for " + format_text("%.3g", speed) + " times the speed",
                   "choose a speed between 0.05 and 20");
}

Result<std::vector<WarpKnot>> retime_knots(const RetimeOp& op, const Timeline& timeline) {
  const double hz = timeline.rate_hz;
  std::vector<WarpKnot> knots;
  for (const RetimeKnot& wanted : op.knots) {
    const auto frame = resolve_moment(timeline, wanted.at);
    if (!frame) return frame.error();
    const WarpKnot knot{wanted.time_s, *frame / hz};
    if (knots.empty() && knot.source_s > 0.0) knots.push_back({0.0, 0.0});
    if (!knots.empty() &&
        (knot.time_s <= knots.back().time_s || knot.source_s <= knots.back().source_s)) {
      return bad_input("knots",
                       "do not ascend: " + format_text("%.3f", knot.source_s) +
                           " s of the motion cannot appear at " +
                           format_text("%.3f", knot.time_s) + " s",
                       "let both times of each knot be after those of the knot before");
    }
    if (!knots.empty()) {
      const double speed =
          (knot.source_s - knots.back().source_s) / (knot.time_s - knots.back().time_s);
      if (const Status ok = check_speed(speed, "knots"); !ok) return ok.error();
    }
    knots.push_back(knot);
  }
  if (knots.front().time_s != 0.0) {
    return bad_input(
        "knots",
        "show the first frame at " + format_text("%.3f", knots.front().time_s) + " s",
        "let the first knot have time_s = 0, or begin with a later instant");
  }
  if (timeline.duration_s() > knots.back().source_s) {
    const double rest_s = timeline.duration_s() - knots.back().source_s;
    knots.push_back({knots.back().time_s + rest_s, timeline.duration_s()});
  }
  return knots;
}

Result<std::vector<WarpKnot>> warp_of(const RetimeOp& op, const Timeline& timeline) {
  const int choices =
      (op.knots.empty() ? 0 : 1) + (op.speed ? 1 : 0) + (op.duration_s ? 1 : 0);
  if (choices > 1 || (choices == 0 && !op.rate_hz)) {
    return bad_input("retime",
                     choices > 1 ? "has several of knots, speed and duration_s"
                                 : "has none of knots, speed, duration_s and rate_hz",
                     "state one of them");
  }
  if (!op.knots.empty()) return retime_knots(op, timeline);
  double speed = op.speed.value_or(1.0);
  if (op.duration_s) {
    if (timeline.frame_count < 2) {
      return bad_input("duration_s", "cannot stretch a single frame", "remove it");
    }
    speed = timeline.duration_s() / *op.duration_s;
  }
  if (const Status ok = check_speed(speed, op.duration_s ? "duration_s" : "speed"); !ok) {
    return ok.error();
  }
  const double end_s = timeline.frame_count < 2 ? 1.0 : timeline.duration_s();
  return std::vector<WarpKnot>{{0.0, 0.0}, {end_s / speed, end_s}};
}

}  // namespace

Result<RetimedFrames> retimed_frames(const RetimeOp& op, const Timeline& timeline) {
  const auto knots = warp_of(op, timeline);
  if (!knots) return knots.error();
  RetimedFrames out;
  out.rate_hz = op.rate_hz.value_or(timeline.rate_hz);
  if (!(out.rate_hz >= 1.0 && out.rate_hz <= 10000.0)) {
    return bad_input(
        "rate_hz", "is " + format_text("%g", out.rate_hz), "choose 1 to 10000");
  }
  const double end_s = timeline.frame_count < 2 ? 0.0 : knots->back().time_s;
  if (end_s * out.rate_hz > kMaxFrames) {
    return bad_input("retime",
                     "would give " + format_text("%.0f", end_s * out.rate_hz) + " frames",
                     "choose a lower rate or a shorter duration");
  }
  const TimeWarp warp(*knots);
  const double last = timeline.frame_count - 1;
  const auto count = static_cast<std::size_t>(std::floor(end_s * out.rate_hz + 1e-6)) + 1;
  for (std::size_t k = 0; k < count; ++k) {
    double at = warp.source_s(static_cast<double>(k) / out.rate_hz) * timeline.rate_hz;
    const double nearest = std::round(at);
    if (std::abs(at - nearest) < kRetimeOnFrame * (1.0 + last)) at = nearest;
    out.at_frame.push_back(std::clamp(at, 0.0, last));
  }
  while (out.at_frame.size() > 1 &&
         out.at_frame[out.at_frame.size() - 2] >= out.at_frame.back()) {
    out.at_frame.pop_back();
  }
  return out;
}

Result<EditState> apply_retime(const RetimeOp& op,
                               const OpContext& context,
                               const EditState& state,
                               OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  const auto frames = retimed_frames(op, timeline_of(state));
  if (!frames) return frames.error();
  EditState out = resample_state(state, frames->at_frame, frames->rate_hz);
  touch(out.lineage, {0, out.frame_count() - 1}, context.index);
  report.figures.emplace_back("duration_s", out.duration_s());
  report.figures.emplace_back("slide_mm", measure_slide(out).worst_drift_mm);
  return out;
}

}  // namespace marey::edit
