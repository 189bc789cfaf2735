// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/clips/motion_base.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/assert.h"
#include "core/engine/check_motion_clip.h"

namespace marey::engine {
namespace {

constexpr double kMinPhase_s = 0.04;

}  // namespace

MotionBase::MotionBase(MoveSet moves) {
  auto shared = std::make_shared<Shared>();
  shared->moves = std::move(moves);
  for (const MotionClip& clip : shared->moves.clips) {
    shared->phases.push_back(phases_of(clip, kMinPhase_s));
  }
  shared_ = std::move(shared);
}

std::shared_ptr<const MotionBase> MotionBase::with_own(std::size_t slot,
                                                       MotionClip clip) const {
  MAREY_ASSERT(slot <= own_.size());
  std::shared_ptr<MotionBase> out(new MotionBase(*this));
  auto own = std::make_shared<Own>();
  own->phases = phases_of(clip, kMinPhase_s);
  own->clip = std::move(clip);
  if (slot == out->own_.size()) out->own_.emplace_back();
  out->own_[slot] = std::move(own);
  return out;
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
      clips().begin(),
      clips().end(),
      name,
      [](const MotionClip& clip, std::string_view wanted) { return clip.name < wanted; });
  if (it == clips().end() || it->name != name) return std::nullopt;
  return static_cast<std::size_t>(it - clips().begin());
}

bool MotionBase::has_contacts(std::size_t clip) const {
  return std::any_of(this->clip(clip).contacts.begin(),
                     this->clip(clip).contacts.end(),
                     [](const std::vector<ClipSpan>& spans) { return !spans.empty(); });
}

}  // namespace marey::engine
