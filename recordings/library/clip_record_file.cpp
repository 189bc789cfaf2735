// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/clip_record_file.h"

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/assert.h"
#include "core/base/in_quotes.h"
#include "recordings/base/nesting.h"
#include "recordings/base/sha256.h"
#include "recordings/library/enum_named.h"

namespace marey::recordings {
namespace {

using RecordJson = nlohmann::ordered_json;

constexpr int kRecordFormat = 1;
constexpr const char* kBuildAgain = "build the library again: marey library build";

RecordJson frames_json(const FrameRange& frames) {
  return RecordJson::array({frames.first, frames.last});
}

RecordJson provenance_json(const Provenance& from) {
  return {{"source_id", from.source_id},
          {"path", from.path},
          {"kind", from.kind},
          {"licence", from.licence},
          {"origin", from.origin},
          {"commit", from.commit},
          {"subject", from.subject},
          {"attribution", from.attribution}};
}

RecordJson figure_json(const ClipFigure& figure) {
  RecordJson out = {{"name", figure.name}, {"value", figure.value}};
  out["verdict"] =
      figure.verdict ? RecordJson(std::string(name(*figure.verdict))) : RecordJson();
  out["joint"] = figure.joint;
  out["frames"] = figure.frames ? frames_json(*figure.frames) : RecordJson();
  return out;
}

RecordJson problem_json(const ClipProblem& problem) {
  return {{"frames", frames_json(problem.frames)},
          {"kind", problem.kind},
          {"joint", problem.joint},
          {"value", problem.value}};
}

RecordJson label_json(const ClipLabel& label) {
  return {{"start_s", label.start_s},
          {"end_s", label.end_s},
          {"text", label.text},
          {"by", label.by},
          {"certainty", label.certainty}};
}

template <class Item, class ToJson>
RecordJson list_json(const std::vector<Item>& items, const ToJson& to_json) {
  RecordJson out = RecordJson::array();
  for (const Item& item : items) out.push_back(to_json(item));
  return out;
}

/// Reads one object of the tree. Stores the first mistake; values after it are empty.
class RecordReader {
 public:
  RecordReader(const std::string& file, std::optional<Error>& mistake)
      : file_(file), mistake_(mistake) {}

  /// Checks that `object` has all of these keys and no others.
  bool allow(const RecordJson& object, std::initializer_list<const char*> keys) {
    if (!object.is_object()) return fail("", "it is not an object");
    for (const char* key : keys) {
      if (!object.contains(key)) return fail(key, "the key is missing");
    }
    if (object.size() != keys.size()) return fail("", "it has unknown keys");
    return !mistake_;
  }

  std::string text(const RecordJson& object, const char* key) {
    const RecordJson& value = object.at(key);
    if (value.is_string()) return value.get<std::string>();
    fail(key, "it is not a text");
    return {};
  }

  double number(const RecordJson& object, const char* key) {
    const RecordJson& value = object.at(key);
    if (value.is_number()) return value.get<double>();
    fail(key, "it is not a number");
    return 0.0;
  }

  int integer(const RecordJson& value, const char* key) {
    constexpr auto kMax = std::numeric_limits<int>::max();
    if (value.is_number_integer() && value >= -kMax && value <= kMax) {
      return value.get<int>();
    }
    fail(key, "it is not a whole number");
    return 0;
  }

  FrameRange frames(const RecordJson& value, const char* key) {
    if (!value.is_array() || value.size() != 2) {
      fail(key, "it is not a pair of frames");
      return {};
    }
    return {integer(value[0], key), integer(value[1], key)};
  }

  template <class Enum>
  Enum choice(const RecordJson& value, const char* key) {
    if (value.is_string()) {
      if (const auto found = enum_named<Enum>(value.get<std::string>())) return *found;
    }
    fail(key, "it is none of the allowed words");
    return Enum{};
  }

  /// Calls `read` with each object of a list.
  template <class Read>
  void list(const RecordJson& object, const char* key, const Read& read) {
    const RecordJson& value = object.at(key);
    if (!value.is_array()) fail(key, "it is not a list");
    if (mistake_) return;
    for (const RecordJson& item : value) {
      read(item);
      if (mistake_) return;
    }
  }

  bool fail(const std::string& key, std::string cause) {
    if (!mistake_) {
      mistake_ = bad_input(key.empty() ? file_ : file_ + ": " + in_quotes(key),
                           std::move(cause),
                           kBuildAgain);
    }
    return false;
  }

