// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/live/live_session.h"
#include "app/live_chain/live_chain.h"
#include "core/base/result.h"
#include "recordings/takes/live_take.h"

namespace marey::app {

/// Records a take of a live run. A take is a folder with copies of the cameras, the
/// subject and the avatars, and live.sqlite with every instant. Its replay gives the same
/// bytes, also after the folder is moved. Data older than half a second survives a crash
/// of the process. A separate thread waits for the disk.
class LiveRecorder {
 public:
  /// Creates the folder and writes the constant data of a run with this body and these
  /// settings. Errors: the folder already has a take, or an avatar's format consists of
  /// several files (kBadInput); the disk (kDevice). After an error, the files it created
  /// are removed.
  [[nodiscard]] static Result<std::unique_ptr<LiveRecorder>> create(
      const std::filesystem::path& folder,
      const OpenedLive& live,
      const Body& body,
      const LiveSettings& settings);
  ~LiveRecorder();

  /// Adds an instant. Does not wait for the disk. After an error nothing more is
  /// recorded.
  void add(const LiveInstant& instant,
           const LiveRequests& requests,
           const LiveResult& result);
  /// Adds an instant of the lead-in, which a replay needs to reach the initial state of
  /// the take (see LiveTakes).
  void add_lead_in(const LiveInstant& instant, const LiveRequests& requests);
  /// Returns the error that ended the recording early, if any. The run itself continues.
  [[nodiscard]] std::optional<Error> trouble() const;
  /// Writes the remaining data. Errors: trouble(), or the disk.
  [[nodiscard]] Status finish();
  /// Removes all files that create() made. Called in place of finish(); no call may
  /// follow.
  void discard();

 private:
  explicit LiveRecorder(recordings::LiveTakeWriter writer);
  void keep();
  void commit_often(const std::stop_token& stop);
  void end_commits();

  std::filesystem::path folder_;
  bool was_there_ = false;  ///< The folder existed before create().
  recordings::LiveTakeWriter writer_;
  recordings::LiveTakeInstant instant_;
  mutable std::mutex mutex_;
  std::optional<Error> trouble_;
  std::jthread committer_;
};

}  // namespace marey::app
