// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "app/live/live_session.h"
#include "app/live_chain/live_chain.h"
#include "app/live_chain/subject_wizard.h"
#include "app/shell/console.h"

namespace marey::app {

struct LiveWizardOptions {
  bool begin = false;         ///< Starts at once, without a request.
  bool by_itself = false;     ///< Accepts a good result; restarts after a poor one.
  bool is_recording = false;  ///< See set_recording().
  WizardOptions steps{};
};

/// A measured body and the chain that tracks it.
struct MeasuredBody {
  Body body;
  LiveChain chain;
};

/// Guides a subject through calibration during a live run. Solves on its own thread,
/// prints the steps on the console and writes the accepted body to subject.toml. The
/// previous file is kept as subject.toml.before. Called from one thread.
class LiveWizard {
 public:
  /// `live` and `console` must outlive the object. Precondition: live.prior has tags.
  LiveWizard(const OpenedLive& live, const LiveWizardOptions& options, Console& console);

  /// Performs an action of the page. Returns the reason if it is rejected, else nullopt.
  [[nodiscard]] std::optional<std::string> act(live::WizardAction action);
  /// Sets whether a take is being recorded. A take has one body, so no calibration starts
  /// during a recording.
  void set_recording(bool on) { options_.is_recording = on; }
  /// Processes one instant. Cost: some microseconds, except for the instant in which a
  /// body is accepted.
  void process(const LiveInstant& instant);
  /// Ends the calibration; no instant may follow. Waits up to a minute for a running
  /// solve. With LiveWizardOptions::by_itself it accepts a good result.
  void end();
  /// Returns the body accepted since the last call, if any.
  [[nodiscard]] std::optional<MeasuredBody> take_body();

  [[nodiscard]] const live::PageWizard& ui_state() const { return wizard_.ui_state(); }
  /// Returns true if a body was accepted and written.
  [[nodiscard]] bool has_measured() const { return has_measured_; }

 private:
  struct Solved {
    reconstruct::SubjectFit fit;
    LiveChain chain;
  };

  void go_on();
  void solve(WizardMaterial material);
  [[nodiscard]] Result<Solved> solved(const WizardMaterial& material) const;
  void take_result();
  [[nodiscard]] std::optional<std::string> accept();
  void report_step();

  const OpenedLive& live_;
  LiveWizardOptions options_;
  Console& console_;
  SubjectWizard wizard_;
  std::optional<Solved> waiting_;  ///< Result to be accepted.
  std::optional<MeasuredBody> accepted_;
  bool has_measured_ = false;
  live::WizardStep shown_step_ = live::WizardStep::kIdle;
  std::string shown_text_;
  std::optional<Timestamp> now_;
  std::optional<Timestamp> shown_at_;

  std::atomic<bool> is_solved_ = false;
  std::optional<Result<Solved>> result_;  ///< Owned by the thread until is_solved_.
  std::jthread solver_;
};

}  // namespace marey::app
