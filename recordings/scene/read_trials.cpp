// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_trials.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/edit/edit_value_keys.h"
#include "recordings/scene/scene_limits.h"
#include "recordings/scene/scene_values.h"

namespace marey::recordings {
namespace {

constexpr std::array<std::string_view, 3> kOrderWords{"listed", "shuffled", "blocks"};

Limits limits_of(ThrowParameter parameter) {
  switch (parameter) {
    case ThrowParameter::kPlaceLeft:
    case ThrowParameter::kPlaceUp:
    case ThrowParameter::kPlaceForward:
      return stage::kOffset;
    case ThrowParameter::kAzimuth:
      return stage::kAzimuth;
    case ThrowParameter::kElevation:
      return stage::kElevation;
    case ThrowParameter::kSpeed:
      return stage::kSpeed;
    case ThrowParameter::kRelease:
      return stage::kTime;
    case ThrowParameter::kCaptured:
      break;
  }
  return {0.0, 0.0};
}

void append_trial(TomlReader& in, const ThrowTrial& trial, TrialList& list) {
  const auto is_same = [&](const ThrowTrial& other) {
    return other.parameter == trial.parameter && other.value == trial.value;
  };
  if (std::any_of(list.trials.begin(), list.trials.end(), is_same)) {
    std::string cause(kThrowParameters[static_cast<std::size_t>(trial.parameter)]);
    if (trial.parameter != ThrowParameter::kCaptured) {
      cause += " = ";
      append_exact(cause, trial.value);
    }
    in.fail(in.has("values") ? "values" : "parameter",
            "the throw " + in_quotes(cause) + " is listed twice",
            "list it once, and set \"repeat\"");
  }
  list.trials.push_back(trial);
}

void read_throws(TomlReader& in, TrialList& list) {
  in.allow({"parameter", "values", "repeat"});
  ThrowTrial trial;
  trial.parameter = static_cast<ThrowParameter>(
      stage::read_choice_of(in, "parameter", kThrowParameters));
  if (in.has("repeat")) trial.repeat = in.integer("repeat", stage::kRepeat);
  if (!in.ok()) return;
  if (trial.parameter == ThrowParameter::kCaptured) {
    if (in.has("values")) {
      in.fail("values", "\"captured\" has no values", "remove \"values\"");
    }
    append_trial(in, trial, list);
    return;
  }
  const std::size_t count = in.count("values");
  const std::vector<double> values =
      recipe::read_numbers(in, "values", count, limits_of(trial.parameter));
  if (count == 0) in.fail("values", "\"values\" is empty", "give one value or more");
  for (const double value : values) {
    if (!in.ok() || list.trials.size() > stage::kMaxThrows) return;
    trial.value = value;
    append_trial(in, trial, list);
  }
}

std::size_t count_throws(const TrialList& list) {
  std::size_t count = 0;
  for (const ThrowTrial& trial : list.trials) {
    count += static_cast<std::size_t>(trial.repeat);
  }
  return count;
}

}  // namespace

Result<TrialList> parse_trials(std::string_view text, const std::string& file) {
  if (text.size() > stage::kMaxSceneBytes) {
    return bad_input(file, "the list is larger than 4 MiB", "divide the study");
  }
  Result<TomlDocument> document = parse_toml(text, file, "trials.md");
  if (!document) return document.error();
  TomlReader root(*document);
  root.allow({"format", "name", "seed", "order", "throw"});
  (void)root.integer("format", {1, 1});
  TrialList list;
  if (root.has("name")) list.name = recipe::read_line(root, "name", stage::kMaxIdBytes);
  list.seed = static_cast<std::uint64_t>(root.integer("seed", stage::kSeed));
  stage::read_word(root, "order", list.order, kOrderWords);
  stage::check_count(root, "throw", stage::kMaxTables);
  for (TomlReader& table : root.tables("throw")) {
    read_throws(table, list);
    if (!root.ok()) break;
  }
  if (list.trials.empty()) {
    root.fail("", "there is no throw in it", "add [[throw]] with a parameter");
  }
  if (count_throws(list) > stage::kMaxThrows) {
    root.fail("throw",
              "the study has more than 10000 throws",
              "reduce the values or their \"repeat\"");
  }
  if (document->mistake) return mistake_of(*document, TomlKind::kTrials);
  return list;
}

Result<TrialList> read_trials(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_trials(*text, path.string());
}

}  // namespace marey::recordings
