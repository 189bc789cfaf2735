// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/nesting.h"
#include "recordings/base/other_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/edit/annotations_check.h"
#include "recordings/edit/annotations_file.h"

namespace marey::recordings {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxAnnotationBytes = std::size_t{256} << 20;
constexpr const char* kSeeAnnotations = "write it as docs/formats/edit_recipe.md shows";

/// Reads the JSON tree. Stores the first mistake; values read after it are empty.
class AnnotationsReader {
 public:
  explicit AnnotationsReader(std::string file) : file_(std::move(file)) {}

  void fail(const std::string& where, std::string cause, std::string next) {
    if (mistake_) return;
    mistake_ = bad_input(
        where.empty() ? file_ : file_ + ": " + where, std::move(cause), std::move(next));
  }
  [[nodiscard]] const std::optional<Error>& mistake() const { return mistake_; }

  /// Checks that `object` is an object with all of these keys and no others.
  [[nodiscard]] bool has_keys(const Json& object,
                              const std::string& where,
                              std::initializer_list<std::string_view> keys);
  [[nodiscard]] const Json* list(const Json& object, const char* key);
  [[nodiscard]] std::string text(const Json& object,
                                 const std::string& where,
                                 const char* key);
  [[nodiscard]] double number(const Json& value, const std::string& where);
  void read_format(const Json& root);
  void read_note(const Json& item, const std::string& where, Annotations& out);
  void read_curve(const Json& item, const std::string& where, Annotations& out);

 private:
  std::string file_;
  std::optional<Error> mistake_;
};

bool AnnotationsReader::has_keys(const Json& object,
                                 const std::string& where,
                                 std::initializer_list<std::string_view> keys) {
  if (!object.is_object()) fail(where, "it is not an object", kSeeAnnotations);
  if (mistake_) return false;
  for (const auto& [key, value] : object.items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    fail(where,
         "unknown key " + in_quotes(key),
         suggestion(key, std::span(keys.begin(), keys.size())));
  }
  for (const std::string_view key : keys) {
    if (object.contains(key)) continue;
    fail(where, "the key " + in_quotes(key) + " is missing", kSeeAnnotations);
  }
  return !mistake_;
}

const Json* AnnotationsReader::list(const Json& object, const char* key) {
  const Json& value = object.at(key);
  if (value.is_array()) return &value;
  fail("", in_quotes(key) + " is not a list", kSeeAnnotations);
  return nullptr;
}

std::string AnnotationsReader::text(const Json& object,
                                    const std::string& where,
                                    const char* key) {
  const Json& value = object.at(key);
  if (value.is_string()) return value.get<std::string>();
  fail(where, in_quotes(key) + " is not text in quotes", kSeeAnnotations);
  return {};
}

double AnnotationsReader::number(const Json& value, const std::string& where) {
  if (value.is_number()) return value.get<double>();
  fail(where, "it is not a number", kSeeAnnotations);
  return 0.0;
}

void AnnotationsReader::read_format(const Json& root) {
  const Json& format = root.at("format");
  if (format == Json(1)) return;
  const bool is_newer = format.is_number_integer() && format > Json(1);
  if (is_newer) {
    fail("format", "the file was made by a newer marey", "update marey");
  } else {
    fail("format", "the format is not supported", "write \"format\": 1");
  }
}

void AnnotationsReader::read_note(const Json& item,
                                  const std::string& where,
                                  Annotations& out) {
  if (!has_keys(item, where, {"text", "start_s", "end_s"})) return;
  out.notes.push_back({text(item, where, "text"),
                       number(item.at("start_s"), where + ".start_s"),
                       number(item.at("end_s"), where + ".end_s")});
}

void AnnotationsReader::read_curve(const Json& item,
                                   const std::string& where,
                                   Annotations& out) {
  if (!has_keys(item, where, {"name", "values"})) return;
  ValueCurve& curve = out.curves.emplace_back();
  curve.name = text(item, where, "name");
  const Json& values = item.at("values");
  if (!values.is_array()) fail(where, "\"values\" is not a list", kSeeAnnotations);
  if (mistake_) return;
  for (const Json& value : values) curve.values.push_back(number(value, where));
}

/// Returns the tree of `text`, or the parser's message with its line.
Result<Json> annotations_json(std::string_view text, const std::string& file) {
  if (text.size() > kMaxAnnotationBytes) {
    return bad_input(
        file, "the file is larger than 256 MiB", "divide the motion by split@1");
  }
  if (text.empty()) return empty_file(file);
  if (json_nests_too_deep(text) || json_has_too_many_keys(text)) {
    return bad_input(file, "it nests too deep or has too many keys", kSeeAnnotations);
  }
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& problem) {
    const std::size_t end = std::min(problem.byte, text.size());
    const auto line =
        1 +
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    return bad_input(file_and_line(file, static_cast<int>(line)),
                     "not valid JSON",
                     "correct this line, or write the file again by marey edit");
  } catch (const Json::exception&) {
    return bad_input(file, "a number is too large", "give finite numbers");
  }
}

}  // namespace

Result<Annotations> parse_annotations(std::string_view text,
                                      const std::filesystem::path& name) {
  const std::string file = name.string();
  const Result<Json> json = annotations_json(text, file);
  if (!json) return json.error();
  AnnotationsReader in(file);
  Annotations out;
  // A newer format may have other keys.
  if (json->is_object() && json->contains("format")) in.read_format(*json);
  if (!in.mistake() && in.has_keys(*json, "", {"format", "notes", "curves"})) {
    const Json* const notes = in.list(*json, "notes");
    const Json* const curves = in.list(*json, "curves");
    for (std::size_t k = 0; !in.mistake() && k < notes->size(); ++k) {
      in.read_note((*notes)[k], "notes[" + std::to_string(k) + "]", out);
    }
    for (std::size_t k = 0; !in.mistake() && k < curves->size(); ++k) {
      in.read_curve((*curves)[k], "curves[" + std::to_string(k) + "]", out);
    }
  }
  if (in.mistake()) return *in.mistake();
  if (const Status ok = check_annotations(out, file); !ok) return ok.error();
  std::stable_sort(
      out.notes.begin(), out.notes.end(), [](const Annotation& a, const Annotation& b) {
        return std::tie(a.start_s, a.text) < std::tie(b.start_s, b.text);
      });
  return out;
}

Result<Annotations> read_annotations(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_annotations(*text, path);
}

}  // namespace marey::recordings
