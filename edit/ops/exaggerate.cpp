// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/exaggerate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "edit/signal/butterworth.h"
#include "edit/signal/rotation_channels.h"
#include "edit/state/hold_feet.h"
#include "edit/state/op_weights.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/format_text.h"

namespace marey::edit {
namespace {

constexpr double kMaxGain = 10.0;
constexpr int kMinFrames = 8;
constexpr double kExaggerateShown_m = 1e-4;
constexpr double kExaggerateToMm = 1e3;

/// Replacement of the lower low-pass version if there is no lower limit.
enum class Baseline { kMean, kLine };

Status check_band(const ExaggerateOp& op, const EditState& state) {
  if (!(op.gain >= -kMaxGain && op.gain <= kMaxGain)) {
    return bad_input(
        "gain", "is " + format_text("%g", op.gain), "use a value from -10 to 10");
  }
  const double nyquist_hz = 0.5 * state.motion.rate.hz;
  const auto check_hz = [&](const char* key, double hz) -> Status {
    if (hz >= 0.0 && hz < nyquist_hz) return Done{};
    return bad_input(key,
                     "is " + format_text("%g Hz", hz),
                     "use a value from 0 to below half the frame rate, " +
                         format_text("%g Hz", nyquist_hz));
  };
  if (const Status ok = check_hz("low_hz", op.low_hz); !ok) return ok.error();
  if (const Status ok = check_hz("high_hz", op.high_hz); !ok) return ok.error();
  if (op.high_hz > 0.0 && op.low_hz >= op.high_hz) {
    return bad_input("low_hz",
                     "is " + format_text("%g Hz", op.low_hz) + ", not below high_hz, " +
                         format_text("%g Hz", op.high_hz),
                     "exchange them, or use high_hz = 0 for no upper limit");
  }
  if (state.frame_count() >= kMinFrames) return Done{};
  return bad_input("",
                   "the motion has " + std::to_string(state.frame_count()) +
                       " frames, and 8 are needed",
                   "use a longer motion");
}

/// Replaces a channel by its mean, or by its line of least squares.
void flatten(std::vector<double>& channel, Baseline baseline) {
  const double count = static_cast<double>(channel.size());
  double mean = 0.0;
  for (const double value : channel) mean += value / count;
  const double middle = 0.5 * (count - 1.0);
  double slope = 0.0;
  if (baseline == Baseline::kLine) {
    double squares = 0.0;
    for (std::size_t t = 0; t < channel.size(); ++t) {
      const double x = static_cast<double>(t) - middle;
      slope += x * (channel[t] - mean);
      squares += x * x;
    }
    slope /= squares;
  }
  for (std::size_t t = 0; t < channel.size(); ++t) {
    channel[t] = mean + slope * (static_cast<double>(t) - middle);
  }
}

/// Adds gain - 1 times the band to a channel.
void amplify(const ExaggerateOp& op,
             double rate_hz,
             Baseline baseline,
             std::vector<double>& channel) {
  std::vector<double> upper = channel;
  std::vector<double> lower = channel;
  if (op.high_hz > 0.0) filter_butterworth(upper, op.high_hz, rate_hz);
  if (op.low_hz > 0.0) {
    filter_butterworth(lower, op.low_hz, rate_hz);
  } else {
    flatten(lower, baseline);
  }
  for (std::size_t t = 0; t < channel.size(); ++t) {
    channel[t] += (op.gain - 1.0) * (upper[t] - lower[t]);
  }
}

void amplify_root(const ExaggerateOp& op, Motion& motion) {
  std::vector<double> channel(motion.poses.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t t = 0; t < channel.size(); ++t) {
      channel[t] = motion.poses[t].root_in_world[axis];
    }
    amplify(op, motion.rate.hz, Baseline::kLine, channel);
    for (std::size_t t = 0; t < channel.size(); ++t) {
      motion.poses[t].root_in_world[axis] = channel[t];
    }
  }
}

void amplify_joint(const ExaggerateOp& op,
                   std::size_t joint,
                   Baseline baseline,
                   Motion& motion) {
  std::vector<glm::dquat> rotations;
  rotations.reserve(motion.poses.size());
  for (const Pose& pose : motion.poses) {
    rotations.push_back(pose.parent_from_joint[joint]);
  }
  const RotationChannels channels(rotations);
  std::array<std::vector<double>, 3> amplified = channels.channels();
  for (auto& channel : amplified) amplify(op, motion.rate.hz, baseline, channel);
  const std::vector<glm::dquat> out = channels.rotations_of(amplified);
  for (std::size_t t = 0; t < out.size(); ++t) {
    motion.poses[t].parent_from_joint[joint] = out[t];
  }
}

bool moves_feet(std::span<const EditGroup> groups) {
  return groups.empty() || std::any_of(groups.begin(), groups.end(), [](EditGroup group) {
           return group == EditGroup::kRoot || group == EditGroup::kLeftLeg ||
                  group == EditGroup::kRightLeg;
         });
}

}  // namespace

Result<EditState> apply_exaggerate(const ExaggerateOp& op,
                                   const OpContext& context,
                                   const EditState& state,
                                   OpReport& report) {
  if (const Status ok = check_band(op, state); !ok) return ok.error();
  const auto weights = op_weights(state, context.op);
  if (!weights) return weights.error();
  EditState out = state;
  const std::vector<EditGroup>& groups = context.op.groups;
  const std::size_t hips = index(state.map.hips());
  for (const JointIndex joint : joints_of_groups(state, groups)) {
    const bool is_root = index(joint) <= hips;
    amplify_joint(
        op, index(joint), is_root ? Baseline::kLine : Baseline::kMean, out.motion);
  }
  if (groups.empty() ||
      std::find(groups.begin(), groups.end(), EditGroup::kRoot) != groups.end()) {
    amplify_root(op, out.motion);
  }
  mix_motion(state.motion, *weights, state, groups, out.motion);
  if (moves_feet(groups)) {
    const HoldFeetReport held = hold_feet(
        state, state.motion, weights->frames, keep_standing_feet(state), out.motion);
    report.figures.emplace_back("lowered_mm", kExaggerateToMm * held.lowered_m);
    report.figures.emplace_back("feet_missed_mm", kExaggerateToMm * held.missed_m);
    if (held.missed_m > kExaggerateShown_m) {
      report.findings.push_back(
          fair_finding(
              "reach",
              "legs",
              "a standing foot leaves its place by " +
                  format_text("%.0f mm", kExaggerateToMm * held.missed_m) + " at " +
                  format_text("%.2f s", held.missed_frame / state.motion.rate.hz),
              "use a smaller gain, or groups without the root")
              .measured(kExaggerateToMm * held.missed_m, std::nullopt, "mm"));
    }
  }
  const double largest_m =
      mark_displaced(out, state.motion, weights->frames, context.index);
  report.figures.emplace_back("displaced_mm", kExaggerateToMm * largest_m);
  return out;
}

}  // namespace marey::edit
