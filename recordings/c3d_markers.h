// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recordings/c3d.h"
#include "recordings/marker_file.h"

namespace marey::recordings {

/// Which of a file's points are markers, and what they are called. Points that
/// POINT:ANGLES, FORCES, MOMENTS, POWERS or SCALARS list are results in other units.
struct C3dMarkers {
  std::vector<std::size_t> point;   ///< Of each marker.
  std::vector<std::string> labels;  ///< distinct_labels().
};
[[nodiscard]] C3dMarkers markers_of(const C3dInfo& info, std::vector<std::string>& notes);

/// A point's position in the file's frame and unit; nullopt when it was not seen. With
/// `trust_all`, what is marked as not seen counts too.
[[nodiscard]] std::optional<glm::dvec3> c3d_position(const C3dInfo& info,
                                                     const float* words,
                                                     bool trust_all);
/// The point's sample in the world. `words` as C3dFrame::points has them.
[[nodiscard]] std::optional<MarkerSample> c3d_sample(const C3dInfo& info,
                                                     const FileAxes& axes,
                                                     const float* words,
                                                     bool trust_all);
/// Its inverse: the four words of a point.
void put_c3d_sample(const C3dInfo& info,
                    const FileAxes& axes,
                    const std::optional<MarkerSample>& sample,
                    float* words);

/// Whether every sample of the file is marked as not seen though it has a position: files
/// of some vendors are so, and their positions are taken. Reads the file to its end, or
/// to the first sample that was seen.
[[nodiscard]] Result<bool> all_marked_unseen(C3dReader reader);

/// Whether there is a section of rotations behind the frames, which marey does not know.
[[nodiscard]] bool has_rotations(const C3dInfo& info);

/// What the header's events and the group EVENT tell.
[[nodiscard]] std::vector<MarkerEvent> events_of(const C3dInfo& info);
/// Sets the group EVENT.
void put_events(C3dInfo& info, const std::vector<MarkerEvent>& events);

/// Unit and axes of the file. `finder` has seen its markers.
[[nodiscard]] FileAxes axes_of(const C3dInfo& info,
                               const AxisFinder& finder,
                               const MarkerReadOptions& options,
                               std::vector<std::string>& notes);

[[nodiscard]] Result<MarkerFile> read_c3d_markers(const std::filesystem::path& path,
                                                  const MarkerReadOptions& options);
[[nodiscard]] Status write_c3d_markers(const std::filesystem::path& path,
                                       const MarkerFile& markers,
                                       const MarkerWriteOptions& options);

}  // namespace marey::recordings
