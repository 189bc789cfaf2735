// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/check_clip.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <tuple>

#include "core/base/format_text.h"
#include "core/base/hex_digits.h"
#include "core/base/in_quotes.h"
#include "core/base/printable.h"
#include "recordings/base/motion_limits.h"

namespace marey::recordings {
namespace {

using Problem = std::optional<std::string>;

constexpr std::size_t kMaxNameBytes = 1000;

/// Maximum magnitude of the numbers of a posture: a mistake in any unit.
constexpr float kMaxValue = 1e6F;

bool is_line(std::string_view text) {
  return text.size() <= kMaxNameBytes && printable(text) == text;
}

/// False for a number that is not finite, too.
bool is_plausible(float value) {
  return std::abs(value) <= kMaxValue;
}

bool are_plausible(std::span<const float> values) {
  for (const float value : values) {
    if (!is_plausible(value)) return false;
  }
  return true;
}

bool is_rotation(const BlendPosture& frame, std::size_t r) {
  constexpr double kMaxError = 1e-3;
  double squares = 0.0;
  for (const float part : {frame.x[r], frame.y[r], frame.z[r], frame.w[r]}) {
    squares += static_cast<double>(part) * part;
  }
  return std::abs(std::sqrt(squares) - 1.0) <= kMaxError;
}

Problem frame_problem(const BlendPosture& frame) {
  for (std::size_t r = 0; r < kUsedRotations; ++r) {
    if (!is_rotation(frame, r)) {
      return "rotation " + std::to_string(r) + " is not of unit length";
    }
  }
  const std::array others{frame.height_legs, frame.abdomen_share, frame.torso_share};
  const bool is_ok = are_plausible(frame.fold_rad) && are_plausible(frame.mid_x) &&
                     are_plausible(frame.mid_y) && are_plausible(frame.upper_twist_rad) &&
                     are_plausible(frame.lower_twist_rad) && are_plausible(others);
  if (is_ok) return std::nullopt;
  return "a number is not finite or out of range";
}

Problem frames_problem(const MotionClip& clip) {
  if (clip.frames.size() < 2) return "it has fewer than two frames";
  if (clip.path.size() != clip.frames.size()) {
    return "it has " + std::to_string(clip.frames.size()) + " frames and " +
           std::to_string(clip.path.size()) + " places on the floor";
  }
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    Problem problem = frame_problem(clip.frames[i]);
    const ClipRoot& root = clip.path[i];
    if (!is_plausible(root.x_legs) || !is_plausible(root.z_legs) ||
        !is_plausible(root.heading_rad)) {
      problem = "its place on the floor is not finite or out of range";
    }
    if (problem) return "frame " + std::to_string(i) + ": " + *problem;
  }
  return std::nullopt;
}

Problem contacts_problem(const MotionClip& clip) {
  // Spans reach to the middle between two frames, at the ends, too.
  const double margin_s = 0.5 / static_cast<double>(clip.rate_hz) + 1e-3;
  const double last_s = clip.duration_s() + margin_s;
  for (const std::vector<ClipSpan>& part : clip.contacts) {
    double end_s = -margin_s;
    for (const ClipSpan& span : part) {
      const bool ascends = static_cast<double>(span.start_s) >= end_s &&
                           span.end_s > span.start_s &&
                           static_cast<double>(span.end_s) <= last_s;
      if (!ascends) return "its contacts do not ascend or are outside of the clip";
      end_s = span.end_s;
    }
  }
  return std::nullopt;
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
  constexpr float kMaxLeg_m = 100.0F;
  if (!(clip.leg_length_m > 0.0F && clip.leg_length_m <= kMaxLeg_m)) {
    return "the length of its body's legs is outside 0 to 100 m";
  }
  if (!is_hex(clip.document_sha256, kSumDigits)) {
    return "the SHA-256 of its document is not 64 hexadecimal digits";
  }
  if (!clip.recipe_sha256.empty() && !is_hex(clip.recipe_sha256, kSumDigits)) {
    return "the SHA-256 of its recipe is not 64 hexadecimal digits";
  }
  if (Problem problem = frames_problem(clip)) return problem;
  if (Problem problem = contacts_problem(clip)) return problem;
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
