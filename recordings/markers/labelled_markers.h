// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/marker_tracks.h"
#include "recordings/markers/file_axes.h"

namespace marey::recordings {

/// An event, such as a heel strike.
struct MarkerEvent {
  std::string label;
  std::string context;  ///< "Left"; may be empty.
  std::string subject;  ///< May be empty.
  double time_s = 0.0;  ///< On the clock of the tracks.
  bool operator==(const MarkerEvent&) const = default;
};

/// Content of a file of labelled markers.
struct MarkerFile {
  MarkerTracks tracks;
  FileAxes axes;  ///< Axes of the file; the tracks are in the world.
  std::vector<MarkerEvent> events;
  /// Anomalies of the file and estimated properties. Sentences without a full stop.
  std::vector<std::string> notes;
};

/// Options of reading; they override the file's own statements.
struct MarkerReadOptions {
  std::optional<FileAxis> up;
  std::optional<std::string> unit;  ///< A unit known to units_per_metre().
};

/// Options of writing labelled markers.
struct MarkerWriteOptions {
  /// Unit and axes of the written file; default: those of `markers`.
  std::optional<FileAxes> axes;
  /// A C3D that these markers were read from. Its other content is kept (parameters,
  /// analog channels, points that are no markers, the type of its numbers), and so are
  /// the words of unchanged samples. Events that differ from the source's replace them.
  std::optional<std::filesystem::path> source;
  /// Index of the source's frame that is the first one of these markers, for a part of
  /// the source: the other content is cut alike. nullopt: they have all frames.
  std::optional<std::size_t> source_first = std::nullopt;
  /// Axes and unit that the source does not state, or states wrongly, are stated in the
  /// copy (POINT:X_SCREEN, Y_SCREEN, UNITS), so that a part of it is read alike.
  bool state_axes = false;
};

}  // namespace marey::recordings
