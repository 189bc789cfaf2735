// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/source_outcome.h"

#include <nlohmann/json.hpp>

namespace marey::app {
namespace {

using OutcomeJson = nlohmann::ordered_json;

bool read_word(const OutcomeJson& object, const char* key, std::string& out) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) return false;
  out = found->get<std::string>();
  return true;
}

bool read_flag(const OutcomeJson& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_boolean() && found->get<bool>();
}

OutcomeJson error_json(const Error& error) {
  return {{"code", static_cast<int>(error.code)},
          {"where", error.where},
          {"cause", error.cause},
          {"next", error.next}};
}

std::optional<Error> read_error(const OutcomeJson& object) {
  Error out;
  const auto code = object.find("code");
  if (code == object.end() || !code->is_number_integer()) return std::nullopt;
  const int number = code->get<int>();
  if (number < 0 || number > static_cast<int>(Errc::kDevice)) return std::nullopt;
  out.code = static_cast<Errc>(number);
  const bool is_whole = read_word(object, "where", out.where) &&
                        read_word(object, "cause", out.cause) &&
                        read_word(object, "next", out.next);
  return is_whole ? std::optional(out) : std::nullopt;
}

}  // namespace

std::string outcome_text(const SourceOutcome& outcome) {
  const OutcomeJson json = {
      {"name", outcome.name},
      {"source_id", outcome.source_id},
      {"clips_key", outcome.clips_key},
      {"failure", outcome.failure ? error_json(*outcome.failure) : OutcomeJson()},
      {"remarks", outcome.remarks},
      {"was_read", outcome.was_read},
      {"is_machine_failure", outcome.is_machine_failure}};
  return json.dump(-1, ' ', false, OutcomeJson::error_handler_t::replace);
}

std::optional<SourceOutcome> parse_outcome(std::string_view text) {
  const OutcomeJson root = OutcomeJson::parse(text, nullptr, false);
  if (!root.is_object()) return std::nullopt;
  SourceOutcome out;
  if (!read_word(root, "name", out.name) ||
      !read_word(root, "source_id", out.source_id) ||
      !read_word(root, "clips_key", out.clips_key)) {
    return std::nullopt;
  }
  const auto failure = root.find("failure");
  if (failure != root.end() && failure->is_object()) {
    out.failure = read_error(*failure);
    if (!out.failure) return std::nullopt;
  }
  const auto remarks = root.find("remarks");
  if (remarks != root.end() && remarks->is_array()) {
    for (const OutcomeJson& remark : *remarks) {
      if (remark.is_string()) out.remarks.push_back(remark.get<std::string>());
    }
  }
  out.was_read = read_flag(root, "was_read");
  out.is_machine_failure = read_flag(root, "is_machine_failure");
  return out;
}

}  // namespace marey::app
