// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_patch.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "core/base/assert.h"
#include "core/base/in_quotes.h"
#include "recordings/base/toml_reader.h"
#include "recordings/edit/edit_recipe_file.h"

namespace marey::app {
namespace {

using OpKeysJson = nlohmann::ordered_json;
using PatchKind = live::OpsPatchStep::Kind;

constexpr const char* kPageText = "operation";

Error refused_patch(std::string cause, std::string next) {
  return bad_input("the change", std::move(cause), std::move(next));
}

/// Reads the operation of a step. A page may name only files that the recipe has.
Result<EditOp> patch_op(const live::OpsPatchStep& step,
                        const std::set<std::string>& avatars) {
  auto op = recordings::parse_edit_op(step.op_toml, kPageText);
  if (!op) {
    Error error = op.error();
    // The line is of a text that the user does not see.
    error.where = "the operation";
    return error;
  }
  const auto* retarget = std::get_if<RetargetOp>(&op->parameters);
  if (retarget != nullptr && !avatars.contains(retarget->avatar)) {
    return refused_patch("the recipe has no avatar " + in_quotes(retarget->avatar),
                         "add a retarget operation with this avatar to the recipe's "
                         "file, and open it again");
  }
  return op;
}

Status apply_step(const live::OpsPatchStep& step,
                  const std::set<std::string>& avatars,
                  std::vector<EditOp>& ops) {
  const auto count = static_cast<int>(ops.size());
  const int end = step.kind == PatchKind::kInsert ? count + 1 : count;
  if (step.index >= end || (step.kind == PatchKind::kMove && step.to >= count)) {
    return refused_patch("it names an operation that does not exist: the recipe has " +
                             std::to_string(count),
                         "reload the page");
  }
  const auto at = ops.begin() + step.index;
  switch (step.kind) {
    case PatchKind::kInsert:
    case PatchKind::kReplace: {
      auto op = patch_op(step, avatars);
      if (!op) return op.error();
      if (step.kind == PatchKind::kReplace) {
        *at = *std::move(op);
      } else {
        ops.insert(at, *std::move(op));
      }
      break;
    }
    case PatchKind::kRemove:
      ops.erase(at);
      break;
    case PatchKind::kMove: {
      EditOp moved = std::move(*at);
      ops.erase(at);
      ops.insert(ops.begin() + step.to, std::move(moved));
      break;
    }
    case PatchKind::kToggle:
      at->off = step.off;
      break;
  }
  return Done{};
}

// Recursive: the text of an operation has few levels.
// NOLINTNEXTLINE(misc-no-recursion)
OpKeysJson json_of(const recordings::TomlValue& value) {
  struct ToJson {
    OpKeysJson operator()(std::monostate /*date*/) const { return {}; }
    OpKeysJson operator()(bool v) const { return v; }
    OpKeysJson operator()(std::int64_t v) const { return v; }
    OpKeysJson operator()(double v) const { return v; }
    OpKeysJson operator()(const std::string& v) const { return v; }
    // NOLINTNEXTLINE(misc-no-recursion)
    OpKeysJson operator()(const std::vector<recordings::TomlValue>& list) const {
      OpKeysJson out = OpKeysJson::array();
      for (const auto& one : list) out.push_back(json_of(one));
      return out;
    }
    // NOLINTNEXTLINE(misc-no-recursion)
    OpKeysJson operator()(const std::vector<recordings::TomlEntry>& table) const {
      OpKeysJson out = OpKeysJson::object();
      for (const auto& entry : table) out[entry.key] = json_of(entry.value);
      return out;
    }
  };
  return std::visit(ToJson{}, value.content);
}

}  // namespace

std::set<std::string> avatars_of(const EditRecipe& recipe) {
  std::set<std::string> out;
  for (const EditOp& op : recipe.ops) {
    const auto* retarget = std::get_if<RetargetOp>(&op.parameters);
    if (retarget != nullptr) out.insert(retarget->avatar);
  }
  return out;
}

Result<EditRecipe> apply_patch(const EditRecipe& recipe,
                               const live::OpsPatch& patch,
                               const std::set<std::string>& avatars) {
  EditRecipe changed = recipe;
  for (const live::OpsPatchStep& step : patch) {
    if (const Status ok = apply_step(step, avatars, changed.ops); !ok) return ok.error();
  }
  auto read = recordings::parse_edit_recipe(recordings::edit_recipe_text(changed),
                                            "the changed recipe");
  return read;
}

std::string op_keys_json(const EditOp& op) {
  const auto document = recordings::parse_toml(recordings::edit_op_text(op), kPageText);
  MAREY_ASSERT(document);
  // A document of one list, "op", with one table.
  const OpKeysJson json = json_of(document->root);
  return json.at("op").at(0).dump(-1, ' ', false, OpKeysJson::error_handler_t::replace);
}

}  // namespace marey::app
