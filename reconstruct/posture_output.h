// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: from solved postures of markers to poses with doubts.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "core/motion.h"
#include "reconstruct/marker_model.h"

namespace marey::reconstruct {

/// A body's lengths and markers as the solver sees them; markers in the body's order.
[[nodiscard]] MarkerModel to_marker_model(const Body& body);

/// Which column of tracks each marker of a body is; nullopt where it is not among them.
using MarkerColumns = std::vector<std::optional<std::size_t>>;
[[nodiscard]] MarkerColumns find_columns(const Body& body,
                                         std::span<const std::string> labels);

/// The model's markers in one frame, into `out`. No allocation once it has held as many.
void collect(std::span<const std::optional<MarkerSample>> frame,
             const MarkerColumns& columns,
             std::vector<SeenMarker>& out);

/// What a frame's markers make of every bone: measured where one of its own was.
using BoneSources = std::array<Source, kHumanBoneCount>;
[[nodiscard]] BoneSources sources_of(const MarkerModel& model,
                                     std::span<const std::optional<MarkerSample>> frame,
                                     const MarkerColumns& columns);

/// The pose of make_humanoid() in this posture. Keeps the storage of `out`.
void to_pose(const UnfoldedPosture& unfolded, const Skeleton& skeleton, Pose& out);

/// Standard deviation of every bone's origin, per coordinate (point_sigma.h), the
/// body's own doubt added. [m]
void joint_sigmas(const UnfoldedPosture& unfolded,
                  const Body& body,
                  const PostureCovariance& covariance,
                  std::array<double, kHumanBoneCount>& out);

}  // namespace marey::reconstruct
