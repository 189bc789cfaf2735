// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the cost of adapting a posture, the residual distance to the targets, and the
// change of the posture.
//
//   adapt_posture [--data FOLDER] [--json FILE] [QUESTION]...
//
// QUESTIONs: classes, crowd, reach, thesis, captured. All of them when none is named.
// FOLDER is that of the shared data (default: as configured), of which adapt/ and mocap/
// are read. All measures of a posture are computed here, from the posture, in double.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/adaptation/adapt_cases.h"
#include "benchmarks/adaptation/adapt_questions.h"
#include "benchmarks/parts/result_table.h"
#include "tests/support/program/paths.h"

namespace marey {
namespace {

constexpr std::array<std::string_view, 5> kQuestions{
    "classes", "crowd", "reach", "thesis", "captured"};

struct Arguments {
  std::filesystem::path data = marey::testing::shared_data();
  std::optional<std::filesystem::path> json;
  std::vector<std::string> questions;

  [[nodiscard]] bool asks(std::string_view question) const {
    if (questions.empty()) return true;
    for (const std::string& q : questions) {
      if (q == question) return true;
    }
    return false;
  }
};

[[noreturn]] void stop(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(2);
}

Arguments read_arguments(int argc, char** argv) {
  const char* usage =
      "usage: adapt_posture [--data FOLDER] [--json FILE] "
      "[classes|crowd|reach|thesis|captured]...";
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--data" || word == "--json") {
      if (++i == argc) stop(usage);
      if (word == "--data") arguments.data = argv[i];
      if (word == "--json") arguments.json = argv[i];
    } else if (std::find(kQuestions.begin(), kQuestions.end(), word) !=
               kQuestions.end()) {
      arguments.questions.emplace_back(word);
    } else {
      stop(usage);
    }
  }
  return arguments;
}

int measure(const Arguments& arguments) {
  const auto cases = read_cases(arguments.data / "adapt");
  if (!cases) stop(cases.error().message());
  std::vector<ResultTable> tables;
  const auto keep = [&](std::vector<ResultTable> more) {
    tables.insert(tables.end(), more.begin(), more.end());
  };
  if (arguments.asks("classes")) keep(measure_classes(*cases));
  if (arguments.asks("crowd")) keep(measure_crowd(*cases));
  if (arguments.asks("reach")) keep(measure_reach());
  if (arguments.asks("thesis")) keep(measure_thesis());
  if (arguments.asks("captured")) {
    const auto clips = read_clips(arguments.data / "mocap", ClipSet::kReaches);
    if (!clips) stop(clips.error().message());
    keep(measure_captured(*clips));
  }
  if (!arguments.json) return 0;
  const Status written = write_tables(*arguments.json, tables);
  if (!written) stop(written.error().message());
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::measure(marey::read_arguments(argc, argv));
}