 private:
  const std::string& file_;
  std::optional<Error>& mistake_;
};

Provenance read_provenance(RecordReader& in, const RecordJson& object) {
  if (!in.allow(object,
                {"source_id",
                 "path",
                 "kind",
                 "licence",
                 "origin",
                 "commit",
                 "subject",
                 "attribution"})) {
    return {};
  }
  return {in.text(object, "source_id"),
          in.text(object, "path"),
          in.text(object, "kind"),
          in.text(object, "licence"),
          in.text(object, "origin"),
          in.text(object, "commit"),
          in.text(object, "subject"),
          in.text(object, "attribution")};
}

void read_figure(RecordReader& in, const RecordJson& object, ClipRecord& out) {
  if (!in.allow(object, {"name", "value", "verdict", "joint", "frames"})) return;
  ClipFigure& figure = out.figures.emplace_back();
  figure.name = in.text(object, "name");
  figure.value = in.number(object, "value");
  if (!object.at("verdict").is_null()) {
    figure.verdict = in.choice<Verdict>(object.at("verdict"), "verdict");
  }
  figure.joint = in.text(object, "joint");
  if (!object.at("frames").is_null()) {
    figure.frames = in.frames(object.at("frames"), "frames");
  }
}

void read_lists(RecordReader& in, const RecordJson& root, ClipRecord& out) {
  in.list(root, "figures", [&](const RecordJson& item) { read_figure(in, item, out); });
  in.list(root, "problems", [&](const RecordJson& item) {
    if (!in.allow(item, {"frames", "kind", "joint", "value"})) return;
    out.problems.push_back({in.frames(item.at("frames"), "frames"),
                            in.text(item, "kind"),
                            in.text(item, "joint"),
                            in.number(item, "value")});
  });
  in.list(root, "labels", [&](const RecordJson& item) {
    if (!in.allow(item, {"start_s", "end_s", "text", "by", "certainty"})) return;
    out.labels.push_back({in.number(item, "start_s"),
                          in.number(item, "end_s"),
                          in.text(item, "text"),
                          in.text(item, "by"),
                          in.number(item, "certainty")});
  });
  in.list(root, "events", [&](const RecordJson& item) {
    if (!in.allow(item, {"frame", "name"})) return;
    out.events.push_back({in.integer(item.at("frame"), "frame"), in.text(item, "name")});
  });
}

ClipRecord read_record(RecordReader& in, const RecordJson& root) {
  ClipRecord out;
  if (!in.allow(root,
                {"format",
                 "clip_id",
                 "object_key",
                 "name",
                 "provenance",
                 "body",
                 "frames",
                 "rate_hz",
                 "rate_by",
                 "quality",
                 "figures",
                 "problems",
                 "labels",
                 "events",
                 "split",
                 "duplicate_of",
                 "mirror_of"})) {
    return out;
  }
  if (root.at("format") != RecordJson(kRecordFormat)) {
    in.fail("format", "another version of marey wrote it");
    return out;
  }
  out.clip_id = in.text(root, "clip_id");
  out.object_key = in.text(root, "object_key");
  out.name = in.text(root, "name");
  out.provenance = read_provenance(in, root.at("provenance"));
  out.body = in.text(root, "body");
  const FrameRange frames = in.frames(root.at("frames"), "frames");
  out.first_frame = frames.first;
  out.last_frame = frames.last;
  out.rate_hz = in.number(root, "rate_hz");
  out.rate_by = in.choice<RateBasis>(root.at("rate_by"), "rate_by");
  out.quality = in.choice<Verdict>(root.at("quality"), "quality");
  read_lists(in, root, out);
  out.split = in.text(root, "split");
  out.duplicate_of = in.text(root, "duplicate_of");
  out.mirror_of = in.text(root, "mirror_of");
  return out;
}

/// Appends a part of a key with its size, so that parts cannot be confused.
void add_part(std::string& text, std::string_view part) {
  text += std::to_string(part.size());
  text += ':';
  text += part;
}

}  // namespace

std::string clip_record_text(const ClipRecord& record) {
  const RecordJson json = {
      {"format", kRecordFormat},
      {"clip_id", record.clip_id},
      {"object_key", record.object_key},
      {"name", record.name},
      {"provenance", provenance_json(record.provenance)},
      {"body", record.body},
      {"frames", RecordJson::array({record.first_frame, record.last_frame})},
      {"rate_hz", record.rate_hz},
      {"rate_by", name(record.rate_by)},
      {"quality", name(record.quality)},
      {"figures", list_json(record.figures, figure_json)},
      {"problems", list_json(record.problems, problem_json)},
      {"labels", list_json(record.labels, label_json)},
      {"events",
       list_json(record.events,
                 [](const ClipEvent& event) {
                   return RecordJson{{"frame", event.frame}, {"name", event.name}};
                 })},
      {"split", record.split},
      {"duplicate_of", record.duplicate_of},
      {"mirror_of", record.mirror_of}};
  return json.dump(1, ' ', false, RecordJson::error_handler_t::replace) + "\n";
}

Result<ClipRecord> parse_clip_record(std::string_view text, const std::string& file) {
  if (json_nests_too_deep(text) || json_has_too_many_keys(text)) {
    return bad_input(file, "it is no record of a clip", kBuildAgain);
  }
  const RecordJson root = RecordJson::parse(text, nullptr, false);
  if (root.is_discarded()) return bad_input(file, "it is not JSON", kBuildAgain);
  std::optional<Error> mistake;
  RecordReader in(file, mistake);
  ClipRecord out = read_record(in, root);
  if (mistake) return *mistake;
  return out;
}

std::string clip_id_of(const std::string& source_id,
                       const std::string& body,
                       int first_frame,
                       int last_frame) {
  constexpr std::size_t kDigits = 16;
  std::string text;
  add_part(text, source_id);
  add_part(text, body);
  add_part(text, std::to_string(first_frame));
  add_part(text, std::to_string(last_frame));
  return sha256(text).substr(0, kDigits);
}

std::string stage_key(const std::string& source_id,
                      std::string_view stage,
                      int version,
                      std::string_view options,
                      std::string_view before) {
  std::string text;
  add_part(text, source_id);
  add_part(text, stage);
  add_part(text, std::to_string(version));
  add_part(text, options);
  add_part(text, before);
  return sha256(text);
}

std::filesystem::path object_path(const std::string& key, std::string_view extension) {
  constexpr std::size_t kKeyDigits = 64;
  MAREY_ASSERT(key.size() == kKeyDigits);
  return std::filesystem::path("objects") / key.substr(0, 2) /
         (key.substr(2) + std::string(extension));
}

}  // namespace marey::recordings
