// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/marker_tracks.h"
#include "recordings/markers/labelled_markers.h"

namespace marey::recordings {

/// Checks the extension of a file of markers before the work begins. Errors (kBadInput):
/// it is neither .c3d nor .trc.
[[nodiscard]] Status check_marker_extension(const std::filesystem::path& path);

/// Reads labelled markers of a C3D or TRC; the extension selects the format. Labels are
/// made unique and non-empty. Samples at exactly (0, 0, 0), beyond 10 km or not finite
/// count as not seen. The notes report all such changes.
///
/// The upward axis is that of the file's screen parameters (C3D), corrected by the
/// orientation of its force plates and its markers' positions. Without screen parameters
/// it is estimated from these; the default is +Z in C3D and +Y in TRC. Errors
/// (kBadInput): those of C3dReader::open() and parse_trc(); another extension. Cost:
/// memory for the tracks, 48 bytes a sample; see benchmarks for time. Precondition:
/// options.unit is known to units_per_metre().
[[nodiscard]] Result<MarkerFile> read_markers(const std::filesystem::path& path,
                                              const MarkerReadOptions& options = {});

/// Writes labelled markers as C3D or TRC; the extension selects the format. Reading the
/// file returns the same values: from a TRC within one unit in the last place (exactly if
/// they were read from a TRC, or are written in metres), from a C3D within the precision
/// of its 32-bit reals. A C3D stores sigma and cameras, except for repaired and inferred
/// samples, and up to 255 events; a TRC stores positions alone. Errors (kBadInput):
/// another extension; a source with different markers or frames; more data than the
/// format can store; errors of AtomicFile. Preconditions: positions are finite; the rate
/// is above 0.
[[nodiscard]] Status write_markers(const std::filesystem::path& path,
                                   const MarkerFile& markers,
                                   const MarkerWriteOptions& options = {});

}  // namespace marey::recordings
