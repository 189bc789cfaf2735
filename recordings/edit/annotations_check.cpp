// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/annotations_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string_view>

#include "core/base/in_quotes.h"
#include "core/base/printable.h"

namespace marey::recordings {
namespace {

std::string element(const std::string& file, std::string_view list, std::size_t place) {
  return file + ": " + std::string(list) + "[" + std::to_string(place) + "]";
}

/// Returns true if the text is one line of UTF-8 and not empty.
bool is_plain_line(const std::string& text) {
  return !text.empty() && printable(text) == text;
}

Status check_note(const Annotation& note, const std::string& where) {
  if (!is_plain_line(note.text)) {
    return bad_input(where,
                     "its text " + in_quotes(note.text) + " is not one line of text",
                     "write one line, without control characters");
  }
  if (!std::isfinite(note.start_s) || !std::isfinite(note.end_s)) {
    return bad_input(where, "a time is not finite", "give start_s and end_s in seconds");
  }
  if (note.end_s < note.start_s) {
    return bad_input(where, "the note ends before it starts", "exchange its two times");
  }
  return Done{};
}

Status check_curve(const ValueCurve& curve, const std::string& where) {
  if (!is_plain_line(curve.name)) {
    return bad_input(where,
                     "its name " + in_quotes(curve.name) + " is not one line of text",
                     "write one line, without control characters");
  }
  const bool is_finite = std::all_of(curve.values.begin(),
                                     curve.values.end(),
                                     [](double value) { return std::isfinite(value); });
  if (is_finite) return Done{};
  return bad_input(where, "a value is not finite", "give one number for each frame");
}

}  // namespace

Status check_annotations(const Annotations& annotations, const std::string& file) {
  for (std::size_t k = 0; k < annotations.notes.size(); ++k) {
    const Status ok = check_note(annotations.notes[k], element(file, "notes", k));
    if (!ok) return ok;
  }
  std::set<std::string_view> names;
  for (std::size_t k = 0; k < annotations.curves.size(); ++k) {
    const ValueCurve& curve = annotations.curves[k];
    const std::string where = element(file, "curves", k);
    if (const Status ok = check_curve(curve, where); !ok) return ok;
    if (!names.insert(curve.name).second) {
      return bad_input(where,
                       "another curve has the name " + in_quotes(curve.name),
                       "give each a name of its own");
    }
    const std::size_t frames = annotations.curves.front().values.size();
    if (curve.values.size() != frames) {
      return bad_input(where,
                       "it has " + std::to_string(curve.values.size()) +
                           " values, and the first curve has " + std::to_string(frames),
                       "give one number for each frame");
    }
  }
  return Done{};
}

}  // namespace marey::recordings
