// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/marker_file.h"

#include "core/base/extension.h"
#include "core/base/input_file.h"
#include "recordings/base/atomic_file.h"
#include "recordings/markers/c3d_markers.h"
#include "recordings/markers/trc.h"

namespace marey::recordings {
namespace {

Error unknown_kind(const std::filesystem::path& path) {
  return bad_input(path.string(),
                   "labelled markers are read and written as .c3d and .trc only",
                   "give a file of one of these kinds");
}

}  // namespace

Status check_marker_extension(const std::filesystem::path& path) {
  const std::string kind = kind_by_extension(path);
  if (kind == ".c3d" || kind == ".trc") return Done{};
  return unknown_kind(path);
}

Result<MarkerFile> read_markers(const std::filesystem::path& path,
                                const MarkerReadOptions& options) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  const std::string kind = kind_by_extension(path);
  if (kind == ".c3d") return read_c3d_markers(path, options);
  if (kind != ".trc") return unknown_kind(path);
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_trc(*text, path.string(), options);
}

Status write_markers(const std::filesystem::path& path,
                     const MarkerFile& markers,
                     const MarkerWriteOptions& options) {
  const std::string kind = kind_by_extension(path);
  if (kind == ".c3d") return write_c3d_markers(path, markers, options);
  if (kind != ".trc") return unknown_kind(path);
  return write_file(
      path,
      trc_text(
          markers.tracks, options.axes.value_or(markers.axes), path.filename().string()));
}

}  // namespace marey::recordings
