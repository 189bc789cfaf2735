// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Recipes of marey edit and their annotations: text that is read is written and read
// again as the same text.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/assert.h"
#include "recordings/edit/annotations_file.h"
#include "recordings/edit/edit_recipe_file.h"

namespace {

using namespace marey;
using namespace marey::recordings;

template <class T>
void check_error(const Result<T>& result) {
  if (result) return;
  const Error& error = result.error();
  MAREY_ASSERT(error.code == Errc::kBadInput && !error.where.empty());
  MAREY_ASSERT(!error.cause.empty() && !error.next.empty());
}

void check_recipe(std::string_view text) {
  const Result<EditRecipe> first = parse_edit_recipe(text, "fuzz.edit.toml");
  check_error(first);
  if (!first) return;
  const std::string written = edit_recipe_text(*first);
  const Result<EditRecipe> second = parse_edit_recipe(written, "again.edit.toml");
  MAREY_ASSERT(second.has_value());
  MAREY_ASSERT(second->ops.size() == first->ops.size());
  MAREY_ASSERT(edit_recipe_text(*second) == written);
  for (const EditOp& op : first->ops) {
    MAREY_ASSERT(parse_edit_op(edit_op_text(op), "op").has_value());
  }
}

void check_annotations_text(std::string_view text) {
  const Result<Annotations> first = parse_annotations(text, "fuzz.json");
  check_error(first);
  if (!first) return;
  const Result<std::string> written = annotations_text(*first);
  MAREY_ASSERT(written.has_value());
  const Result<Annotations> second = parse_annotations(*written, "again.json");
  MAREY_ASSERT(second.has_value() && *second == *first);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.starts_with('{')) {
    check_annotations_text(text);
  } else {
    check_recipe(text);
  }
  check_error(parse_edit_op(text, "op"));
  return 0;
}
