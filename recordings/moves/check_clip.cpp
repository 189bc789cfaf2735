// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/check_clip.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

#include "core/base/format_text.h"
#include "core/base/hex_digits.h"
#include "core/base/in_quotes.h"
#include "core/base/printable.h"
#include "core/engine/check_motion_clip.h"
#include "recordings/base/motion_limits.h"

namespace marey::recordings {
namespace {

using Problem = std::optional<std::string>;

constexpr std::size_t kMaxNameBytes = 1000;

bool is_line(std::string_view text) {
  return text.size() <= kMaxNameBytes && printable(text) == text;
}

Problem words_problem(const MotionClip& clip) {
  if (!is_line(clip.body)) return "the name of its body is not one line of text";
  const std::string* last_tag = nullptr;
  for (const std::string& tag : clip.tags) {
    if (tag.empty() || !is_line(tag)) {
      return "its tag " + in_quotes(tag) + " is not one line of text";
    }
    if (last_tag != nullptr && tag <= *last_tag) {
      return "its tags are not in order, or one occurs twice";
    }
    last_tag = &tag;
  }
  const Annotation* last = nullptr;
  for (const Annotation& note : clip.notes) {
    if (note.text.empty() || printable(note.text) != note.text) {
      return "its note " + in_quotes(note.text) + " is not one line of text";
    }
    const bool is_ok = std::isfinite(note.start_s) && std::isfinite(note.end_s) &&
                       note.end_s >= note.start_s;
    if (!is_ok) return "the times of its note " + in_quotes(note.text) + " are wrong";
    if (last != nullptr && note.start_s < last->start_s) {
      return "its notes are not in order";
    }
    last = &note;
  }
  return std::nullopt;
}

bool ascends_to_one(std::span<const float> knots) {
  float last = -1.0F;
  for (const float at : knots) {
    if (!(at > last || (at == 1.0F && last == 1.0F))) return false;
    last = at;
  }
  return knots.front() == 0.0F && knots.back() == 1.0F;
}

}  // namespace

std::optional<std::string> clip_problem(const MotionClip& clip) {
  constexpr std::size_t kSumDigits = 64;
  if (clip.name.empty() || !is_line(clip.name)) {
    return "its name is not one line of text";
  }
  const auto rate_hz = static_cast<double>(clip.rate_hz);
  if (!(rate_hz >= kMinRateHz && rate_hz <= kMaxRateHz)) {
    return "its rate is outside " + format_text("%g", kMinRateHz) + " to " +
           format_text("%g", kMaxRateHz) + " Hz";
  }
  if (!is_hex(clip.document_sha256, kSumDigits)) {
    return "the SHA-256 of its document is not 64 hexadecimal digits";
  }
  if (!clip.recipe_sha256.empty() && !is_hex(clip.recipe_sha256, kSumDigits)) {
    return "the SHA-256 of its recipe is not 64 hexadecimal digits";
  }
  if (Problem fault = motion_clip_fault(clip)) return fault;
  return words_problem(clip);
}

std::optional<std::string> layout_problem(const PostureLayout& layout) {
  if (ascends_to_one(layout.abdomen_at) && ascends_to_one(layout.torso_at) &&
      ascends_to_one(layout.neck_at)) {
    return std::nullopt;
  }
  return "the knots of the spine do not ascend from 0 to 1";
}

}  // namespace marey::recordings
