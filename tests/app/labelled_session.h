// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "tests/support/bodies/synthetic_person.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {

/// A label of Plug-in Gait and what it is glued to. Of what is on both sides L and left_,
/// R and right_ come in front.
struct Glued {
  const char* label;
  const char* landmark;
};
[[nodiscard]] std::vector<Glued> worn_on_each_side();

/// The person of the tags' tests, not an average one, with Plug-in Gait's markers and
/// those inside of knees and ankles, every one some millimetres from where it is on
/// others.
[[nodiscard]] Body labelled_person();

/// Those inside of knees and ankles, the last four, are worn while standing alone.
[[nodiscard]] Body without_markers_inside(Body body);

/// As C3D or TRC. Throws std::runtime_error when it cannot.
void write_tracks(const std::filesystem::path& path, MarkerTracks tracks);

/// The person standing, 20 frames: fitted in no time.
std::filesystem::path write_static(const ScratchFolder& folder, const std::string& name);

/// `marey fit` without progress.
[[nodiscard]] ProgramRun fit(std::vector<std::string> arguments);

/// The median and 95th percent of the distances of limb joints from the truth. [m]
[[nodiscard]] std::pair<double, double> joint_errors(const std::filesystem::path& csv,
                                                     const Body& person,
                                                     const Movement& movement);

}  // namespace marey::testing
