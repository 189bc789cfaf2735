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

/// A label of Plug-in Gait and the landmark of its marker. For markers of both sides, the
/// label gets the prefix L or R, and the landmark left_ or right_.
struct Glued {
  const char* label;
  const char* landmark;
};
[[nodiscard]] std::vector<Glued> worn_on_each_side();

/// Returns the person of the tags' tests, whose proportions are not average. The person
/// wears Plug-in Gait's markers and medial markers of knees and ankles. Each marker is
/// some millimetres from its average place.
[[nodiscard]] Body labelled_person();

/// Removes the last four markers, the medial ones of knees and ankles: the person wears
/// them only while standing.
[[nodiscard]] Body without_markers_inside(Body body);

/// Writes a C3D or a TRC. Throws std::runtime_error when it cannot.
void write_tracks(const std::filesystem::path& path, MarkerTracks tracks);

/// Writes 20 frames of the standing person, which take little time to fit.
std::filesystem::path write_static(const ScratchFolder& folder, const std::string& name);

/// `marey fit` without progress.
[[nodiscard]] ProgramRun fit(std::vector<std::string> arguments);

/// The median and 95th percent of the distances of limb joints from the truth. [m]
[[nodiscard]] std::pair<double, double> joint_errors(const std::filesystem::path& csv,
                                                     const Body& person,
                                                     const Movement& movement);

}  // namespace marey::testing
