// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Calibrations: marey's TOML, and YAML and XML of other programs.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "recordings/session/calibration_file.h"
#include "recordings/session/calibration_import.h"

namespace {

using namespace marey;
using namespace marey::recordings;

void check(const Result<Calibration>& read) {
  if (!read) {
    MAREY_ASSERT(!read.error().cause.empty());
    return;
  }
  MAREY_ASSERT(!read->cameras.empty() && read->cameras.size() == read->quality.size());
  for (const Camera& camera : read->cameras) {
    MAREY_ASSERT(std::isfinite(camera.intrinsics.focal_px.x));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  // The parser searches for files in the same folder, which does not exist.
  const char* const kNames[] = {"/none/fuzz.toml", "/none/fuzz.yaml", "/none/fuzz.xml"};
  const unsigned kind = data[0] % 3U;
  check(kind == 0 ? parse_calibration(text, kNames[0])
                  : import_calibration(text, kNames[kind]));
  return 0;
}
