// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey {

/// Part of a foot that bears: its ankle rests (heel), or its toe joint (ball).
enum class FootPart { kHeel, kBall };

/// A change of a foot's detected contacts by hand. Times are since the first frame of the
/// motion. [s]
struct ContactEdit {
  enum class Kind {
    kSet,    ///< The part bears from `from_s` to `to_s`.
    kClear,  ///< The part does not bear from `from_s` to `to_s`.
    /// The start or the end of a contact that is nearest to `from_s` moves to `to_s`. No
    /// effect if none is within kEdgeReach_s.
    kMoveStart,
    kMoveEnd,
  };
  Kind kind = Kind::kSet;
  int side = 0;  ///< 0 is left, 1 is right.
  FootPart part = FootPart::kHeel;
  double from_s = 0.0;
  double to_s = 0.0;
  bool operator==(const ContactEdit&) const = default;
};

/// Maximum distance between ContactEdit::from_s and the edge of a contact that it moves.
inline constexpr double kEdgeReach_s = 0.1;

}  // namespace marey
