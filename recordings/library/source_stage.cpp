// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/source_stage.h"

#include <utility>

#include "recordings/base/nesting.h"
#include "recordings/library/clip_record_json.h"

namespace marey::recordings {
namespace {

using StageJson = nlohmann::ordered_json;

StageJson records_json(const std::vector<ClipRecord>& records) {
  StageJson out = StageJson::array();
  for (const ClipRecord& record : records) out.push_back(clip_record_json(record));
  return out;
}

std::optional<std::vector<ClipRecord>> read_records(const StageJson& list) {
  if (!list.is_array()) return std::nullopt;
  std::vector<ClipRecord> out;
  std::optional<Error> mistake;
  for (const StageJson& item : list) {
    out.push_back(read_clip_record(item, "", mistake));
    if (mistake) return std::nullopt;
  }
  return out;
}

std::string stage_dump(const StageJson& json) {
  return json.dump(1, ' ', false, StageJson::error_handler_t::replace) + "\n";
}

StageJson parse_stage_json(std::string_view text) {
  if (json_nests_too_deep(text)) return {};
  StageJson root = StageJson::parse(text, nullptr, false);
  return root.is_discarded() ? StageJson() : root;
}

std::string text_or_empty(const StageJson& object, const char* key) {
  const auto found = object.find(key);
  const bool is_text = found != object.end() && found->is_string();
  return is_text ? found->get<std::string>() : std::string();
}

}  // namespace

std::string source_stage_text(const SourceStage& stage) {
  StageJson failure;
  if (stage.failure) {
    failure = {{"where", stage.failure->where},
               {"cause", stage.failure->cause},
               {"next", stage.failure->next}};
  }
  return stage_dump({{"bodies", records_json(stage.bodies)},
                     {"motion_bytes", stage.motion_bytes},
                     {"remarks", stage.remarks},
                     {"failure", failure}});
}

std::optional<SourceStage> parse_source_stage(std::string_view text) {
  const StageJson root = parse_stage_json(text);
  if (!root.is_object() || !root.contains("bodies") || !root.contains("remarks") ||
      !root.contains("failure") || !root.contains("motion_bytes") ||
      !root.at("motion_bytes").is_array()) {
    return std::nullopt;
  }
  SourceStage out;
  auto bodies = read_records(root.at("bodies"));
  if (!bodies || !root.at("remarks").is_array()) return std::nullopt;
  out.bodies = std::move(*bodies);
  for (const StageJson& bytes : root.at("motion_bytes")) {
    if (!bytes.is_number_unsigned()) return std::nullopt;
    out.motion_bytes.push_back(bytes.get<std::uint64_t>());
  }
  if (out.motion_bytes.size() != out.bodies.size()) return std::nullopt;
  for (const StageJson& remark : root.at("remarks")) {
    if (!remark.is_string()) return std::nullopt;
    out.remarks.push_back(remark.get<std::string>());
  }
  const StageJson& failure = root.at("failure");
  if (failure.is_object()) {
    out.failure = bad_input(text_or_empty(failure, "where"),
                            text_or_empty(failure, "cause"),
                            text_or_empty(failure, "next"));
  }
  return out;
}

std::string clip_records_text(const std::vector<ClipRecord>& records) {
  return stage_dump(records_json(records));
}

std::optional<std::vector<ClipRecord>> parse_clip_records(std::string_view text) {
  return read_records(parse_stage_json(text));
}

}  // namespace marey::recordings
