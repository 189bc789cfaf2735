// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/hex_digits.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/edit/edit_key_list.h"
#include "recordings/edit/edit_key_reader.h"
#include "recordings/edit/edit_limits.h"
#include "recordings/edit/edit_op_read.h"
#include "recordings/edit/edit_recipe_file.h"

namespace marey::recordings {
namespace {

constexpr int kRecipeFormat = 1;
constexpr std::string_view kRecipePage = "edit_recipe.md";

/// Reads a text of hexadecimal digits in either case.
std::string read_sha256(TomlReader& in) {
  constexpr std::size_t kDigits = 64;
  std::string sum = in.text("sha256");
  for (char& c : sum) {
    if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
  }
  if (!is_hex(sum, kDigits)) {
    in.fail("sha256",
            "\"sha256\" is not a SHA-256 sum of 64 digits",
            "remove the key; marey edit writes it again");
  }
  return sum;
}

EditSource read_source(TomlReader& in) {
  in.allow({"id", "path", "sha256"});
  EditSource source;
  source.line = in.line();
  if (in.has("id")) source.id = recipe::read_line(in, "id", recipe::kMaxNameBytes);
  source.path = recipe::read_line(in, "path", recipe::kMaxPathBytes);
  if (in.has("sha256")) source.sha256 = read_sha256(in);
  return source;
}

void read_sources(TomlReader& root, EditRecipe& recipe) {
  std::vector<TomlReader> tables;
  if (root.is_table("source")) {
    tables.push_back(root.table("source"));
  } else {
    tables = root.tables("source");
  }
  if (tables.empty()) {
    root.fail("source", "no [source] in it", "add [source] with path = \"MOTION\"");
  }
  std::set<std::string> ids;
  for (TomlReader& table : tables) {
    EditSource source = read_source(table);
    if (source.id.empty() && !recipe.sources.empty()) {
      table.fail("", "the source has no id", "add id = \"NAME\", which splice@1 names");
    } else if (!ids.insert(source.id).second) {
      table.fail("id",
                 "another source has the id " + in_quotes(source.id),
                 "give each an id of its own");
    }
    recipe.sources.push_back(std::move(source));
    if (!root.ok()) return;
  }
}

/// Checks that the recipe lists the source of a splice.
void check_spliced(TomlReader& in, const EditRecipe& recipe, const EditOp& op) {
  const auto* const splice = std::get_if<SpliceOp>(&op.parameters);
  if (splice == nullptr || !in.ok()) return;
  std::vector<std::string_view> ids;
  for (const EditSource& source : recipe.sources) {
    if (source.id == splice->source) return;
    if (!source.id.empty()) ids.push_back(source.id);
  }
  in.fail("source",
          "there is no source with the id " + in_quotes(splice->source),
          ids.empty() ? "list each motion under [[source]] with id and path"
                      : suggestion(splice->source, ids));
}

void read_ops(TomlReader& root, EditRecipe& recipe) {
  if (root.count("op") > recipe::kMaxOps) {
    std::string cause = "it has ";
    append_exact(cause, static_cast<int>(root.count("op")));
    root.fail("op",
              cause + " operations, more than 10000",
              "divide it: the result of one recipe can be the source of another");
    return;
  }
  for (TomlReader& table : root.tables("op")) {
    EditOp op = recipe::read_op(table);
    check_spliced(table, recipe, op);
    recipe.ops.push_back(std::move(op));
    if (!root.ok()) return;
  }
}

/// Reads the name, which becomes a part of file names.
std::string read_recipe_name(TomlReader& in) {
  constexpr std::size_t kMaxFileNameBytes = 200;
  std::string name = recipe::read_line(in, "name", kMaxFileNameBytes);
  if (name.find_first_of("/\\") != std::string::npos || name.starts_with('.')) {
    in.fail("name",
            in_quotes(name) + " cannot be a part of a file name",
            "write a name without slashes that does not begin with a dot");
  }
  return name;
}

void read_limits(TomlReader in, EditLimits& limits) {
  recipe::KeyList known;
  visit_keys(known, recipe::KeysOf<EditLimits>{});
  in.allow(std::vector<std::string_view>(known.keys().begin(), known.keys().end()));
  recipe::KeyReader<EditLimits> reader(in, limits);
  visit_keys(reader, recipe::KeysOf<EditLimits>{});
}

void check_format(TomlReader& root) {
  const int format = root.integer("format", {0, 1e6});
  if (!root.ok() || format == kRecipeFormat) return;
  std::string cause = "its format is ";
  append_exact(cause, format);
  if (format > kRecipeFormat) {
    root.fail(
        "format",
        "the recipe was made by a newer marey: " + cause + ", and this marey reads 1",
        "update marey");
  } else {
    root.fail("format", std::move(cause), "write format = 1");
  }
}

Result<TomlDocument> recipe_document(std::string_view text,
                                     const std::filesystem::path& name) {
  if (text.size() > recipe::kMaxRecipeBytes) {
    return bad_input(name.string(),
                     "the recipe is larger than 16 MiB",
                     "divide it: the result of one recipe can be the source of another");
  }
  return parse_toml(text, name.string(), kRecipePage);
}

}  // namespace

Result<EditRecipe> parse_edit_recipe(std::string_view text,
                                     const std::filesystem::path& name) {
  Result<TomlDocument> document = recipe_document(text, name);
  if (!document) return document.error();
  TomlReader root(*document);
  EditRecipe recipe;
  check_format(root);
  root.allow({"format", "name", "source", "op", "limits"});
  if (root.has("name")) recipe.name = read_recipe_name(root);
  read_sources(root, recipe);
  if (root.has("limits")) read_limits(root.table("limits"), recipe.limits);
  if (root.has("op")) read_ops(root, recipe);
  if (document->mistake) return mistake_of(*document, TomlKind::kEditRecipe);
  return recipe;
}

Result<EditRecipe> read_edit_recipe(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_edit_recipe(*text, path);
}

Result<EditOp> parse_edit_op(std::string_view text, const std::filesystem::path& name) {
  Result<TomlDocument> document = recipe_document(text, name);
  if (!document) return document.error();
  TomlReader root(*document);
  root.allow({"op"});
  std::vector<TomlReader> tables = root.tables("op");
  EditOp op;
  if (tables.size() == 1) {
    op = recipe::read_op(tables.front());
  } else {
    root.fail("op", "there is not exactly one [[op]]", "give one operation");
  }
  if (document->mistake) return *document->mistake;
  return op;
}

}  // namespace marey::recordings
