// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sources/stride_phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "engine/clips/sample_clip.h"

namespace marey::engine {
namespace {

constexpr double kBefore_s = 1e-4;
constexpr double kLeastStep_s = 0.12;
constexpr double kMostStep_s = 2.0;

struct Landing {
  double time_s = 0.0;
  int foot = 0;
};

// Calls for each landing of a clip that loops, in any order.
template <class Use>
void for_landings(const MotionClip& clip, const Use& use) {
  if (!clip.loops) return;
  const double duration = clip.duration_s();
  for (std::size_t part = 0; part < 4; ++part) {
    const int foot = static_cast<int>(part / 2);
    for (const ClipSpan& span : clip.contacts[part]) {
      const double start = static_cast<double>(span.start_s);
      double before = start - kBefore_s;
      if (before < 0.0) before += duration;
      if ((bearing_at(clip, before) >> (2 * foot) & 3U) != 0U) continue;
      // Both parts may land together: the first of them counts.
      const std::size_t other = part ^ 1U;
      bool is_double = false;
      for (const ClipSpan& too : clip.contacts[other]) {
        is_double = is_double || (too.start_s == span.start_s && other < part);
      }
      if (!is_double) use(Landing{start, foot});
    }
  }
}

struct Between {
  Landing last, next;
};

// The landings before and after a time of the clip, made unique by its cycles.
std::optional<Between> landings_around(const MotionClip& clip, double time_s) {
  const double duration = clip.duration_s();
  std::optional<Landing> last;
  std::optional<Landing> next;
  for_landings(clip, [&](const Landing& landing) {
    const double since = time_s - landing.time_s;
    const double start = landing.time_s + std::floor(since / duration) * duration;
    if (!last || start > last->time_s) last = Landing{start, landing.foot};
    if (!next || start + duration < next->time_s) {
      next = Landing{start + duration, landing.foot};
    }
  });
  if (!last || !next || last->foot == next->foot) return std::nullopt;
  return Between{*last, *next};
}

}  // namespace

std::optional<double> stride_phase(const MotionClip& clip, double time_s) {
  const auto around = landings_around(clip, time_s);
  if (!around) return std::nullopt;
  const double share =
      (time_s - around->last.time_s) / (around->next.time_s - around->last.time_s);
  return std::clamp(0.5 * around->last.foot + 0.5 * share, 0.0, 1.0 - 1e-12);
}

std::optional<double> time_of_stride(const MotionClip& clip, double phase) {
  const double wrapped = phase - std::floor(phase);
  const int foot = wrapped < 0.5 ? 0 : 1;
  const double share = 2.0 * (wrapped - 0.5 * foot);
  const double duration = clip.duration_s();
  std::optional<double> soonest;
  for_landings(clip, [&](const Landing& landing) {
    if (landing.foot != foot) return;
    const auto around = landings_around(clip, landing.time_s + kBefore_s);
    if (!around || around->last.foot != foot) return;
    double at = landing.time_s + share * (around->next.time_s - around->last.time_s);
    at -= std::floor(at / duration) * duration;
    if (!soonest || at < *soonest) soonest = at;
  });
  return soonest;
}

int count_strides(const MotionClip& clip) {
  int count = 0;
  for_landings(clip, [&](const Landing& landing) { count += landing.foot == 0 ? 1 : 0; });
  return count;
}

void LeadPhase::observe(double time_s, unsigned bears) {
  const unsigned before = bears_;
  bears_ = bears;
  if (!is_known_) {
    is_known_ = true;
    return;
  }
  for (int foot = 0; foot < 2; ++foot) {
    const bool bore = (before >> (2 * foot) & 3U) != 0U;
    const bool now = (bears >> (2 * foot) & 3U) != 0U;
    if (bore || !now) continue;
    const double since_s = time_s - last_s_;
    if (last_foot_ == foot) {
      // The same landing, seen twice.
      if (since_s < kLeastStep_s) continue;
      step_s_[0].reset();
      step_s_[1].reset();
    } else if (last_foot_ >= 0 && since_s < kMostStep_s) {
      step_s_[last_foot_] = std::max(since_s, kLeastStep_s);
    }
    last_foot_ = foot;
    last_s_ = time_s;
  }
}

std::optional<double> LeadPhase::phase(double time_s) const {
  if (last_foot_ < 0 || !step_s_[last_foot_]) return std::nullopt;
  const double share = (time_s - last_s_) / *step_s_[last_foot_];
  if (share > 1.5) return std::nullopt;
  // The phase waits for a landing that is late.
  return 0.5 * last_foot_ + 0.5 * std::min(share, 1.0 - 1e-9);
}

}  // namespace marey::engine
