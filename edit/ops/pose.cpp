// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/pose.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "edit/state/check_op_keys.h"
#include "edit/state/displace_bone.h"
#include "edit/state/op_weights.h"
#include "edit/state/resolve_moment.h"

#include "core/base/format_text.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

/// Returns the weights about a frame.
OpWeights bell_weights(int frame_count, double at_frame, double width_frames) {
  OpWeights out;
  out.weight.resize(static_cast<std::size_t>(frame_count), 0.0);
  out.frames = {0, -1};
  for (int frame = 0; frame < frame_count; ++frame) {
    const double away = std::abs(frame - at_frame) / width_frames;
    const double weight = away < 1.0 ? smooth_step(1.0 - away) : 0.0;
    out.weight[static_cast<std::size_t>(frame)] = weight;
    if (weight <= 0.0) continue;
    if (out.frames.last < out.frames.first) out.frames.first = frame;
    out.frames.last = frame;
  }
  return out;
}

}  // namespace

Result<EditState> apply_pose(const PoseOp& op,
                             const OpContext& context,
                             const EditState& state,
                             OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  constexpr double kMaxWidth_s = 1e6;
  if (!(op.width_s > 0.0 && op.width_s < kMaxWidth_s)) {  // True for NaN.
    return bad_input("width_s",
                     "is " + format_text("%g", op.width_s) + " s",
                     "give the time before and after the instant, above 0");
  }
  const auto at = resolve_moment(state, op.at);
  if (!at) return at.error();
  const OpWeights weights =
      bell_weights(state.frame_count(), *at, op.width_s * state.motion.rate.hz);
  if (weights.frames.last < weights.frames.first) {
    return bad_input(
        "width_s",
        "no frame is within " + format_text("%g", op.width_s) + " s of the instant",
        "use at least the time of one frame, " +
            format_text("%.4f", 1.0 / state.motion.rate.hz) + " s");
  }
  EditState out = state;
  const Status ok =
      displace_bone({op.bone, op.rotation, op.moved_m}, weights, out, report);
  if (!ok) return ok.error();
  return out;
}

}  // namespace marey::edit
