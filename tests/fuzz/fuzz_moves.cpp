// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/assert.h"
#include "recordings/moves/moves_schema.h"
#include "recordings/moves/page_sums.h"
#include "recordings/moves/read_moves.h"
#include "recordings/moves/write_moves.h"

namespace {

using namespace marey;
using namespace marey::recordings;

void check(const Result<MoveSet>& read) {
  if (!read) {
    MAREY_ASSERT(!read.error().cause.empty() && !read.error().next.empty());
    return;
  }
  // Clips that were read can be written and read again.
  const auto bytes = moves_bytes(*read, "again.marey");
  MAREY_ASSERT(bytes.has_value() && parse_moves(*bytes, "again.marey").has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  check(parse_moves(bytes, "fuzz.marey"));
  // The file with right sums of its pages, which no mutation hits.
  bytes.resize(bytes.size() / kMovesPageBytes * kMovesPageBytes);
  write_page_sums(bytes, kMovesPageBytes);
  check(parse_moves(bytes, "fuzz.marey"));
  return 0;
}
