// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: one limb of a subject's bundle as a separate bundle, so that a
// hypothesis about it costs a fraction of the whole.

#include <cstddef>
#include <vector>

#include "reconstruct/bundle/subject_bundle.h"

namespace marey::reconstruct {

/// The limb's part of a bundle: frames that show it, with its sightings alone.
struct LimbBundle {
  SubjectBundle bundle;
  std::vector<std::vector<TagSighting>> sightings;
  std::vector<std::size_t> frames;  ///< Indices in the whole bundle.
};

/// Copies the part of `whole` that belongs to `limb`. The copy's frames borrow its own
/// sightings.
void cut_out(std::size_t limb, const SubjectBundle& whole, LimbBundle& out);

/// Writes the limb's lengths, tags and postures back.
void take_back(std::size_t limb, const LimbBundle& from, SubjectBundle& whole);

}  // namespace marey::reconstruct
