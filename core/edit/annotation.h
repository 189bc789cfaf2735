// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace marey {

/// A text at an instant (an event: both times are equal) or over a part of a motion.
/// Times are since the first frame of the motion. [s]
struct Annotation {
  std::string text;
  double start_s = 0.0;
  double end_s = 0.0;
  bool operator==(const Annotation&) const = default;
  [[nodiscard]] bool is_event() const { return start_s == end_s; }
};

/// A number for each frame of a motion, such as the weight of a blend.
struct ValueCurve {
  std::string name;
  std::vector<double> values;  ///< One per frame.
  bool operator==(const ValueCurve&) const = default;
};

/// The annotations of a motion.
struct Annotations {
  std::vector<Annotation> notes;   ///< Ascending by start, then by text.
  std::vector<ValueCurve> curves;  ///< Names all different.
  bool operator==(const Annotations&) const = default;
};

}  // namespace marey
