// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/assert.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/c3d_markers.h"
#include "recordings/markers/force_plates.h"
#include "recordings/markers/marker_file.h"
#include "recordings/markers/trc.h"

namespace {

using namespace marey;
using namespace marey::recordings;

/// A head that was read can be written, and is read as the same.
void write_again(C3dInfo info) {
  // A header has no word for no frames from 0 on.
  if (info.first_frame < 1) return;
  info.frames = 0;
  const Result<std::string> head = c3d_head(info);
  if (!head) return;
  const Result<C3dReader> again = C3dReader::of_bytes(*head, "again.c3d");
  MAREY_ASSERT(again.has_value());
  MAREY_ASSERT(again->info().processor == info.processor);
  MAREY_ASSERT(again->info().points == info.points);
  for (const C3dGroup& group : info.groups) {
    for (const C3dParameter& parameter : group.parameters) {
      MAREY_ASSERT(find_parameter(again->info().groups, group.name, parameter.name) !=
                   nullptr);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (Result<C3dReader> reader = C3dReader::of_bytes(bytes, "fuzz.c3d")) {
    write_again(reader->info());
    C3dFrame frame;
    for (Result<bool> more = true; more && *more;) more = reader->next(frame);
    // A few bytes can ask for 65535 labels, in which fuzzing would lose its time.
    if (reader->info().points > 1000) return 0;
  }
  const Result<MarkerFile> markers = parse_c3d_markers(bytes, "fuzz.c3d");
  if (!markers) return 0;
  static_cast<void>(parse_force_plates(bytes, "fuzz.c3d", markers->axes));
  if (markers->tracks.markers() > 100 || markers->tracks.frames() > 100) return 0;
  const std::string text = trc_text(markers->tracks, markers->axes, "fuzz");
  MAREY_ASSERT(parse_trc(text, "fuzz.trc").has_value());
  return 0;
}
