// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/marker_edit_events.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace marey::app {
namespace {

using recordings::MarkerEvent;

/// Returns an event without its time.
MarkerEvent event_of_text(const std::string& text,
                          const std::vector<MarkerEditEvent>& known) {
  for (const MarkerEditEvent& one : known) {
    if (one.text == text) return one.event;
  }
  const auto standard =
      [&](std::string_view wanted, const char* label, const char* side) {
        return text == wanted ? MarkerEvent{label, side, "", 0.0} : MarkerEvent{};
      };
  for (const MarkerEvent& event : {standard("left.strike", "Foot Strike", "Left"),
                                   standard("left.toe_off", "Foot Off", "Left"),
                                   standard("right.strike", "Foot Strike", "Right"),
                                   standard("right.toe_off", "Foot Off", "Right")}) {
    if (!event.label.empty()) return event;
  }
  return {text, "", "", 0.0};
}

}  // namespace

std::vector<MarkerEvent> marker_events_of(const edit::MarkerState& state,
                                          const std::vector<MarkerEditEvent>& known) {
  // Times of a source's events are 32-bit reals of up to some hours, and may lie half a
  // frame outside.
  const double same_s = 0.5 / state.tracks.rate.hz + 1e-9;
  const double end_s = state.duration_s();
  std::vector<Annotation> waiting;
  for (const Annotation& note : state.annotations.notes) {
    if (note.is_event()) waiting.push_back(note);
  }
  std::vector<MarkerEvent> out;
  for (const MarkerEditEvent& one : known) {
    const double time_s = one.event.time_s - state.tracks.start_s;
    if (time_s < -same_s || time_s > end_s + same_s) continue;
    const double within_s = std::clamp(time_s, 0.0, end_s);
    const auto same =
        std::find_if(waiting.begin(), waiting.end(), [&](const Annotation& note) {
          constexpr double kRounding_s = 1e-7;
          return note.text == one.text && std::abs(note.start_s - within_s) < kRounding_s;
        });
    if (same == waiting.end()) continue;
    waiting.erase(same);
    out.push_back(one.event);
  }
  for (const Annotation& note : waiting) {
    MarkerEvent event = event_of_text(note.text, known);
    event.time_s = state.tracks.start_s + note.start_s;
    out.push_back(std::move(event));
  }
  return out;
}

}  // namespace marey::app
