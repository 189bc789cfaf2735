// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::recordings {

/// A direction along one of a file's axes.
enum class FileAxis { kPlusX, kPlusY, kPlusZ, kMinusX, kMinusY, kMinusZ };

/// Returns the axis as text: "+Z".
[[nodiscard]] std::string_view name(FileAxis axis);
/// Parses "+Z", "Z" or "-x"; returns nullopt for any other text.
[[nodiscard]] std::optional<FileAxis> axis_of(std::string_view text);
[[nodiscard]] FileAxis opposite(FileAxis axis);
[[nodiscard]] glm::dvec3 unit_vector(FileAxis axis);

/// Source of a file's unit or upward axis.
enum class Evidence {
  kFile,        ///< Stated in the file.
  kMarkers,     ///< Estimated from the markers' positions.
  kPlates,      ///< Estimated from the orientation of the force plates.
  kConvention,  ///< Default of this file format.
  kUser,        ///< Given by the user.
};

/// Returns the word used in notes and in the output of `marey inspect`, such as "force
/// plates".
[[nodiscard]] std::string_view name(Evidence evidence);

/// The unit and axes of a file, kept to write the data in them again.
struct FileAxes {
  std::string unit = "mm";
  double per_metre = 1000.0;  ///< Units per metre.
  Evidence unit_from = Evidence::kFile;
  FileAxis up = FileAxis::kPlusZ;
  Evidence up_from = Evidence::kFile;
};

/// Returns the units per metre of a unit's name as files write it ("mm", "Meters",
/// "mete"); nullopt if it is no unit of length.
[[nodiscard]] std::optional<double> units_per_metre(std::string_view name);

/// Rotates from the file's frame to the world, and back. Up becomes +Y by the smallest
/// rotation: one of the other two axes stays in place, X unless it is the upward or
/// downward axis. The two functions are bit-exact inverses of each other.
[[nodiscard]] glm::dvec3 turned_to_world(FileAxis up, const glm::dvec3& v_in_file);
[[nodiscard]] glm::dvec3 turned_to_file(FileAxis up, const glm::dvec3& v_in_world);

/// Estimates the upward axis and the unit of length from the markers' positions.
///
/// Bodies stand on the floor, near height 0. Along the upward axis the lowest markers are
/// therefore always at the same height, at 0 or a little above it. Bodies are also about
/// as tall as they are wide, or taller. The chosen axis is the one along which the lowest
/// markers of the frames are nearest to 0 and vary least, relative to the extent along
/// it. There is no result if another axis is nearly as good.
///
/// Cost: linear in points, and one sort of the frames for each axis.
class AxisFinder {
 public:
  /// Adds the visible markers of one frame, in the file's frame and unit. Some hundred
  /// frames, distributed over the recording, are enough.
  void add_frame(std::span<const glm::dvec3> p_in_file);

  /// Returns the upward axis; nullopt if the markers are ambiguous.
  [[nodiscard]] std::optional<FileAxis> up() const;
  /// Returns the upward one of an axis and its opposite, if one of the two is known to be
  /// up; nullopt if the markers are ambiguous.
  [[nodiscard]] std::optional<FileAxis> up_along(FileAxis axis) const;
  /// Returns the unit (m, cm or mm) in which the markers' extent is that of a body;
  /// nullopt if the markers are ambiguous.
  [[nodiscard]] std::optional<std::string> unit() const;

 private:
  struct Stance {
    double floor = 0.0;  ///< Distance of the lowest markers from 0, plus their variation.
    double extent = 0.0;
  };
  [[nodiscard]] std::optional<Stance> stance(FileAxis axis) const;

  /// Minimum and maximum of each coordinate in one frame.
  struct Box {
    glm::dvec3 min{0.0};
    glm::dvec3 max{0.0};
    std::size_t markers = 0;
  };
  /// Returns the boxes of frames with nearly all markers. In other frames the lowest
  /// marker may be far from the floor.
  [[nodiscard]] std::vector<Box> full_boxes() const;

  std::vector<Box> boxes_;
};

}  // namespace marey::recordings
