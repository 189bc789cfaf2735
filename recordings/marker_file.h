// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/marker_tracks.h"
#include "core/result.h"
#include "recordings/file_axes.h"

namespace marey::recordings {

/// Something that happened: a heel strike.
struct MarkerEvent {
  std::string label;
  std::string context;  ///< "Left"; may be empty.
  std::string subject;  ///< May be empty.
  double time_s = 0.0;  ///< On the clock of the tracks.
};

/// What a file of labelled markers holds.
struct MarkerFile {
  MarkerTracks tracks;
  FileAxes axes;  ///< Of the file; the tracks are in the world.
  std::vector<MarkerEvent> events;
  /// What was odd in the file, or had to be found out. Sentences without a full stop.
  std::vector<std::string> notes;
};

/// What the reader is told, before what the file says.
struct MarkerReadOptions {
  std::optional<FileAxis> up;
  std::optional<std::string> unit;  ///< One that units_per_metre() knows.
};

/// Reads labelled markers of a C3D or TRC, which its extension tells. Labels are made
/// different from each other and none is left empty; samples at exactly (0, 0, 0), beyond
/// 10 km or not finite are taken for not seen. All that is said in the notes.
///
/// Up is what the file's screen parameters say (C3D), corrected by how its force plates
/// lie and where its markers are; else what these say; else +Z in C3D and +Y in TRC.
/// Errors (kBadInput): as C3dReader::open() and parse_trc() say; another extension.
/// Cost: memory for the tracks, 48 bytes a sample; see benchmarks for time.
/// Precondition: options.unit is known to units_per_metre().
[[nodiscard]] Result<MarkerFile> read_markers(const std::filesystem::path& path,
                                              const MarkerReadOptions& options = {});

struct MarkerWriteOptions {
  /// The unit and axes of the result; what `markers` came in when none are given.
  std::optional<FileAxes> axes;
  /// A C3D that these markers were read from: what else is in it (parameters, analog
  /// channels, points that are no markers, the kind of its numbers), and the words of
  /// samples that were not changed, are kept.
  std::optional<std::filesystem::path> source;
};

/// Writes labelled markers as C3D or TRC, which the extension tells. Reading gives the
/// same again: of a TRC to the last bit or the one before it (to the last, what was read
/// from a TRC, or is written in metres), of a C3D to the precision of its 32-bit reals. A
/// C3D keeps sigma and cameras, and repaired and inferred samples have neither there; a
/// TRC keeps positions alone. Errors: (kBadInput) another extension, a source whose
/// markers are others, more than the format has room for; AtomicFile's. Precondition:
/// positions finite; rate above 0.
[[nodiscard]] Status write_markers(const std::filesystem::path& path,
                                   const MarkerFile& markers,
                                   const MarkerWriteOptions& options = {});

/// The C3D part of read_markers(), of a file in memory.
[[nodiscard]] Result<MarkerFile> parse_c3d_markers(std::string bytes,
                                                   const std::string& file,
                                                   const MarkerReadOptions& options = {});

}  // namespace marey::recordings
