// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "app/live/live_session.h"
#include "app/live_chain/guide_subject.h"
#include "app/live_chain/live_chain.h"
#include "app/shell/console.h"

namespace marey::app {

struct LiveGuideOptions {
  bool begin = false;         ///< At once, without being asked.
  bool by_itself = false;     ///< Accepts what is good and begins anew after what is not.
  bool is_recording = false;  ///< As set_recording().
  GuideOptions steps{};
};

/// A body and what follows it.
struct GuidedBody {
  Body body;
  LiveChain chain;
};

/// Guides through the measuring of a person while a live run goes on: solves on a thread
/// of its own, tells the steps on the console, and writes what is accepted to
/// subject.toml. What that held before is then in subject.toml.before. One thread calls
/// it.
class LiveGuide {
 public:
  /// `live` and `console` outlive it. Precondition: live.prior has tags.
  LiveGuide(const OpenedLive& live, const LiveGuideOptions& options, Console& console);

  /// Why not, or nullopt.
  [[nodiscard]] std::optional<std::string> act(live::WizardAction action);
  /// A take has one body: nobody begins to be measured meanwhile.
  void set_recording(bool on) { options_.is_recording = on; }
  /// Takes some microseconds, but for the instant in which a body is accepted.
  void see(const LiveInstant& instant);
  /// No instant follows. Waits for what is being solved, up to a minute, and in a run by
  /// itself keeps it if it is good.
  void end();
  /// The body that was accepted since the last call.
  [[nodiscard]] std::optional<GuidedBody> take_body();

  [[nodiscard]] const live::PageWizard& ui_state() const { return guide_.ui_state(); }
  /// A body was accepted and written.
  [[nodiscard]] bool has_measured() const { return has_measured_; }

 private:
  struct Solved {
    reconstruct::SubjectFit fit;
    LiveChain chain;
  };

  void go_on();
  void solve(GuideMaterial material);
  [[nodiscard]] Result<Solved> solved(const GuideMaterial& material) const;
  void take_result();
  [[nodiscard]] std::optional<std::string> accept();
  void tell();

  const OpenedLive& live_;
  LiveGuideOptions options_;
  Console& console_;
  SubjectGuide guide_;
  std::optional<Solved> waiting_;  ///< For acceptance.
  std::optional<GuidedBody> accepted_;
  bool has_measured_ = false;
  live::WizardStep shown_step_ = live::WizardStep::kIdle;
  std::string shown_text_;
  std::optional<Timestamp> now_;
  std::optional<Timestamp> shown_at_;

  std::atomic<bool> is_solved_ = false;
  std::optional<Result<Solved>> result_;  ///< The thread's, until is_solved_.
  std::jthread solver_;
};

}  // namespace marey::app
