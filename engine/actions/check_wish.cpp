// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/actions/check_wish.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/nearest_word.h"

namespace marey::engine {
namespace {

Error wish_error(const ActionWish& wish, std::string cause, std::string next) {
  return bad_input("action \"" + wish.clip + "\"", std::move(cause), std::move(next));
}

std::optional<Error> check_numbers(const ActionWish& wish,
                                   const std::array<bool, kGroupCount>& has_group) {
  bool moves = false;
  for (std::size_t g = 0; g < kGroupCount; ++g) {
    const float priority = wish.priority[g];
    const std::string group(name(kEditGroups[g]));
    if (!std::isfinite(priority) || priority < 0.0F) {
      return wish_error(wish,
                        "the priority of " + group + " is negative or not finite",
                        "give a priority of 0 or more");
    }
    moves = moves || (priority > 0.0F && has_group[g]);
  }
  if (!moves) {
    return wish_error(wish,
                      "it has no priority above 0 on a group that the body has",
                      "give at least one group of the body a priority");
  }
  const auto refuse_unless = [&](bool good, const char* what, const char* next) {
    return good ? std::optional<Error>() : wish_error(wish, what, next);
  };
  const auto is_duration = [](double s) {
    return std::isfinite(s) && s >= 0.0 && s <= 1e4;
  };
  if (auto error = refuse_unless(
          std::isfinite(wish.weight) && wish.weight > 0.0 && wish.weight <= 1e6,
          "the weight is not above 0, or not finite",
          "give a weight above 0")) {
    return error;
  }
  if (auto error =
          refuse_unless(is_duration(wish.fade_in_s) && is_duration(wish.fade_out_s),
                        "a fade is negative or not finite",
                        "give fades of 0 s or more")) {
    return error;
  }
  if (auto error = refuse_unless(is_duration(wish.entry_search_s),
                                 "the search of an entry is negative or not finite",
                                 "give 0 s or more")) {
    return error;
  }
  return refuse_unless(
      std::isfinite(wish.rate) && wish.rate >= kMinWarpRate && wish.rate <= kMaxWarpRate,
      "the rate is not in [0.25, 4]",
      "give a rate between 0.25 and 4");
}

// An action never ends if it loops and nothing stops or replaces it.
std::optional<Error> check_start(const ActionWish& wish,
                                 const MotionBase& base,
                                 std::span<const Action> others,
                                 Action& action) {
  action.start = wish.start.kind;
  action.start_s = wish.start.time_s;
  if (wish.start.kind == ActionStart::Kind::kNow) return std::nullopt;
  if (wish.start.kind == ActionStart::Kind::kAtTime) {
    if (std::isfinite(wish.start.time_s)) return std::nullopt;
    return wish_error(wish, "its start is not finite", "give a time");
  }
  action.after = wish.start.action;
  const auto other = std::find_if(others.begin(), others.end(), [&](const Action& a) {
    return a.id == wish.start.action && a.phase != ActionPhase::kDone;
  });
  const std::string id = std::to_string(number(wish.start.action));
  if (other == others.end()) {
    return wish_error(
        wish,
        "it would start after action " + id + ", which does not exist or is over",
        "start it now, or after an action that plays");
  }
  if (wish.start.kind == ActionStart::Kind::kAfter) {
    if (!other->loops || other->phase == ActionPhase::kFadingOut) return std::nullopt;
    return wish_error(wish,
                      "it would start after action " + id + ", which repeats without end",
                      "start it at an event of that action, or stop that action first");
  }
  const std::span<const Annotation> notes =
      other->is_live ? std::span<const Annotation>() : base.clip(other->clip).notes;
  for (const Annotation& note : notes) {
    if (note.text != wish.start.event) continue;
    action.start_s = note.start_s;
    return std::nullopt;
  }
  return wish_error(
      wish,
      "the clip of action " + id + " has no event \"" + wish.start.event + "\"",
      "see the events of the clip with marey base list");
}

Error unknown_clip(const ActionWish& wish, const MotionBase& base) {
  std::vector<std::string_view> names;
  for (const MotionClip& clip : base.clips()) names.push_back(clip.name);
  const auto nearest = meant_word(wish.clip, names);
  return wish_error(wish,
                    "the base has no clip of this name",
                    nearest ? "did you mean \"" + std::string(*nearest) + "\"?"
                            : "see the clips with marey base list");
}

}  // namespace

Result<Action> check_wish(const ActionWish& wish,
                          const MotionBase& base,
                          std::span<const Action> others,
                          const std::array<bool, kGroupCount>& has_group) {
  const auto clip = base.find(wish.clip);
  if (!clip) return unknown_clip(wish, base);
  if (const auto error = check_numbers(wish, has_group)) return *error;
  Action action;
  action.clip = *clip;
  action.priority = wish.priority;
  action.weight = static_cast<float>(wish.weight);
  const bool moves_legs = action.leg_priority() > 0.0F;
  action.layer = wish.layer.value_or(moves_legs ? 0 : 1);
  action.fade_in_s = wish.fade_in_s;
  action.fade_out_s = wish.fade_out_s;
  action.rate = wish.rate;
  action.replaces = wish.replaces;
  action.transition = wish.transition;
  action.loops = wish.loops.value_or(base.clip(*clip).loops);
  if (action.loops && !base.clip(*clip).loops) {
    return wish_error(wish,
                      "the clip is not a loop, so it cannot repeat",
                      "make a cycle of it with the operation cyclify of marey edit");
  }
  const double duration = base.clip(*clip).duration_s();
  action.entry_s = wish.entry_s;
  action.entry_search_s = wish.entry_search_s;
  if (wish.entry_s && !(*wish.entry_s >= 0.0 && *wish.entry_s <= duration)) {
    return wish_error(
        wish, "its entry is outside of the clip", "give a time within the clip");
  }
  if (const auto error = check_start(wish, base, others, action)) return *error;
  return action;
}

Result<Action> check_live_wish(const ActionWish& wish,
                               const MotionBase& base,
                               std::span<const Action> others,
                               const std::array<bool, kGroupCount>& has_group) {
  if (!wish.clip.empty()) {
    return wish_error(wish, "a live source plays no clip", "leave the clip empty");
  }
  ActionWish named = wish;
  named.clip = "live";
  if (const auto error = check_numbers(named, has_group)) return *error;
  Action action;
  action.is_live = true;
  action.loops = true;  // It has no end.
  action.priority = wish.priority;
  action.weight = static_cast<float>(wish.weight);
  action.layer = wish.layer.value_or(1);
  action.fade_in_s = wish.fade_in_s;
  action.fade_out_s = wish.fade_out_s;
  action.replaces = wish.replaces;
  action.transition = wish.transition;
  if (const auto error = check_start(named, base, others, action)) return *error;
  return action;
}

}  // namespace marey::engine
