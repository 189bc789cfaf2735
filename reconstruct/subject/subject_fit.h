// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/body.h"
#include "core/finding.h"

namespace marey::reconstruct {

/// Declared facts of a subject, before any measurement.
struct SubjectPrior {
  std::string name;
  double stature_m = 0.0;
  std::optional<double> mass_kg;
  std::vector<TagOnSegment> tags;
};

/// A hand or foot that is left out of the body: its tags fit in two ways, in no way, or
/// were not seen well enough to decide. Its joint comes from the other segments alone,
/// and is never reported as measured in a motion.
struct LeftOutSegment {
  HumanBone segment{};
  Finding reason;  ///< Poor: the cause and the movement to record.
};

struct SubjectFit {
  Body body;
  double rms_px = 0.0;  ///< Reprojection of all tag corners used, inliers and not.
  /// Ratio of measured limb lengths to an average person's of the declared stature.
  double limb_ratio = 0.0;
  /// Tags, except those of `left_out`, that were not seen well enough to be placed; the
  /// body does not contain them.
  std::vector<TagId> unplaced;
  /// In the order of human_limbs(). Each reason is also in `findings`; if `findings`
  /// has no others, the rest of the body is trusted.
  std::vector<LeftOutSegment> left_out;
  /// Reasons not to trust the fit (poor), each with the segment and the next step:
  /// sightings that no place of a tag explains, hands and feet that fit in two ways,
  /// lengths that no person has. Empty if all sightings are consistent. body.warnings has
  /// them as text.
  std::vector<Finding> findings;
};

}  // namespace marey::reconstruct
