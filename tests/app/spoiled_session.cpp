// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/spoiled_session.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/files/text_file.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kSample = marey::testing::sample_session();
const fs::path kGoodRun = marey::testing::sample_results() / "once";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t found = text.find(from);
  if (found == std::string::npos) {
    throw std::logic_error("the session does not say \"" + from + "\"");
  }
  for (; found != std::string::npos; found = text.find(from, found + to.size())) {
    text.replace(found, from.size(), to);
  }
  return text;
}

}  // namespace

SpoiledSession::SpoiledSession() : text_(read_text(kSample / "session.toml")) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  folder_ =
      fs::temp_directory_path() / ("marey-" + std::string(test->test_suite_name()) + "." +
                                   test->name() + "-" + std::to_string(getpid()));
  fs::remove_all(folder_);
  fs::create_directories(out());
  replace("media = \".\"", "media = \"" + kSample.string() + "\"");
  for (const auto& entry : fs::directory_iterator(kGoodRun)) {
    const fs::path found = entry.path() / "detections";
    if (!fs::exists(found)) continue;
    const fs::path place = out() / entry.path().filename() / "detections";
    fs::create_directories(place);
    fs::copy(found, place);
  }
}

SpoiledSession::~SpoiledSession() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void SpoiledSession::replace(const std::string& from, const std::string& to) {
  text_ = replaced(text_, from, to);
  write();
}

void SpoiledSession::replace_in_trial(const std::string& trial,
                                      const std::string& from,
                                      const std::string& to) {
  const std::size_t start = text_.find("name = \"" + trial + "\"");
  if (start == std::string::npos) throw std::logic_error("no trial " + trial);
  const std::size_t end = std::min(text_.find("[[trial]]", start), text_.size());
  text_ = text_.substr(0, start) + replaced(text_.substr(start, end - start), from, to) +
          text_.substr(end);
  write();
}

fs::path SpoiledSession::new_video(const std::string& trial, const std::string& camera) {
  const fs::path place = folder_ / (trial + "-" + camera + ".mp4");
  std::string from = camera + " = \"";
  from.append(fs::relative(sample_video(trial, camera), kSample).string()).append("\"");
  replace_in_trial(trial, from, camera + " = \"" + place.string() + "\"");
  return place;
}

fs::path SpoiledSession::sample_video(const std::string& trial,
                                      const std::string& camera) {
  return kSample / (trial == "floor" ? "calib" : trial) / (camera + ".mp4");
}

ProgramRun SpoiledSession::run(const std::string& stage,
                               const std::vector<std::string>& more) const {
  std::vector<std::string> arguments{
      stage, file().string(), "--out", out().string(), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(marey::testing::program(), arguments);
}

bool SpoiledSession::has_result(const std::string& name) const {
  return fs::exists(out() / name);
}

std::vector<std::string> SpoiledSession::results() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(out())) {
    if (!entry.is_regular_file()) continue;
    const fs::path name = fs::relative(entry.path(), out());
    const bool cache = name.parent_path().filename() == "detections";
    if (!cache || name.extension() != ".csv") names.push_back(name.string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void SpoiledSession::write() const {
  std::ofstream(file(), std::ios::binary) << text_;
}

}  // namespace marey::testing
