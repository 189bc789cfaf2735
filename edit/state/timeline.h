// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "edit/state/edit_state.h"

#include "core/edit/annotation.h"

namespace marey::edit {

/// Frames, rate and annotations of a recording: everything on which instants and spans of
/// operations depend. Borrows the annotations.
struct Timeline {
  int frame_count = 0;
  double rate_hz = 0.0;
  std::span<const Annotation> notes{};
  /// Events that are not annotations, ascending by time: contact_events().
  std::vector<Annotation> events{};

  /// Time of the last frame. [s]
  [[nodiscard]] double duration_s() const {
    return frame_count < 2 ? 0.0 : (frame_count - 1) / rate_hz;
  }
};

/// Returns the timeline of a motion, with the events of its contacts. Valid as long as
/// the state's annotations. Linear in contacts.
[[nodiscard]] Timeline timeline_of(const EditState& state);

}  // namespace marey::edit
