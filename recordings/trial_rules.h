// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "recordings/session.h"

// Private to recordings.
namespace marey::recordings {

/// What is wrong with a trial beside those before it.
struct TrialMistake {
  std::string key;  ///< Of its table, to blame.
  std::string cause;
  std::string next;
};

/// Whether `trial` can follow the trials that `session` has: one trial of each kind but
/// motion; no two trials with exactly the same frames of a video (ranges may overlap),
/// and no video of one camera as another's; a floor cut out of the calibration's own
/// videos says which frames it is.
[[nodiscard]] std::optional<TrialMistake> mistake_of(const Trial& trial,
                                                     const Session& session);

}  // namespace marey::recordings
