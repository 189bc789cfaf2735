// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/clips/motion_base.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/engine/check_motion_clip.h"

namespace marey::engine {
namespace {

constexpr double kMinPhase_s = 0.04;

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
    std::optional<std::string> fault = motion_clip_fault(clip);
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
