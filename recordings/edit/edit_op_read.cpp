// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/edit_op_read.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/word_text.h"
#include "recordings/edit/edit_key_list.h"
#include "recordings/edit/edit_key_reader.h"
#include "recordings/edit/edit_limits.h"
#include "recordings/edit/edit_op_checks.h"

namespace marey::recordings::recipe {
namespace {

/// Returns "cut@1" for "cut".
std::string versioned(std::string_view op_name) {
  return with_number(std::string(op_name).append("@"), kEditOpVersion);
}

/// Stores that there is no operation with this name.
void fail_unknown_op(TomlReader& in, std::string_view op_name) {
  std::vector<std::string> words;
  for (const std::string_view known : edit_op_names()) words.push_back(versioned(known));
  in.fail("do",
          "there is no operation " + in_quotes(op_name),
          suggestion(versioned(op_name),
                     std::vector<std::string_view>(words.begin(), words.end())));
}

/// Returns the number after "@" in `word`; nullopt if it is none.
std::optional<int> version_of(std::string_view word) {
  const char* const last = word.data() + word.size();
  int version = 0;
  const auto [end, problem] = std::from_chars(word.data(), last, version);
  const bool is_plain = !word.empty() && word[0] >= '1' && word[0] <= '9';
  if (problem != std::errc{} || end != last || !is_plain) return std::nullopt;
  return version;
}

/// Reads `do`, "cut@1". Returns whether there is such an operation.
bool read_do(TomlReader& in, EditOp& op) {
  const std::string word = in.text("do");
  if (!in.ok()) return false;
  const std::size_t at = word.find('@');
  const std::string op_name = word.substr(0, at);
  const auto parameters = edit_op(op_name);
  if (!parameters) {
    fail_unknown_op(in, op_name);
    return false;
  }
  op.parameters = *parameters;
  const std::string next = "write do = \"" + versioned(op_name) + "\"";
  if (at == std::string::npos) {
    in.fail("do", in_quotes(word) + " has no version", next);
    return false;
  }
  const std::optional<int> version = version_of(std::string_view(word).substr(at + 1));
  if (!version) {
    in.fail("do", in_quotes(word) + " has no valid version", next);
  } else if (*version != kEditOpVersion) {
    in.fail("do",
            "this marey has no " + in_quotes(word) + ", only " +
                in_quotes(versioned(op_name)),
            "update marey, or " + next);
  } else {
    op.version = *version;
  }
  return in.ok();
}

/// Reads the groups into the order of kEditGroups.
void read_groups(TomlReader& in, EditOp& op) {
  for (const std::string& word : in.texts("groups")) {
    const std::optional<EditGroup> group = edit_group(word);
    if (!group) {
      std::vector<std::string_view> names;
      for (const EditGroup known : kEditGroups) names.push_back(name(known));
      in.fail("groups", "there is no group " + in_quotes(word), suggestion(word, names));
      return;
    }
    if (std::find(op.groups.begin(), op.groups.end(), *group) != op.groups.end()) {
      in.fail("groups", in_quotes(word) + " is listed twice", "remove one");
    }
    op.groups.push_back(*group);
  }
  if (op.groups.empty()) {
    in.fail("groups", "\"groups\" is empty", "name a group, or remove the key");
  }
  std::sort(op.groups.begin(), op.groups.end());
}

/// Reads the keys that all operations have.
void read_common_keys(TomlReader& in, EditOp& op) {
  if (in.has("off")) op.off = in.boolean("off");
  if (in.has("why")) op.why = in.text("why");
  KeyReader<EditSpan> span(in, op.span);
  visit_keys(span, KeysOf<EditSpan>{});
  for (const std::string& key : moment_keys("to")) {
    if (in.has(key)) check_span(in, key, op.span);
  }
  if (in.has("groups")) read_groups(in, op);
  if (in.has("blend_s")) op.blend_s = in.number("blend_s", kFade);
}

}  // namespace

EditOp read_op(TomlReader& in) {
  EditOp op;
  op.line = in.line();
  if (!read_do(in, op)) return op;
  in.set_name(versioned(name(op.parameters)));
  const std::vector<std::string> keys = edit_op_keys(op.parameters);
  in.allow(std::vector<std::string_view>(keys.begin(), keys.end()));
  read_common_keys(in, op);
  const auto read_keys = [&](auto& parameters) {
    KeyReader reader(in, parameters);
    visit_keys(reader, KeysOf<std::decay_t<decltype(parameters)>>{});
  };
  std::visit(read_keys, op.parameters);
  check_op_keys(in, op.parameters);
  return op;
}

}  // namespace marey::recordings::recipe
