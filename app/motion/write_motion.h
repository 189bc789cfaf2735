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

/// Writes the files of a solved motion: joints.csv, segments.csv, motion.bvh, motion.npz
/// with its sigmas and foot contacts, and motion.glb with a mannequin of the subject's
/// proportions. Each file appears whole or not at all. `start_s` is write_joints_csv()'s.
/// Errors: the disk.
[[nodiscard]] Status write_motion(const std::filesystem::path& folder,
                                  const EstimatedMotion& estimate,
                                  const Proportions& proportions,
                                  std::optional<double> start_s = {});

/// Writes the tag corners of a body over a trial, placed on the solved motion:
/// markers.c3d (millimetres, Z up) and markers.trc (millimetres, Y up), as most programs
/// that read such files expect. Errors: the disk; more markers or frames than a C3D can
/// store.
[[nodiscard]] Status write_tag_markers(const std::filesystem::path& folder,
                                       const Body& body,
                                       const reconstruct::SolvedTrial& solved);

}  // namespace marey::app
