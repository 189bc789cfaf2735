// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Databases of takes, recorded and live.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/base/assert.h"
#include "recordings/takes/live_take.h"
#include "recordings/takes/take_file.h"

namespace {

using namespace marey;
using namespace marey::recordings;

std::filesystem::path make_folder() {
  std::string name =
      (std::filesystem::temp_directory_path() / "marey-fuzz-XXXXXX").string();
  MAREY_ASSERT(mkdtemp(name.data()) != nullptr);
  return name;
}

void check(const Take& take) {
  for (const TakeCamera& camera : take.cameras) {
    Timestamp last{0};
    for (const TakeFrame& frame : camera.frames) {
      MAREY_ASSERT(frame.time >= last && frame.dropped_before >= 0);
      last = frame.time;
    }
  }
  for (const TakeEvent& event : take.events) {
    MAREY_ASSERT(static_cast<std::size_t>(event.camera) < take.cameras.size());
  }
}

void check(const LiveTake& take) {
  for (std::size_t i = 1; i < take.instants.size(); ++i) {
    MAREY_ASSERT(take.instants[i].seen.number > take.instants[i - 1].seen.number);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = make_folder();
  const std::filesystem::path file = folder / "fuzz.sqlite";
  for (const char* suffix : {"-wal", "-shm", "-journal"}) {
    std::error_code ignored;
    std::filesystem::remove(file.string() + suffix, ignored);
  }
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  if (const auto take = read_take(file)) check(*take);
  if (const auto take = read_live_take(file)) check(*take);
  return 0;
}
