// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "edit/state/edit_state.h"

#include "core/edit/body_group.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Properties of the filter and of the noise in one group of joints.
struct FilteredGroup {
  EditGroup group = EditGroup::kRoot;
  std::optional<double> cutoff_hz;  ///< Half power; nullopt: constant, left as it is.
  /// Standard deviation of the noise, estimated from the change of the channels: the
  /// median over channels of its root mean square, divided by the root of the share of
  /// frequencies above the cut-off.
  double noise_rad = 0.0;
  double noise_m = 0.0;  ///< The same for the root's place; 0 for other groups.
};

/// Filters the rotations of a group's joints in their parents (rotation_channels.h), and
/// for the root also its place, with one filter for all of them (channel_filter.h).
/// A frame in which most joints of the group are inferred counts a tenth; without
/// uncertainty a frame that an operation invented does. Writes into
/// `out`. The root's place is filtered along axes of the pelvis at the first frame, so
/// that the result turns with the motion about the vertical. Linear in frames.
/// Precondition: `out` has the poses of the state; at least 20 frames; impacts ascend.
FilteredGroup filter_group(const FilterOp& op,
                           const EditState& state,
                           EditGroup group,
                           std::span<const int> impacts,
                           Motion& out);

}  // namespace marey::edit
