// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "core/base/result.h"
#include "core/marker_map.h"
#include "reconstruct/labels/name_markers.h"

namespace marey::reconstruct {

/// Returns `names`, corrected by the user's map of these labels; a label of the map may
/// lack the subject before a colon and names.prefix. Labels that are not in the map are
/// unchanged. Labels that the recording lacks are listed in the notes, since a map can
/// serve many recordings.
/// Errors (kBadInput), with the line: a name that is neither a landmark's nor a bone's;
/// none of the map's labels is in the recording. Precondition: one landmark per label.
[[nodiscard]] Result<MarkerNames> apply_map(const MarkerMap& map,
                                            std::span<const std::string> labels,
                                            MarkerNames names);

}  // namespace marey::reconstruct
