// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/engine/check_motion_clip.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace marey {
namespace {

using ClipFault = std::optional<std::string>;

/// Maximum magnitude of the numbers of a posture: a mistake in any unit.
constexpr float kMaxClipValue = 1e6F;

/// False for a number that is not finite, too.
bool are_plausible(std::span<const float> values) {
  for (const float value : values) {
    if (!(std::abs(value) <= kMaxClipValue)) return false;
  }
  return true;
}

bool is_rotation(const BlendPosture& frame, std::size_t r) {
  constexpr double kMaxError = 1e-3;
  double squares = 0.0;
  for (const float part : {frame.x[r], frame.y[r], frame.z[r], frame.w[r]}) {
    squares += static_cast<double>(part) * static_cast<double>(part);
  }
  return std::abs(std::sqrt(squares) - 1.0) <= kMaxError;
}

ClipFault frame_fault(const BlendPosture& frame) {
  for (std::size_t r = 0; r < kPostureRotations; ++r) {
    if (!is_rotation(frame, r)) {
      return "rotation " + std::to_string(r) + " is not of unit length";
    }
  }
  const std::array others{frame.height_legs, frame.abdomen_share, frame.torso_share};
  const bool is_ok = are_plausible(frame.fold_rad) && are_plausible(frame.mid_x) &&
                     are_plausible(frame.mid_y) && are_plausible(frame.upper_twist_rad) &&
                     are_plausible(frame.lower_twist_rad) && are_plausible(others);
  if (is_ok) return std::nullopt;
  return "a number is not finite or out of range";
}

ClipFault frames_fault(const MotionClip& clip) {
  if (clip.frames.size() < 2) return "it has fewer than two frames";
  if (clip.path.size() != clip.frames.size()) {
    return "it has " + std::to_string(clip.frames.size()) + " frames and " +
           std::to_string(clip.path.size()) + " places on the floor";
  }
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    ClipFault fault = frame_fault(clip.frames[i]);
    const ClipRoot& root = clip.path[i];
    if (!are_plausible(std::array{root.x_legs, root.z_legs, root.heading_rad})) {
      fault = "its place on the floor is not finite or out of range";
    }
    if (fault) return "frame " + std::to_string(i) + ": " + *fault;
  }
  return std::nullopt;
}

ClipFault contacts_fault(const MotionClip& clip) {
  constexpr double kRounding_s = 1e-3;
  for (const std::vector<ClipSpan>& part : clip.contacts) {
    float end_s = 0.0F;
    for (const ClipSpan& span : part) {
      const bool ascends =
          span.start_s >= end_s && span.end_s > span.start_s &&
          static_cast<double>(span.end_s) <= clip.duration_s() + kRounding_s;
      if (!ascends) return "its contacts do not ascend or are outside of the clip";
      end_s = span.end_s;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> motion_clip_fault(const MotionClip& clip) {
  constexpr float kMaxLeg_m = 100.0F;
  if (clip.name.empty()) return "it has no name";
  if (!(clip.rate_hz > 0.0F && clip.rate_hz <= kMaxClipValue)) {
    return "its rate is not positive";
  }
  if (!(clip.leg_length_m > 0.0F && clip.leg_length_m <= kMaxLeg_m)) {
    return "the length of its body's legs is outside 0 to 100 m";
  }
  if (ClipFault fault = frames_fault(clip)) return fault;
  return contacts_fault(clip);
}

}  // namespace marey
