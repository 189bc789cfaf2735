// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/assert.h"
#include "recordings/c3d.h"
#include "recordings/force_plates.h"
#include "recordings/marker_file.h"
#include "recordings/trc.h"

namespace {

using namespace marey;
using namespace marey::recordings;

/// What was read can be written again, and is then the same.
void write_again(const C3dInfo& info) {
  if (info.first_frame < 0 || info.points > 1000) return;
  const Result<std::string> head = c3d_head(info);
  if (!head) return;
  C3dInfo promised = info;
  promised.frames = 0;
  static_cast<void>(c3d_head(promised));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (Result<C3dReader> reader = C3dReader::of_bytes(bytes, "fuzz.c3d")) {
    write_again(reader->info());
    C3dFrame frame;
    for (Result<bool> more = true; more && *more;) more = reader->next(frame);
  }
  const Result<MarkerFile> markers = parse_c3d_markers(bytes, "fuzz.c3d");
  if (!markers) return 0;
  static_cast<void>(parse_force_plates(bytes, "fuzz.c3d", markers->axes));
  // Sizes that fuzzing would lose its time with.
  if (markers->tracks.markers() > 100 || markers->tracks.frames() > 100) return 0;
  const std::string text = trc_text(markers->tracks, markers->axes, "fuzz");
  MAREY_ASSERT(parse_trc(text, "fuzz.trc").has_value());
  return 0;
}
