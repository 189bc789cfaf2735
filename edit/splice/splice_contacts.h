// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/human/contacts.h"

namespace marey::edit {

/// Frames of a joined motion, as its contacts need them.
struct JoinedFrames {
  int start = 0;   ///< Frame of the result that shows the second motion's first one.
  int join = 0;    ///< Last frame with the first motion's contacts.
  int length = 0;  ///< Frames of the overlap after its first one.
  double hz = 0.0;
  int lead = 0;  ///< Frames from `start` to the overlap's first one.

  [[nodiscard]] int overlap_first() const { return start + lead; }
  [[nodiscard]] int overlap_last() const { return start + lead + length; }
};

/// Returns the contacts of a joined motion: the first one's up to the join, then the
/// second one's. Within the overlap, contacts that the join cut to less than 0.06 s last
/// that long if they do in their motion, else they are dropped; gaps of less than 0.05 s
/// are closed. Heights are those of the first
/// motion, or of the second one for a foot that never stands in the first. Linear in
/// frames.
/// Precondition: `start` <= `join`; both motions show the frame `join`.
[[nodiscard]] Contacts join_contacts(const Contacts& first,
                                     const Contacts& second,
                                     const JoinedFrames& frames);

}  // namespace marey::edit
