// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "recordings/body/constraints_file.h"

namespace {

using namespace marey;
using namespace marey::recordings;

/// Asserts that read constraints can be written, and that reading and writing them again
/// changes nothing.
void write_again(const ConstraintSet& first) {
  const Result<std::string> text = constraints_text(first);
  MAREY_ASSERT(text.has_value());
  const Result<ConstraintFile> second = parse_constraints(*text, "again.xml");
  MAREY_ASSERT(second.has_value());
  MAREY_ASSERT(second->set.constraints.size() == first.constraints.size());
  for (std::size_t i = 0; i < first.constraints.size(); ++i) {
    const Constraint& a = first.constraints[i];
    const Constraint& b = second->set.constraints[i];
    MAREY_ASSERT(a.id == b.id && a.point.segment == b.point.segment);
    MAREY_ASSERT(a.goal.index() == b.goal.index());
    MAREY_ASSERT(a.point.offset_in_t_pose == b.point.offset_in_t_pose);
    MAREY_ASSERT(a.range == b.range && a.activation.start_s == b.activation.start_s);
    MAREY_ASSERT(a.unknown_xml == b.unknown_xml);
  }
  MAREY_ASSERT(second->set.unknown_xml == first.unknown_xml);
  const Result<std::string> again = constraints_text(second->set);
  MAREY_ASSERT(again.has_value() && *again == *text);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<ConstraintFile> file = parse_constraints(text, "fuzz.xml");
  if (file) write_again(file->set);
  return 0;
}
