// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "core/base/result.h"
#include "core/body.h"
#include "core/motion.h"
#include "reconstruct/tags/solve_motion.h"

namespace marey::app {

/// The files of one solved motion: joints.csv, segments.csv, motion.bvh, motion.npz with
/// its doubt and foot contacts, and motion.glb with a mannequin of the subject's
/// proportions. Each appears whole or not at all.
/// `start_s` as write_joints_csv() has it. Errors: the disk.
[[nodiscard]] Status write_motion(const std::filesystem::path& folder,
                                  const EstimatedMotion& estimate,
                                  const Proportions& proportions,
                                  std::optional<double> start_s = {});

/// The corners of a body's tags over a trial, where the motion carries them: markers.c3d
/// (millimetres, Z up) and markers.trc (millimetres, Y up), as most programs that read
/// such files expect them. Errors: the disk; more markers or frames than a C3D has room
/// for.
[[nodiscard]] Status write_tag_markers(const std::filesystem::path& folder,
                                       const Body& body,
                                       const reconstruct::SolvedTrial& solved);

}  // namespace marey::app
