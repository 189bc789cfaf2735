// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/phases.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace marey::engine {
namespace {

bool bears(const std::vector<ClipSpan>& spans, double time_s) {
  return std::any_of(spans.begin(), spans.end(), [&](const ClipSpan& span) {
    return static_cast<double>(span.start_s) <= time_s &&
           time_s < static_cast<double>(span.end_s);
  });
}

PhaseClass class_at(const MotionClip& clip, double time_s) {
  const auto part = [&](ClipFootPart which) {
    return bears(clip.contacts[static_cast<std::size_t>(which)], time_s);
  };
  const bool left = part(ClipFootPart::kLeftHeel) || part(ClipFootPart::kLeftBall);
  const bool right = part(ClipFootPart::kRightHeel) || part(ClipFootPart::kRightBall);
  if (left) return right ? PhaseClass::kBoth : PhaseClass::kLeft;
  return right ? PhaseClass::kRight : PhaseClass::kNone;
}

/// Starts and ends of all contacts within the clip, with its own start and end.
std::vector<double> contact_times(const MotionClip& clip) {
  const double duration_s = clip.duration_s();
  std::vector<double> times_s{0.0, duration_s};
  for (const std::vector<ClipSpan>& spans : clip.contacts) {
    for (const ClipSpan& span : spans) {
      for (const float time_s : {span.start_s, span.end_s}) {
        times_s.push_back(std::clamp(static_cast<double>(time_s), 0.0, duration_s));
      }
    }
  }
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  return times_s;
}

void append(std::vector<Phase>& phases, const Phase& phase) {
  if (!phases.empty() && phases.back().feet == phase.feet) {
    phases.back().end_s = phase.end_s;
  } else {
    phases.push_back(phase);
  }
}

double length_s(const Phase& phase) {
  return phase.end_s - phase.start_s;
}

/// Joins the shortest inner phase below `min_phase_s` to its longer neighbour. Returns
/// false when there is none.
bool join_shortest(std::vector<Phase>& phases, double min_phase_s) {
  std::size_t shortest = 0;
  for (std::size_t i = 1; i + 1 < phases.size(); ++i) {
    if (length_s(phases[i]) >= min_phase_s) continue;
    if (shortest == 0 || length_s(phases[i]) < length_s(phases[shortest])) shortest = i;
  }
  if (shortest == 0) return false;
  const bool to_earlier =
      length_s(phases[shortest - 1]) >= length_s(phases[shortest + 1]);
  phases[shortest].feet = phases[to_earlier ? shortest - 1 : shortest + 1].feet;
  std::vector<Phase> joined;
  for (const Phase& phase : phases) append(joined, phase);
  phases = std::move(joined);
  return true;
}

}  // namespace

std::vector<Phase> phases_of(const MotionClip& clip, double min_phase_s) {
  const double duration_s = clip.duration_s();
  const bool without_contacts =
      std::all_of(clip.contacts.begin(), clip.contacts.end(), [](const auto& spans) {
        return spans.empty();
      });
  if (without_contacts || duration_s <= 0.0) return {{PhaseClass::kAny, 0.0, duration_s}};
  const std::vector<double> times_s = contact_times(clip);
  std::vector<Phase> phases;
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    const double middle_s = 0.5 * (times_s[i - 1] + times_s[i]);
    append(phases, {class_at(clip, middle_s), times_s[i - 1], times_s[i]});
  }
  while (join_shortest(phases, min_phase_s)) {
  }
  return phases;
}

bool are_compatible(PhaseClass a, PhaseClass b, double from_edge_s) {
  if (a == b || a == PhaseClass::kAny || b == PhaseClass::kAny) return true;
  if (a == PhaseClass::kNone || b == PhaseClass::kNone) {
    return from_edge_s <= kFlightEdge_s;
  }
  return a == PhaseClass::kBoth || b == PhaseClass::kBoth;
}

}  // namespace marey::engine
