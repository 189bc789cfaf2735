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

/// The take of a live run: a folder with the cameras, the subject and the avatars as they
/// were, and live.sqlite with every instant, so that it can be replayed to the same bytes
/// wherever it lies. What is half a second old survives whatever happens to the process.
/// The disk is waited for by a thread of its own.
class LiveRecorder {
 public:
  /// Makes the folder and what does not change, of a run with this body and these settings. Errors: it
  /// holds a take already, or avatars are of a kind that cannot be copied alone
  /// (kBadInput); the disk (kDevice). Nothing is left in the folder then.
  [[nodiscard]] static Result<std::unique_ptr<LiveRecorder>> create(
      const std::filesystem::path& folder,
      const OpenedLive& live,
      const Body& body,
      const LiveSettings& settings);
  ~LiveRecorder();

  /// Does not wait for the disk. After trouble nothing more is kept.
  void add(const LiveInstant& instant,
           const LiveRequests& requests,
           const LiveResult& result);
  /// One that is needed to come to the state in which the take begins (LiveTakes).
  void add_lead_in(const LiveInstant& instant, const LiveRequests& requests);
  /// Why the recording ended before its time; the rest of the run goes on.
  [[nodiscard]] std::optional<Error> trouble() const;
  /// Writes what is left. Errors: trouble(), or the disk.
  [[nodiscard]] Status finish();
  /// Instead of finish(): takes away all that create() made. Nothing may follow.
  void discard();

 private:
  explicit LiveRecorder(recordings::LiveTakeWriter writer);
  void keep();
  void commit_often(const std::stop_token& stop);
  void end_commits();

  std::filesystem::path folder_;
  bool was_there_ = false;  ///< The folder, before.
  recordings::LiveTakeWriter writer_;
  recordings::LiveTakeInstant instant_;
  mutable std::mutex mutex_;
  std::optional<Error> trouble_;
  std::jthread committer_;
};

}  // namespace marey::app
