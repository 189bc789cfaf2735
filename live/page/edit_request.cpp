// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/edit_request.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/in_quotes.h"
#include "live/page/request_members.h"

namespace marey::live {
namespace {

using EditJson = nlohmann::json;

constexpr std::size_t kMaxEditBytes = 16 * 1024;
constexpr std::size_t kMaxEditIdBytes = 64;
constexpr std::size_t kMaxKeyBytes = 64;
constexpr std::size_t kMaxSteps = 64;
constexpr int kMaxLevels = 6;

Error refused_edit(std::string cause) {
  return bad_input("message from the page", std::move(cause), "reload the page");
}

bool is_bare_key(std::string_view key) {
  constexpr std::string_view kLetters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !key.empty() && key.size() <= kMaxKeyBytes &&
         key.find_first_not_of(kLetters) == std::string_view::npos;
}

/// Writes the JSON of an operation as TOML. cause() describes a value that has no form in
/// TOML.
class OpText {
 public:
  /// Returns "[[op]]" and a line for each key.
  std::string table(const EditJson& op) {
    std::string out = "[[op]]\n";
    for (const auto& [key, value] : op.items()) {
      append_key(key, out);
      append(value, 1, out);
      out += '\n';
    }
    return out;
  }
  /// Returns the first problem; empty: none.
  [[nodiscard]] const std::string& cause() const { return cause_; }

 private:
  void fail(std::string cause) {
    if (cause_.empty()) cause_ = std::move(cause);
  }

  void append_key(const std::string& key, std::string& out) {
    if (!is_bare_key(key)) fail("the operation has the invalid key " + in_quotes(key));
    out += key;
    out += " = ";
  }

  // Recursive: six levels at most.
  // NOLINTNEXTLINE(misc-no-recursion)
  void append(const EditJson& value, int level, std::string& out) {
    if (!cause_.empty()) return;
    if (level > kMaxLevels) return fail("the operation has more than 6 levels");
    if (value.is_object()) {
      append_inline_table(value, level, out);
    } else if (value.is_array()) {
      out += '[';
      for (const EditJson& one : value) {
        append(one, level + 1, out);
        out += ", ";
      }
      out += ']';
    } else {
      append_scalar(value, out);
    }
  }

  // NOLINTNEXTLINE(misc-no-recursion)
  void append_inline_table(const EditJson& value, int level, std::string& out) {
    out += "{ ";
    bool is_first = true;
    for (const auto& [key, member] : value.items()) {
      if (!is_first) out += ", ";
      is_first = false;
      append_key(key, out);
      append(member, level + 1, out);
    }
    out += " }";
  }

  void append_scalar(const EditJson& value, std::string& out) {
    constexpr auto kMax =
        static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    if (value.is_null()) return fail("the operation has a value null");
    if (value.is_number_unsigned() && value.get<std::uint64_t>() > kMax) {
      return fail("the operation has a number that is too large");
    }
    // The escapes of JSON are those of TOML, which also needs one for DEL.
    for (const char c : value.dump()) {
      if (c == '\x7f') {
        out += "\\u007f";
      } else {
        out += c;
      }
    }
  }

  std::string cause_;
};

/// Reads the operation of a step.
std::string op_of(RequestMembers& step) {
  const EditJson* op = step.require("op");
  if (op == nullptr) return {};
  if (!op->is_object()) {
    step.fail("op", "an object");
    return {};
  }
  OpText text;
  std::string out = text.table(*op);
  if (!text.cause().empty()) step.fail(text.cause());
  return out;
}

OpsPatchStep step_of(RequestMembers& members) {
  using Kind = OpsPatchStep::Kind;
  constexpr std::array<std::pair<const char*, Kind>, 5> kKinds{
      {{"insert", Kind::kInsert},
       {"replace", Kind::kReplace},
       {"remove", Kind::kRemove},
       {"move", Kind::kMove},
       {"toggle", Kind::kToggle}}};
  OpsPatchStep step;
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& one) {
    return members.find(one.first) != nullptr;
  });
  if (kind == kKinds.end()) {
    members.fail("a step is none of insert, replace, remove, move and toggle");
    return step;
  }
  step.kind = kind->second;
  step.index = members.count(kind->first);
  const bool has_op = step.kind == Kind::kInsert || step.kind == Kind::kReplace;
  if (has_op) step.op_toml = op_of(members);
  if (step.kind == Kind::kMove) step.to = members.count("to");
  if (step.kind == Kind::kToggle) step.off = members.flag("off");
  return step;
}

