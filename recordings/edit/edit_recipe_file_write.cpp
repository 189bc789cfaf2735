// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/base/toml_writer.h"
#include "recordings/edit/edit_key_writer.h"
#include "recordings/edit/edit_op_checks.h"
#include "recordings/edit/edit_recipe_file.h"

namespace marey::recordings {
namespace {

using recipe::KeysOf;
using recipe::KeyWriter;

void write_source(TomlWriter& out, const EditSource& source) {
  if (!source.id.empty()) out.text("id", source.id);
  out.text("path", source.path);
  if (!source.sha256.empty()) out.text("sha256", source.sha256);
}

/// Returns the names of the groups, each once, in the order of kEditGroups.
std::vector<std::string_view> group_names(const std::vector<EditGroup>& groups) {
  std::vector<std::string_view> names;
  for (const EditGroup group : kEditGroups) {
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) continue;
    names.push_back(name(group));
  }
  return names;
}

void write_op(TomlWriter& out, const EditOp& op, WhyText why) {
  out.array_table("op");
  std::string word(name(op.parameters));
  word += '@';
  append_exact(word, op.version);
  out.text("do", word);
  if (op.off) out.boolean("off", true);
  if (why == WhyText::kIncluded && !op.why.empty()) out.text("why", op.why);
  KeyWriter<EditSpan> span(out, op.span);
  visit_keys(span, KeysOf<EditSpan>{});
  if (!op.groups.empty()) out.texts("groups", group_names(op.groups));
  if (op.blend_s != 0.0) out.number("blend_s", op.blend_s);
  const auto write_keys = [&](const auto& parameters) {
    using Op = std::decay_t<decltype(parameters)>;
    KeyWriter<Op> writer(out, parameters);
    visit_keys(writer, KeysOf<Op>{});
  };
  std::visit(write_keys, recipe::without_idle_values(op.parameters));
}

}  // namespace

std::string edit_op_text(const EditOp& op, WhyText why) {
  TomlWriter out;
  write_op(out, op, why);
  return out.str();
}

std::string edit_recipe_text(const EditRecipe& recipe) {
  TomlWriter out;
  out.comment("A recipe of marey edit: docs/formats/edit_recipe.md describes its keys.");
  out.integer("format", 1);
  if (!recipe.name.empty()) out.text("name", recipe.name);
  for (const EditSource& source : recipe.sources) {
    if (recipe.sources.size() == 1) {
      out.table({"source"});
    } else {
      out.array_table("source");
    }
    write_source(out, source);
  }
  if (recipe.limits != EditLimits{}) {
    out.table({"limits"});
    KeyWriter<EditLimits> limits(out, recipe.limits);
    visit_keys(limits, KeysOf<EditLimits>{});
  }
  for (const EditOp& op : recipe.ops) write_op(out, op, WhyText::kIncluded);
  return out.str();
}

Status write_edit_recipe(const std::filesystem::path& path, const EditRecipe& recipe) {
  const std::string text = edit_recipe_text(recipe);
  if (const auto read = parse_edit_recipe(text, path); !read) return read.error();
  return write_file(path, text);
}

}  // namespace marey::recordings
