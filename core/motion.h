// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/time.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/source.h"

namespace marey {

/// Poses of one skeleton at a constant rate. Frame i is at time (first_frame + i) / rate.
struct Motion {
  Skeleton skeleton;
  FrameRate rate;
  int first_frame = 0;
  std::vector<Pose> poses;
};

/// Uncertainty of one joint in one frame.
struct JointUncertainty {
  /// Standard deviation of the joint centre, per coordinate: 95 % of its errors are
  /// within 2.8 times that. [m]
  double sigma_m = 0.0;
  Source source = Source::kInferred;
  /// Source of the segment that begins at the joint, which does not depend on sigma_m.
  /// Set only where segments are solved from tags.
  Source segment_source = Source::kInferred;
};

/// A motion estimated from detections. uncertainty[frame][joint].
struct EstimatedMotion {
  Motion motion;
  std::vector<std::vector<JointUncertainty>> uncertainty;
};

}  // namespace marey