OpsPatch patch_of(RequestMembers& members) {
  OpsPatch out;
  const EditJson* patch = members.require("ops_patch");
  if (patch == nullptr) return out;
  if (!patch->is_array() || patch->empty() || patch->size() > kMaxSteps) {
    members.fail("ops_patch", "a list of 1 to 64 steps");
    return out;
  }
  for (const EditJson& one : *patch) {
    if (!one.is_object()) {
      members.fail("a step of ops_patch is not an object");
      return out;
    }
    RequestMembers step(one);
    out.push_back(step_of(step));
    step.finish();
    if (!step.cause().empty()) members.fail(step.cause());
  }
  return out;
}

PreviewRequest preview_of(RequestMembers& members, bool has_patch) {
  PreviewRequest out;
  if (has_patch) out.patch = patch_of(members);
  out.until = members.optional_count("until");
  out.output = members.optional_count("output");
  out.span = members.optional_span("span");
  return out;
}

LoopsRequest loops_of(RequestMembers& members) {
  LoopsRequest out;
  out.until = members.optional_count("until");
  out.output = members.optional_count("output").value_or(0);
  out.min_period_s = members.optional_seconds("min_period_s");
  out.max_period_s = members.optional_seconds("max_period_s");
  out.map = members.optional_flag("map");
  return out;
}

JumpRequest jump_of(RequestMembers& members) {
  JumpRequest out;
  if (members.find("ops_patch") != nullptr) out.patch = patch_of(members);
  out.op = members.count("op");
  out.output = members.optional_count("output").value_or(0);
  return out;
}

/// Reads the members of all types of changes. Returns false if the type is unknown.
bool read_body(RequestMembers& members, EditPageRequest& out) {
  const std::string& type = out.type;
  if (type == "edit") {
    out.body = EditRequest{0, patch_of(members)};
  } else if (type == "undo") {
    out.body = UndoRequest{};
  } else if (type == "redo") {
    out.body = RedoRequest{};
  } else if (type == "preview" || type == "render") {
    out.body = preview_of(members, type == "preview");
  } else if (type == "loops") {
    out.body = loops_of(members);
  } else if (type == "jump") {
    out.body = jump_of(members);
  } else if (type == "export") {
    out.body = ExportRequest{};
  } else {
    return false;
  }
  const int base = members.count("base_revision");
  std::visit(
      [base](auto& body) {
        if constexpr (requires { body.base_revision; }) body.base_revision = base;
      },
      out.body);
  if (members.find("id") != nullptr) out.id = members.text("id", kMaxEditIdBytes);
  return true;
}

/// Reads a message that other pages send, too.
Result<EditPageRequest> common_request(std::string_view text, std::string type) {
  const auto request = read_page_request(text);
  if (!request) return request.error();
  EditPageRequest out;
  out.type = std::move(type);
  if (const auto* hello = std::get_if<HelloRequest>(&*request)) out.body = *hello;
  if (const auto* shown = std::get_if<ShownRequest>(&*request)) out.body = *shown;
  return out;
}

}  // namespace

Result<EditPageRequest> read_edit_request(std::string_view text) {
  if (text.size() > kMaxEditBytes) return refused_edit("it is larger than 16 kB");
  const EditJson message = EditJson::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) return refused_edit("it is not a JSON object");
  RequestMembers members(message);
  EditPageRequest out;
  out.type = members.text("type", kMaxEditIdBytes);
  if (out.type == "hello" || out.type == "shown") return common_request(text, out.type);
  const bool is_known = read_body(members, out);
  if (members.cause().empty() && !is_known) return refused_edit("its type is unknown");
  members.finish();
  if (!members.cause().empty()) return refused_edit(members.cause());
  return out;
}

}  // namespace marey::live
