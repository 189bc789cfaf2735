// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/program/run_program.h"

namespace marey::testing {

/// A copy of the sample session that one test changes, in a folder that the destructor
/// removes. Uses the sample's videos and the tags that the fixture sample_once detected
/// in them, so that only changed videos are searched again.
class SpoiledSession {
 public:
  SpoiledSession();
  ~SpoiledSession();
  SpoiledSession(const SpoiledSession&) = delete;
  SpoiledSession& operator=(const SpoiledSession&) = delete;

  /// Replaces every `from` in session.toml. Throws std::logic_error when there is none:
  /// a test that spoils nothing tests nothing.
  void replace(const std::string& from, const std::string& to);

  /// Replaces every `from` in the table of one trial. Throws std::logic_error when there
  /// is none.
  void replace_in_trial(const std::string& trial,
                        const std::string& from,
                        const std::string& to);

  /// Gives a camera of a trial another video, made by the caller: the path to make it at.
  std::filesystem::path new_video(const std::string& trial, const std::string& camera);

  /// Returns the path of a video of the sample: sample_video("walk", "cam0").
  [[nodiscard]] static std::filesystem::path sample_video(const std::string& trial,
                                                          const std::string& camera);

  /// Runs a stage on it.
  [[nodiscard]] ProgramRun run(const std::string& stage = "process",
                               const std::vector<std::string>& more = {}) const;

  [[nodiscard]] std::filesystem::path file() const { return folder_ / "session.toml"; }
  [[nodiscard]] std::filesystem::path out() const { return folder_ / "out"; }

  /// Returns whether the run wrote this result.
  [[nodiscard]] bool has_result(const std::string& name) const;
  /// Returns the files in out() except detections: the results of the stages.
  [[nodiscard]] std::vector<std::string> results() const;

 private:
  void write() const;

  std::filesystem::path folder_;
  std::string text_;
};

}  // namespace marey::testing
