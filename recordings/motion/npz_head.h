// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/motion.h"
#include "recordings/motion/npz_arrays.h"

// Private to recordings/: arrays that all layouts of motions in .npz have.
namespace marey::recordings {

/// Sets rate [Hz] and first frame from "rate_hz" and "first_frame". Errors (kBadInput):
/// those of NpzInput; a rate outside kMinRateHz to kMaxRateHz; a first frame beyond 1e9.
[[nodiscard]] Status read_npz_rate(NpzInput& in, Motion& motion);

/// Sets names, bones and parents of all joints from "joint_names", "human_bones" and
/// "parents". Errors (kBadInput): those of NpzInput; no joint, or more than kMaxJoints; a
/// parent that does not come first; joints nested deeper than kMaxSkeletonDepth.
[[nodiscard]] Status read_npz_joints(NpzInput& in, Skeleton& skeleton);

}  // namespace marey::recordings
