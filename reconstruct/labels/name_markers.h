// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "reconstruct/labels/landmarks.h"

namespace marey::reconstruct {

/// Meaning of the labels of a recording.
struct MarkerNames {
  /// The set that they come from: "Plug-in Gait", "CMU". Empty if no set covers at least
  /// eight of them and seven tenths of those with a known meaning.
  std::string set;
  /// Common prefix of every label that was named: "Bob:"; empty if there is none.
  std::string prefix;
  /// Per label; nullptr if its meaning is unknown, or not a place on the body.
  std::vector<const Landmark*> landmarks;
  /// Per label: a set defines it as a computed point or a device, not a marker on the
  /// body.
  std::vector<bool> is_computed;
  /// Per label: the user excludes it. Empty if the user excludes none.
  std::vector<bool> is_ignored;
  /// Notes for the user. Sentences without a full stop.
  std::vector<std::string> notes;
};

/// Finds the meaning of labels from the sets of label_sets.h and from words for segments
/// ("RTH2", "L_Shank_3"). Case and punctuation are ignored. The side may be L, R, Left or
/// Right, in front or behind. A prefix common to all labels, and a subject's name before
/// a colon, are removed if more labels are known without them. If there are several
/// subjects, the one with most names is named, the first of equals. A label with
/// different meanings in several sets has that of the set that covers the labels best;
/// other labels take theirs from the other sets.
/// Not named: computed points (joint centres, axes, centres of mass), angles and forces,
/// wands, the second of two equal labels ("LASI_2" if there is "LASI"), numbers. Linear
/// in labels, some milliseconds at the first call. Labels should differ.
[[nodiscard]] MarkerNames name_markers(std::span<const std::string> labels);

}  // namespace marey::reconstruct
