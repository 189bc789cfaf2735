// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recordings/markers/c3d.h"
#include "recordings/markers/labelled_markers.h"

namespace marey::recordings {

/// The points of a file that are markers, with their labels. Points listed in
/// POINT:ANGLES, FORCES, MOMENTS, POWERS or SCALARS are model outputs in other units and
/// are excluded.
struct C3dMarkers {
  std::vector<std::size_t> point;   ///< Index of each marker's point.
  std::vector<std::string> labels;  ///< distinct_labels().
};
[[nodiscard]] C3dMarkers markers_of(const C3dInfo& info, std::vector<std::string>& notes);

/// Returns a point's position in the file's frame and unit; nullopt if it was not seen.
/// With `trust_all`, positions marked as not seen are returned too.
[[nodiscard]] std::optional<glm::dvec3> c3d_position(const C3dInfo& info,
                                                     const float* words,
                                                     bool trust_all);
/// Returns the point's sample in the world. `words` are those of C3dFrame::points.
[[nodiscard]] std::optional<MarkerSample> c3d_sample(const C3dInfo& info,
                                                     const FileAxes& axes,
                                                     const float* words,
                                                     bool trust_all);
/// Writes the four words of a point. Inverse of c3d_sample().
void put_c3d_sample(const C3dInfo& info,
                    const FileAxes& axes,
                    const std::optional<MarkerSample>& sample,
                    float* words);

/// Detects files in which every sample is marked as not seen although it has a position.
/// Some vendors write such files, and their positions are used. Reads the file to its
/// end, or to the first sample that was seen.
[[nodiscard]] Result<bool> all_marked_unseen(C3dReader reader);

/// True if a section of rotations follows the frames. marey does not read it.
[[nodiscard]] bool has_rotations(const C3dInfo& info);

/// Returns the events of the header and of the group EVENT.
[[nodiscard]] std::vector<MarkerEvent> events_of(const C3dInfo& info);
/// Sets the group EVENT.
void put_events(C3dInfo& info, const std::vector<MarkerEvent>& events);

/// Determines the unit and axes of the file. Precondition: `finder` has received the
/// file's markers.
[[nodiscard]] FileAxes axes_of(const C3dInfo& info,
                               const AxisFinder& finder,
                               const MarkerReadOptions& options,
                               std::vector<std::string>& notes);

[[nodiscard]] Result<MarkerFile> read_c3d_markers(const std::filesystem::path& path,
                                                  const MarkerReadOptions& options);
/// Reads a C3D file in memory like read_markers().
[[nodiscard]] Result<MarkerFile> parse_c3d_markers(std::string bytes,
                                                   const std::string& file,
                                                   const MarkerReadOptions& options = {});

[[nodiscard]] Status write_c3d_markers(const std::filesystem::path& path,
                                       const MarkerFile& markers,
                                       const MarkerWriteOptions& options);

}  // namespace marey::recordings
