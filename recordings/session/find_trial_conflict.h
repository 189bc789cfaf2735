// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "recordings/session/session.h"

// Private to recordings.
namespace marey::recordings {

/// A conflict of a trial with the trials before it.
struct TrialConflict {
  std::string key;  ///< Key of the trial's table that causes the conflict.
  std::string cause;
  std::string next;
};

/// Checks that `trial` can follow the trials of `session`: one trial of each kind except
/// motion; no two trials with exactly the same frames of a video (ranges may overlap); no
/// video of one camera used for another; a floor trial cut out of the calibration's own
/// videos gives its frame range.
[[nodiscard]] std::optional<TrialConflict> find_trial_conflict(const Trial& trial,
                                                               const Session& session);

}  // namespace marey::recordings
