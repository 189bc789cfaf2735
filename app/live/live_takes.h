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
#include "app/live_chain/live_figures.h"
#include "app/shell/console.h"

namespace marey::app {

/// The takes of one live run: of all of it, and those that are begun and ended meanwhile.
///
/// What follows from an instant depends on all before it. A take that begins in the middle
/// therefore has a chain of its own, new, beside the run's: it sees the same instants, and
/// once it has tracked the body for kLeadIn_s, it takes the run's place, and every byte
/// from there on follows from the take alone. What came before is the take's lead-in.
/// The new chain carries on what is held by its handles, asked of its streams, and VMC's
/// time.
///
/// A take that ends before that holds nothing that could be replayed: it is taken away
/// again, with a warning.
///
/// Folders, files and the new chain are made, and takes are closed, by other threads:
/// nothing here waits for the disk, but for finish().
class LiveTakes {
 public:
  /// Less, and the body's place would jump as the chains change: cameras' lags are not
  /// known at first.
  static constexpr double kLeadIn_s = 1.0;

  /// Takes begun meanwhile are the first of "STEM-1", "STEM-2"... that there is not yet.
  /// `live` and `console` outlive this; after the first add() cameras, avatars and settings
  /// of `live` do not change any more.
  LiveTakes(const OpenedLive& live, std::filesystem::path stem, Console& console);
  ~LiveTakes();

  /// A take of all of the run, from its first instant. Before any add().
  /// Errors: LiveRecorder::create()'s. Precondition: `live` has a body.
  [[nodiscard]] Status begin_with_run(const std::filesystem::path& folder);
  /// Begins a take, or ends the one that there is; from the next add() on.
  void want(bool on) { wanted_ = on; }
  [[nodiscard]] bool is_wanted() const { return wanted_; }
  /// The chain of the next add() is another body's: the take that there is ends.
  void follow(const Body& body);
  /// An instant, and what `chain` made of it, after which that may be another chain:
  /// `result` is not valid any more then.
  void add(const LiveInstant& instant,
           const LiveRequests& requests,
           const LiveResult& result,
           LiveChain& chain);

  /// What is recorded, or should be; nullopt: nothing.
  [[nodiscard]] std::optional<LiveRecording> state() const;
  /// The first that any take suffered.
  [[nodiscard]] const std::optional<Error>& trouble() const { return first_trouble_; }
  /// Folders of takes that are whole.
  [[nodiscard]] const std::vector<std::string>& finished() const { return finished_; }
  /// Ends what there is, and waits for it. Errors: trouble().
  [[nodiscard]] Status finish();

 private:
  struct Take {
    std::filesystem::path folder{};
    std::unique_ptr<LiveRecorder> recorder{};
    std::optional<LiveChain> next{};  ///< Not yet the run's.
    std::optional<Timestamp> begin{};  ///< Of what can be replayed.
    std::optional<Error> trouble{};
    bool is_told = false;  ///< The trouble.
  };

  [[nodiscard]] Take open(const Body& body, const LiveSettings& settings) const;
  void check_threads();
  void lead_in(const LiveInstant& instant,
               const LiveRequests& requests,
               const LiveResult& result,
               LiveChain& chain);
  [[nodiscard]] LiveRequests all_asked(const LiveResult& result) const;
  void close();
  void report_failure(const Error& error);

  const OpenedLive& live_;
  std::filesystem::path stem_;
  Console& console_;
  std::optional<Body> body_;
  bool wanted_ = false;
  std::future<Take> opening_;
  bool is_opening_void_ = false;  ///< What is being opened is of an earlier body.
  std::future<Take> closing_;
  std::optional<Take> take_;
  bool is_new_ = false;                   ///< Its chain has seen nothing.
  std::optional<Timestamp> tracked_since_;  ///< By that chain.
  Timestamp now_{0};
  KeptPeriods periods_;
  std::optional<Error> first_trouble_;
  std::vector<std::string> finished_;
};

}  // namespace marey::app
