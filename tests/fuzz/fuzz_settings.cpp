// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Every TOML file that marey reads, by all of its readers.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/assert.h"
#include "core/human/average_proportions.h"
#include "core/skeleton.h"
#include "recordings/base/nesting.h"
#include "recordings/base/toml_reader.h"
#include "recordings/body/bone_map_file.h"
#include "recordings/body/character_file.h"
#include "recordings/body/floor_file.h"
#include "recordings/markers/marker_map.h"
#include "recordings/session/plan_file.h"
#include "recordings/session/subject_file.h"

namespace {

using namespace marey;
using namespace marey::recordings;

std::size_t depth_of(const TomlValue& value) {
  std::size_t deepest = 0;
  if (const auto* list = std::get_if<std::vector<TomlValue>>(&value.content)) {
    for (const TomlValue& item : *list) deepest = std::max(deepest, depth_of(item));
    return deepest + 1;
  }
  if (const auto* table = std::get_if<std::vector<TomlEntry>>(&value.content)) {
    for (const TomlEntry& entry : *table) {
      deepest = std::max(deepest, depth_of(entry.value));
    }
    return deepest + 1;
  }
  return 0;
}

template <class T>
void check(const Result<T>& result) {
  if (!result)
    MAREY_ASSERT(!result.error().cause.empty() && !result.error().next.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static const Skeleton skeleton = make_humanoid(average_proportions(1.7));
  const Result<TomlDocument> document = parse_toml(text, "fuzz.toml");
  check(document);
  if (document) MAREY_ASSERT(depth_of(document->root) <= kMaxNesting + 1);
  check(parse_subject(text, "fuzz.toml"));
  check(parse_plan(text, "fuzz.toml"));
  check(parse_character_spec(text, "fuzz.toml"));
  check(parse_floor(text, "fuzz.toml"));
  check(parse_marker_map(text, "fuzz.toml"));
  check(parse_bone_map(text, "fuzz.toml", skeleton));
  return 0;
}
