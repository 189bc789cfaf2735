// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/clips/motion_base.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace marey::engine {
namespace {

constexpr double kMinPhase_s = 0.04;

bool is_unit(const BlendPosture& posture) {
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const float square = posture.x[i] * posture.x[i] + posture.y[i] * posture.y[i] +
                         posture.z[i] * posture.z[i] + posture.w[i] * posture.w[i];
    if (!(std::abs(square - 1.0F) < 1e-3F)) return false;
  }
  return true;
}

bool is_finite(const BlendPosture& posture) {
  float sum = posture.height_legs + posture.abdomen_share + posture.torso_share;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += posture.fold_rad[i] + posture.mid_x[i] + posture.mid_y[i] +
           posture.upper_twist_rad[i] + posture.lower_twist_rad[i];
  }
  return std::isfinite(sum);
}

std::optional<std::string> fault_of_frames(const MotionClip& clip) {
  if (clip.frames.size() < 2) return "the clip has fewer than two frames";
  if (clip.path.size() != clip.frames.size()) {
    return "the path has " + std::to_string(clip.path.size()) + " entries for " +
           std::to_string(clip.frames.size()) + " frames";
  }
  for (std::size_t t = 0; t < clip.frames.size(); ++t) {
    const ClipRoot& root = clip.path[t];
    const float sum = root.x_legs + root.z_legs + root.heading_rad;
    if (!is_finite(clip.frames[t]) || !std::isfinite(sum)) {
      return "frame " + std::to_string(t) + " has a number that is not finite";
    }
    if (!is_unit(clip.frames[t])) {
      return "frame " + std::to_string(t) + " has a rotation that is not of unit length";
    }
  }
  return std::nullopt;
}

std::optional<std::string> fault_of_contacts(const MotionClip& clip) {
  const float duration = static_cast<float>(clip.duration_s()) + 1e-3F;
  for (const std::vector<ClipSpan>& spans : clip.contacts) {
    float last = 0.0F;
    for (const ClipSpan& span : spans) {
      if (!(span.start_s >= last && span.end_s > span.start_s &&
            span.end_s <= duration)) {
        return "the contacts do not ascend, or are outside of the clip";
      }
      last = span.end_s;
    }
  }
  return std::nullopt;
}

std::optional<std::string> fault_of(const MotionClip& clip) {
  if (clip.name.empty()) return "the clip has no name";
  if (!(clip.rate_hz > 0.0F) || !std::isfinite(clip.rate_hz)) {
    return "the rate is not positive";
  }
  if (!(clip.leg_length_m > 0.0F) || !std::isfinite(clip.leg_length_m)) {
    return "the leg length is not positive";
  }
  if (auto fault = fault_of_frames(clip)) return fault;
  return fault_of_contacts(clip);
}

}  // namespace

MotionBase::MotionBase(MoveSet moves) : moves_(std::move(moves)) {
  for (const MotionClip& clip : moves_.clips) {
    phases_.push_back(phases_of(clip, kMinPhase_s));
  }
}

Result<std::shared_ptr<const MotionBase>> MotionBase::make(MoveSet moves) {
  std::sort(moves.clips.begin(),
            moves.clips.end(),
            [](const MotionClip& a, const MotionClip& b) { return a.name < b.name; });
  for (std::size_t i = 0; i < moves.clips.size(); ++i) {
    const MotionClip& clip = moves.clips[i];
    std::optional<std::string> fault = fault_of(clip);
    if (!fault && i > 0 && moves.clips[i - 1].name == clip.name) {
      fault = "two clips have this name";
    }
    if (fault) {
      return bad_input(
          "clip \"" + clip.name + "\"", *fault, "build the base again from its sources");
    }
  }
  return std::shared_ptr<const MotionBase>(new MotionBase(std::move(moves)));
}

std::optional<std::size_t> MotionBase::find(std::string_view name) const {
  const auto it = std::lower_bound(
      moves_.clips.begin(),
      moves_.clips.end(),
      name,
      [](const MotionClip& clip, std::string_view wanted) { return clip.name < wanted; });
  if (it == moves_.clips.end() || it->name != name) return std::nullopt;
  return static_cast<std::size_t>(it - moves_.clips.begin());
}

bool MotionBase::has_contacts(std::size_t clip) const {
  return std::any_of(moves_.clips[clip].contacts.begin(),
                     moves_.clips[clip].contacts.end(),
                     [](const std::vector<ClipSpan>& spans) { return !spans.empty(); });
}

}  // namespace marey::engine
