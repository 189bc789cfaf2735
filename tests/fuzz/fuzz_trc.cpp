// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "recordings/markers/trc.h"

namespace {

using namespace marey;
using namespace marey::recordings;

/// Asserts that written markers are read back unchanged.
void read_again(const MarkerFile& first) {
  MarkerReadOptions options;
  options.up = first.axes.up;
  const std::string text = trc_text(first.tracks, first.axes, "fuzz.trc");
  const Result<MarkerFile> second = parse_trc(text, "again.trc", options);
  MAREY_ASSERT(second.has_value());
  MAREY_ASSERT(second->tracks.frames() == first.tracks.frames());
  MAREY_ASSERT(second->tracks.markers() == first.tracks.markers());
  for (std::size_t i = 0; i < first.tracks.samples.size(); ++i) {
    const auto& a = first.tracks.samples[i];
    const auto& b = second->tracks.samples[i];
    MAREY_ASSERT(a.has_value() == b.has_value());
    if (a) MAREY_ASSERT(a->p_in_world == b->p_in_world);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<MarkerFile> markers = parse_trc(text, "fuzz.trc");
  if (markers && markers->tracks.samples.size() < 10'000) read_again(*markers);
  return 0;
}
