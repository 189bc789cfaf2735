// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/resolve_moment.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"

namespace marey::edit {
namespace {


constexpr double kBeyondFrames = 0.5;

bool comes_before(const Annotation& a, const Annotation& b) {
  return std::pair(a.start_s, a.text) < std::pair(b.start_s, b.text);
}

Error no_such_annotation(const Timeline& timeline, const AtAnnotation& wanted) {
  std::vector<std::string_view> texts;
  for (const Annotation& note : timeline.notes) texts.push_back(note.text);
  for (const Annotation& event : timeline.events) texts.push_back(event.text);
  std::sort(texts.begin(), texts.end());
  texts.erase(std::unique(texts.begin(), texts.end()), texts.end());
  std::string next = "state a time or a frame: the motion has no annotations";
  if (!texts.empty()) next = suggestion(wanted.text, texts);
  return bad_input(
      "motion", "has no annotation " + in_quotes(wanted.text) + " here", std::move(next));
}

Result<double> frame_of_annotation(const Timeline& timeline,
                                   const AtAnnotation& wanted,
                                   AnnotationEnd end) {
  const auto frame_of = [&](const Annotation& note) {
    return (end == AnnotationEnd::kStart ? note.start_s : note.end_s) * timeline.rate_hz;
  };
  int count = 0;
  for (const auto notes :
       {timeline.notes, std::span<const Annotation>(timeline.events)}) {
    for (const Annotation& note : notes) {
      if (note.text != wanted.text) continue;
      if (count++ == wanted.occurrence) return frame_of(note);
    }
    if (count > 0) break;
  }
  if (count == 0) return no_such_annotation(timeline, wanted);
  return bad_input("motion",
                   "has " + std::to_string(count) + " annotations " +
                       in_quotes(wanted.text) + ", numbered from 0; number " +
                       std::to_string(wanted.occurrence) + " is not one of them",
                   "choose a number from 0 to " + std::to_string(count - 1));
}

Result<double> checked(const Timeline& timeline, double frame, std::string_view what) {
  const double last = timeline.frame_count - 1;
  if (frame >= -kBeyondFrames && frame <= last + kBeyondFrames) {
    return std::clamp(frame, 0.0, last);
  }
  return bad_input("motion",
                   std::string(what) + " lies outside: it lasts " +
                       format_text("%.3f", timeline.duration_s()) + " s, frames 0 to " +
                       std::to_string(timeline.frame_count - 1),
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

Timeline timeline_of(const EditState& state) {
  return {state.frame_count(),
          state.motion.rate.hz,
          state.annotations.notes,
          contact_events(state)};
}

Result<double> resolve_moment(const Timeline& timeline,
                              const Moment& moment,
                              AnnotationEnd end) {
  if (const auto* at = std::get_if<AtTime>(&moment)) {
    return checked(timeline,
                   at->time_s * timeline.rate_hz,
                   "time " + format_text("%.3f", at->time_s) + " s");
  }
  if (const auto* at = std::get_if<AtFrame>(&moment)) {
    return checked(timeline, at->frame, "frame " + format_text("%g", at->frame));
  }
  const auto& at = std::get<AtAnnotation>(moment);
  const auto frame = frame_of_annotation(timeline, at, end);
  if (!frame) return frame.error();
  return checked(timeline, *frame, "annotation " + in_quotes(at.text));
}

Result<double> resolve_moment(const EditState& state,
                              const Moment& moment,
                              AnnotationEnd end) {
  if (std::holds_alternative<AtAnnotation>(moment)) {
    return resolve_moment(timeline_of(state), moment, end);
  }
  return resolve_moment(Timeline{state.frame_count(), state.motion.rate.hz}, moment, end);
}

Result<ResolvedSpan> resolve_span(const Timeline& timeline, const EditSpan& span) {
  ResolvedSpan out{0.0, static_cast<double>(timeline.frame_count - 1)};
  if (span.from) {
    const auto first = resolve_moment(timeline, *span.from, AnnotationEnd::kStart);
    if (!first) return first.error();
    out.first = *first;
  }
  if (span.to) {
    const auto last = resolve_moment(timeline, *span.to, AnnotationEnd::kEnd);
    if (!last) return last.error();
    out.last = *last;
  }
  if (out.first <= out.last) return out;
  return bad_input("span",
                   "ends at frame " + format_text("%.1f", out.last) +
                       ", before it starts at frame " + format_text("%.1f", out.first),
                   "exchange the two, or leave one out");
}

Result<ResolvedSpan> resolve_span(const EditState& state, const EditSpan& span) {
  return resolve_span(timeline_of(state), span);
}

}  // namespace marey::edit
