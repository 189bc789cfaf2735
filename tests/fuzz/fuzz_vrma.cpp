// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// VRM animations: what is read with a motion can be written and read again.
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/assert.h"
#include "recordings/gltf/gltf.h"
#include "recordings/gltf/vrma.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace marey::recordings;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  // A file may name others, which are none of the fuzzer's.
  if (bytes.find("uri") != std::string::npos) return 0;
  const auto character = parse_character(bytes, "fuzz.vrma");
  if (!character) {
    MAREY_ASSERT(!character.error().cause.empty());
    return 0;
  }
  if (!character->motion || character->motion->poses.size() > 1000) return 0;
  const auto written = vrma_bytes(*character->motion);
  if (written) MAREY_ASSERT(parse_character(*written, "again.vrma").has_value());
  return 0;
}
