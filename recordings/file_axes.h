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

/// "+Z"
[[nodiscard]] std::string_view name(FileAxis axis);
/// Of "+Z", "Z", "-x"; nullopt of anything else.
[[nodiscard]] std::optional<FileAxis> axis_of(std::string_view text);
[[nodiscard]] FileAxis opposite(FileAxis axis);
[[nodiscard]] glm::dvec3 unit_vector(FileAxis axis);

/// Who said what a file's unit or upward axis is.
enum class Evidence {
  kFile,     ///< The file.
  kMarkers,  ///< Where its markers are.
  kPlates,   ///< How its force plates lie.
  kHabit,    ///< Nobody: most files of its kind are so.
  kUser,     ///< Who reads it.
};

/// "file", "markers", "force plates", "habit", "user"
[[nodiscard]] std::string_view name(Evidence evidence);

/// The unit and axes of a file, kept so that it can be written in them again.
struct FileAxes {
  std::string unit = "mm";
  double per_metre = 1000.0;  ///< Units in a metre.
  Evidence unit_from = Evidence::kFile;
  FileAxis up = FileAxis::kPlusZ;
  Evidence up_from = Evidence::kFile;
};

/// The length of a unit as files name it ("mm", "Meters", "mete"), in units per metre.
/// nullopt of what is no unit of length.
[[nodiscard]] std::optional<double> units_per_metre(std::string_view name);

/// From the file's frame to the world. Up becomes +Y by the smallest turn: of the other
/// two axes one keeps its place, X unless it is the one that is up or down.
/// Inverse of each other, bit for bit.
[[nodiscard]] glm::dvec3 turned_to_world(FileAxis up, const glm::dvec3& v_in_file);
[[nodiscard]] glm::dvec3 turned_to_file(FileAxis up, const glm::dvec3& v_in_world);

/// Looks at where markers are, to say which way is up and how long the unit is.
///
/// Bodies stand on the floor, which is near height 0: seen along the upward axis the
/// lowest markers are always at the same height, at 0 or a little above it; and bodies
/// are about as tall as they are wide, or taller. So the axis is taken along which the
/// lowest markers of the frames are nearest to 0 and steadiest, measured by the extent
/// along it; and none if another is nearly as good.
///
/// Cost: linear in points, a sort of the frames for each axis.
class AxisFinder {
 public:
  /// The seen markers of one frame, in the file's frame and unit. Some hundred frames,
  /// spread over the recording, are enough.
  void add_frame(std::span<const glm::dvec3> p_in_file);

  /// The upward axis; nullopt where the markers do not say.
  [[nodiscard]] std::optional<FileAxis> up() const;
  /// Which of an axis and its opposite is up, one being known to be; nullopt likewise.
  [[nodiscard]] std::optional<FileAxis> up_along(FileAxis axis) const;
  /// The unit in which the markers span what bodies do, of m, cm and mm; nullopt
  /// likewise.
  [[nodiscard]] std::optional<std::string> unit() const;

 private:
  struct Stance {
    double floor = 0.0;  ///< How far the lowest markers are from 0, and how they vary.
    double extent = 0.0;
  };
  [[nodiscard]] std::optional<Stance> stance(FileAxis axis) const;

  /// One frame: the least and the greatest of each coordinate.
  struct Box {
    glm::dvec3 least{0.0};
    glm::dvec3 greatest{0.0};
    std::size_t markers = 0;
  };
  /// Those with nearly all markers: in others the lowest may be far from the floor.
  [[nodiscard]] std::vector<Box> full_boxes() const;

  std::vector<Box> boxes_;
};

}  // namespace marey::recordings
