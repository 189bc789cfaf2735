// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live/live_recorder.h"
#include "app/live/live_session.h"
#include "app/live_chain/live_chain.h"
#include "app/live_chain/live_statistics.h"
#include "app/shell/console.h"

namespace marey::app {

/// Manages the takes of one live run: a take of the whole run, and takes that start and
/// end during it.
///
/// The result of an instant depends on all instants before it. A take that starts during
/// the run therefore gets its own new chain, which receives the same instants as the
/// run's chain. Once the new chain has tracked the body for kLeadIn_s, it replaces the
/// run's chain, and every later byte depends on the take alone. The instants before that
/// are the lead-in of the take. The new chain takes over the state of the handles, the
/// periods requested for the streams and the time base of VMC.
///
/// A take that ends during its lead-in has nothing to replay. It is deleted with a
/// warning.
///
/// Other threads create folders, files and the new chain, and close takes. Only finish()
/// waits for the disk.
class LiveTakes {
 public:
  /// Duration of the lead-in. With a shorter one the body's position jumps when the
  /// chains are exchanged, because the lags of the cameras are not known at first.
  static constexpr double kLeadIn_s = 1.0;

  /// The folder of a take that starts during the run is the first unused name of
  /// "STEM-1", "STEM-2"... `live` and `console` must outlive this object. After the first
  /// add() the cameras, avatars and settings of `live` must not change.
  LiveTakes(const OpenedLive& live, std::filesystem::path stem, Console& console);
  ~LiveTakes();

  /// Starts a take of the whole run, from its first instant. Precondition: called before
  /// any add(), and `live` has a body. Errors: those of LiveRecorder::create().
  [[nodiscard]] Status begin_with_run(const std::filesystem::path& folder);
  /// Starts a take, or ends the current one, with the next add().
  void want(bool on) { wanted_ = on; }
  [[nodiscard]] bool is_wanted() const { return wanted_; }
  /// Sets the body of the chain from the next add() on. Ends the current take.
  void follow(const Body& body);
  /// Adds an instant and its result. May replace `chain` by another one, which
  /// invalidates `result`.
  void add(const LiveInstant& instant,
           const LiveRequests& requests,
           const LiveResult& result,
           LiveChain& chain);

  /// Returns the state of the current or requested take; nullopt: none.
  [[nodiscard]] std::optional<LiveRecording> state() const;
  /// Returns the first error of any take.
  [[nodiscard]] const std::optional<Error>& trouble() const { return first_trouble_; }
  /// Returns the folders of completed takes.
  [[nodiscard]] const std::vector<std::string>& finished() const { return finished_; }
  /// Ends the current take and waits until it is written. Errors: trouble().
  [[nodiscard]] Status finish();

 private:
  struct Take {
    std::filesystem::path folder{};
    std::unique_ptr<LiveRecorder> recorder{};
    std::optional<LiveChain> next{};   ///< Not yet the chain of the run.
    std::optional<Timestamp> begin{};  ///< Start of the part to replay.
    std::optional<Error> trouble{};
    bool is_reported = false;  ///< The trouble was reported.
  };

  [[nodiscard]] Take open(const Body& body, const LiveSettings& settings) const;
  void check_threads();
  void lead_in(const LiveInstant& instant,
               const LiveRequests& requests,
               const LiveResult& result,
               LiveChain& chain);
  [[nodiscard]] LiveRequests pending_requests(const LiveResult& result) const;
  void close();
  void report_failure(const Error& error);

  const OpenedLive& live_;
  std::filesystem::path stem_;
  Console& console_;
  std::optional<Body> body_;
  bool wanted_ = false;
  std::future<Take> opening_;
  bool is_opening_void_ = false;  ///< The take being opened is of an earlier body.
  std::future<Take> closing_;
  std::optional<Take> take_;
  bool is_new_ = false;                     ///< Its chain has received no instant.
  std::optional<Timestamp> tracked_since_;  ///< In the chain of the take.
  Timestamp now_{0};
  KeptPeriods periods_;
  std::optional<Error> first_trouble_;
  std::vector<std::string> finished_;
};

}  // namespace marey::app
