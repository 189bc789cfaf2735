// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

namespace marey {

/// Time since the first frame of the motion. [s]
struct AtTime {
  double time_s = 0.0;
  bool operator==(const AtTime&) const = default;
};
/// Number of frames since the first frame of the motion; may have a fraction.
struct AtFrame {
  double frame = 0.0;
  bool operator==(const AtFrame&) const = default;
};
/// An annotation, or a contact event: "left.strike[2]" is the third strike of the left
/// foot.
struct AtAnnotation {
  std::string text;
  int occurrence = 0;  ///< Counted by time, from 0.
  bool operator==(const AtAnnotation&) const = default;
};

/// An instant of the motion that an edit operation receives.
using Moment = std::variant<AtTime, AtFrame, AtAnnotation>;

/// A part of a motion, both ends included. An annotation as `from` means its start, as
/// `to` its end.
struct EditSpan {
  std::optional<Moment> from;  ///< nullopt: from the first frame.
  std::optional<Moment> to;    ///< nullopt: to the last frame.
  bool operator==(const EditSpan&) const = default;
  [[nodiscard]] bool is_whole() const { return !from && !to; }
};

}  // namespace marey
