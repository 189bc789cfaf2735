// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/babel_file.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/in_quotes.h"
#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/nesting.h"

namespace marey::recordings {
namespace {

using BabelJson = nlohmann::json;

constexpr std::size_t kMaxBabelBytes = std::size_t{256} << 20;
constexpr const char* kOriginalBabel =
    "give a file of BABEL as it was released, or a table of labels (.csv)";

/// Returns one line of text, without blanks at its ends or several in a row.
std::string one_line_of(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (!is_blank) {
      out += c;
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  if (!out.empty() && out.back() == ' ') out.pop_back();
  return printable(out);
}

/// Returns the value of a key; null if the key is missing.
const BabelJson& value_of(const BabelJson& object, const char* key) {
  static const BabelJson kNull;
  const auto found = object.find(key);
  return found == object.end() ? kNull : *found;
}

/// Reads the sequences. Stores the first mistake.
class BabelReader {
 public:
  BabelReader(const std::string& file, const std::string& by) : file_(file), by_(by) {}

  void read(const BabelJson& root) {
    if (!root.is_object()) return fail("it is not an object of sequences");
    for (const auto& [name, sequence] : root.items()) {
      place_ = in_quotes(name);
      read_sequence(sequence);
      if (mistake_) return;
    }
  }

  [[nodiscard]] const std::optional<Error>& mistake() const { return mistake_; }
  [[nodiscard]] BabelLabels& labels() { return out_; }

 private:
  void read_sequence(const BabelJson& sequence) {
    if (!sequence.is_object()) return fail("it is not an object");
    const BabelJson& path = value_of(sequence, "feat_p");
    if (!path.is_string() || one_line_of(path.get<std::string>()).empty()) {
      return fail("it has no path of a motion, \"feat_p\"");
    }
    target_ = one_line_of(path.get<std::string>());
    known_.clear();
    read_annotation(value_of(sequence, "seq_ann"), false);
    read_annotation(value_of(sequence, "frame_ann"), true);
    read_annotations(value_of(sequence, "seq_anns"), false);
    read_annotations(value_of(sequence, "frame_anns"), true);
  }

  void read_annotations(const BabelJson& list, bool has_times) {
    if (list.is_null()) return;
    if (!list.is_array()) return fail("its annotations are not a list");
    for (const BabelJson& annotation : list) read_annotation(annotation, has_times);
  }

  void read_annotation(const BabelJson& annotation, bool has_times) {
    if (annotation.is_null() || mistake_) return;
    if (!annotation.is_object()) return fail("an annotation is not an object");
    const BabelJson& labels = value_of(annotation, "labels");
    if (labels.is_null()) return;
    if (!labels.is_array()) return fail("\"labels\" is not a list");
    for (const BabelJson& label : labels) {
      if (!label.is_object()) return fail("a label is not an object");
      read_label(label, has_times);
      if (mistake_) return;
    }
  }

  void read_label(const BabelJson& label, bool has_times) {
    LabelRow row;
    row.target = target_;
    row.by = by_;
    if (has_times) {
      row.start_s = time_of(label, "start_t");
      row.end_s = time_of(label, "end_t");
    }
    std::string text = text_of_key(label, "proc_label");
    if (text.empty()) text = text_of_key(label, "raw_label");
    const bool is_reversed = row.end_s && *row.end_s < row.start_s.value_or(0.0);
    if (text.empty() || is_reversed) {
      ++out_.left_out;
      return;
    }
    add(row, std::move(text));
    const BabelJson& categories = value_of(label, "act_cat");
    if (categories.is_null()) return;
    if (!categories.is_array()) return fail("\"act_cat\" is not a list");
    for (const BabelJson& category : categories) {
      if (!category.is_string()) return fail("a category is not text");
      const std::string word = one_line_of(category.get<std::string>());
      if (!word.empty()) add(row, "act_cat:" + word);
    }
  }

  void add(LabelRow row, std::string text) {
    if (!known_.insert({row.start_s, row.end_s, text}).second) return;
    row.text = std::move(text);
    out_.rows.push_back(std::move(row));
  }

  std::optional<double> time_of(const BabelJson& label, const char* key) {
    const BabelJson& value = value_of(label, key);
    if (value.is_null()) return std::nullopt;
    if (value.is_number()) return std::max(value.get<double>(), 0.0);
    fail("\"" + std::string(key) + "\" is not a number");
    return std::nullopt;
  }

  std::string text_of_key(const BabelJson& label, const char* key) {
    const BabelJson& value = value_of(label, key);
    if (value.is_string()) return one_line_of(value.get<std::string>());
    if (!value.is_null()) fail("\"" + std::string(key) + "\" is not text");
    return {};
  }

  void fail(std::string cause) {
    if (mistake_) return;
    mistake_ = bad_input(place_.empty() ? file_ : file_ + ": sequence " + place_,
                         std::move(cause),
                         kOriginalBabel);
  }

  const std::string& file_;
  const std::string& by_;
  std::string place_;
  std::string target_;
  /// Labels of the sequence.
  std::set<std::tuple<std::optional<double>, std::optional<double>, std::string>> known_;
  BabelLabels out_;
  std::optional<Error> mistake_ = std::nullopt;
};

}  // namespace

Result<BabelLabels> parse_babel(std::string_view text,
                                const std::string& file,
                                const std::string& by) {
  if (text.size() > kMaxBabelBytes) {
    return bad_input(file, "it has more than 256 MiB", kOriginalBabel);
  }
  if (json_nests_too_deep(text)) {
    return bad_input(file, "it nests too deep for labels", kOriginalBabel);
  }
  const BabelJson root = BabelJson::parse(text, nullptr, false);
  if (root.is_discarded()) return bad_input(file, "it is not JSON", kOriginalBabel);
  BabelReader reader(file, by);
  reader.read(root);
  if (reader.mistake()) return *reader.mistake();
  return std::move(reader.labels());
}

Result<BabelLabels> read_babel(const std::filesystem::path& path, const std::string& by) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return parse_babel(*text, path.string(), by);
}

}  // namespace marey::recordings
