// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/resolve_moment.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"

namespace marey::edit {
namespace {

using retarget::FootContacts;

constexpr double kBeyondFrames = 0.5;

bool comes_before(const Annotation& a, const Annotation& b) {
  return std::pair(a.start_s, a.text) < std::pair(b.start_s, b.text);
}

Error no_such_annotation(const EditState& state,
                         const AtAnnotation& wanted,
                         const std::vector<Annotation>& events) {
  std::vector<std::string_view> texts;
  for (const Annotation& note : state.annotations.notes) texts.push_back(note.text);
  for (const Annotation& event : events) texts.push_back(event.text);
  std::sort(texts.begin(), texts.end());
  texts.erase(std::unique(texts.begin(), texts.end()), texts.end());
  std::string next = "state a time or a frame: the motion has no annotations";
  if (!texts.empty()) next = suggestion(wanted.text, texts);
  return bad_input(
      "motion", "has no annotation " + in_quotes(wanted.text) + " here", std::move(next));
}

Result<double> frame_of_annotation(const EditState& state,
                                   const AtAnnotation& wanted,
                                   AnnotationEnd end) {
  const auto frame_of = [&](const Annotation& note) {
    return (end == AnnotationEnd::kStart ? note.start_s : note.end_s) *
           state.motion.rate.hz;
  };
  const std::vector<Annotation> events = contact_events(state);
  int count = 0;
  for (const auto* notes : {&state.annotations.notes, &events}) {
    for (const Annotation& note : *notes) {
      if (note.text != wanted.text) continue;
      if (count++ == wanted.occurrence) return frame_of(note);
    }
    if (count > 0) break;
  }
  if (count == 0) return no_such_annotation(state, wanted, events);
  return bad_input("motion",
                   "has " + std::to_string(count) + " annotations " +
                       in_quotes(wanted.text) + ", numbered from 0; number " +
                       std::to_string(wanted.occurrence) + " is not one of them",
                   "choose a number from 0 to " + std::to_string(count - 1));
}

Result<double> checked(const EditState& state, double frame, std::string_view what) {
  const double last = state.frame_count() - 1;
  if (frame >= -kBeyondFrames && frame <= last + kBeyondFrames) {
    return std::clamp(frame, 0.0, last);
  }
  return bad_input("motion",
                   std::string(what) + " lies outside: it lasts " +
                       format_text("%.3f", state.duration_s()) + " s, frames 0 to " +
                       std::to_string(state.frame_count() - 1),
                   "choose an instant within; times are of the motion as this operation "
                   "receives it");
}

}  // namespace

std::vector<Annotation> contact_events(const EditState& state) {
  constexpr std::array<std::string_view, 2> kSides{"left", "right"};
  const int last = state.frame_count() - 1;
  const double hz = state.motion.rate.hz;
  std::vector<Annotation> out;
  for (std::size_t side = 0; side < 2; ++side) {
    for (const FrameRange& stance : state.contacts.feet[side].stance) {
      const auto add = [&](int frame, const char* event) {
        out.push_back({std::string(kSides[side]) + event, frame / hz, frame / hz});
      };
      if (stance.first > 0) add(stance.first, ".strike");
      if (stance.last < last) add(stance.last, ".toe_off");
    }
  }
  std::sort(out.begin(), out.end(), comes_before);
  return out;
}

Result<double> resolve_moment(const EditState& state,
                              const Moment& moment,
                              AnnotationEnd end) {
  if (const auto* at = std::get_if<AtTime>(&moment)) {
    return checked(state,
                   at->time_s * state.motion.rate.hz,
                   "time " + format_text("%.3f", at->time_s) + " s");
  }
  if (const auto* at = std::get_if<AtFrame>(&moment)) {
    return checked(state, at->frame, "frame " + format_text("%g", at->frame));
  }
  const auto& at = std::get<AtAnnotation>(moment);
  const auto frame = frame_of_annotation(state, at, end);
  if (!frame) return frame.error();
  return checked(state, *frame, "annotation " + in_quotes(at.text));
}

Result<ResolvedSpan> resolve_span(const EditState& state, const EditSpan& span) {
  ResolvedSpan out{0.0, static_cast<double>(state.frame_count() - 1)};
  if (span.from) {
    const auto first = resolve_moment(state, *span.from, AnnotationEnd::kStart);
    if (!first) return first.error();
    out.first = *first;
  }
  if (span.to) {
    const auto last = resolve_moment(state, *span.to, AnnotationEnd::kEnd);
    if (!last) return last.error();
    out.last = *last;
  }
  if (out.first <= out.last) return out;
  return bad_input("span",
                   "ends at frame " + format_text("%.1f", out.last) +
                       ", before it starts at frame " + format_text("%.1f", out.first),
                   "exchange the two, or leave one out");
}

}  // namespace marey::edit
