// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/marker_map.h"
#include "core/result.h"
#include "reconstruct/landmarks.h"

namespace marey::reconstruct {

/// What the labels of a recording mean.
struct MarkerNames {
  /// The set that they come from: "Plug-in Gait", "CMU". Empty when none knows at least
  /// eight of them and seven tenths of those that are understood.
  std::string set;
  /// What stands before every label that was named: "Bob:"; empty when nothing does.
  std::string prefix;
  /// Per label; nullptr where it means nothing that is known, or no place on the body.
  std::vector<const Landmark*> landmarks;
  /// Per label: a set knows it for a computed point or a device, no marker on the body.
  std::vector<bool> is_computed;
  /// Per label: somebody said that it is not to be used. Empty when nobody said anything.
  std::vector<bool> is_ignored;
  /// What the user may want to know. Sentences without a full stop.
  std::vector<std::string> notes;
};

/// Finds what labels mean, by the sets of label_sets.h and by words for segments ("RTH2",
/// "L_Shank_3"). Case and punctuation do not matter, nor whether the side is written L,
/// R, Left or Right, nor in front or behind. What every label begins with, and a
/// subject's name before a colon, are left out where more is understood without; of
/// several subjects the one with most names is named, the first of equals. What one label
/// means in several sets is decided by the set that covers the labels best; the rest is
/// taken from the others.
///
/// Not named: computed points (joint centres, axes, centres of mass), angles and forces,
/// wands, the second of two equal labels ("LASI_2" where there is "LASI"), numbers.
/// Linear in labels, some milliseconds at the first call. Labels should differ.
[[nodiscard]] MarkerNames name_markers(std::span<const std::string> labels);

/// `names`, corrected by what the user says of these labels; a label of the map may lack
/// the subject before a colon and names.prefix. What the map does not mention stays.
/// Labels that the recording lacks are told in the notes: a map may serve many
/// recordings.
///
/// Errors (kBadInput), with the line: a name that is neither a landmark's nor a bone's;
/// none of the map's labels is in the recording. Precondition: one landmark per label.
[[nodiscard]] Result<MarkerNames> apply_map(const MarkerMap& map,
                                            std::span<const std::string> labels,
                                            MarkerNames names);

}  // namespace marey::reconstruct
