// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_wizard.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "core/base/assert.h"
#include "reconstruct/clusters/check_views.h"
#include "recordings/session/subject_file.h"

namespace marey::app {
namespace {

using live::WizardAction;
using live::WizardStep;

/// Minimum interval between console messages of the same step.
constexpr double kTellEvery_s = 3.0;

WizardSetup setup_of(const OpenedLive& live) {
  WizardSetup setup;
  setup.cameras = live.calibration.cameras;
  for (const CameraQuality& camera : live.calibration.quality) {
    setup.rms_px.push_back(camera.rms_px);
  }
  setup.prior = live.prior;
  setup.rate = live.settings.rate;
  return setup;
}

/// Errors (kDevice): the disk.
Status write_next_to_old(const std::filesystem::path& path, const Body& body) {
  std::error_code problem;
  if (std::filesystem::exists(path, problem)) {
    std::filesystem::path before = path;
    before += ".before";
    std::filesystem::copy_file(
        path, before, std::filesystem::copy_options::overwrite_existing, problem);
    if (problem) {
      return Error{Errc::kDevice,
                   before.string(),
                   "it cannot be written: " + problem.message(),
                   "free some disk space, or choose a folder that may be written to"};
    }
  }
  return recordings::write_subject(path, body);
}

}  // namespace

LiveWizard::LiveWizard(const OpenedLive& live,
                       const LiveWizardOptions& options,
                       Console& console)
    : live_(live),
      options_(options),
      console_(console),
      wizard_(setup_of(live), options.steps) {
  if (options_.begin && !act(WizardAction::kStart)) report_step();
}

std::optional<std::string> LiveWizard::act(WizardAction action) {
  if (action == WizardAction::kStart && options_.is_recording) {
    return "a take is being recorded, and a take has one body: end the take first";
  }
  if (action == WizardAction::kStart && solver_.joinable()) {
    return "the cancelled measurement is still being solved: try again in some seconds";
  }
  if (action == WizardAction::kAccept) return accept();
  const auto refusal = wizard_.act(action);
  if (!refusal) {
    waiting_.reset();
    go_on();
  }
  return refusal;
}

void LiveWizard::process(const LiveInstant& instant) {
  now_ = instant.time;
  wizard_.process(instant);
  go_on();
}

void LiveWizard::end() {
  options_.begin = false;  // No restart.
  wizard_.end();
  go_on();
  if (!solver_.joinable()) return;
  const bool is_wanted = wizard_.step() == WizardStep::kSolve;
  if (!is_solved_) {
    console_.say(is_wanted
                     ? "waiting for the body to be measured"
                     : "waiting up to a minute for the end of a cancelled measurement");
  }
  is_solved_.wait(false);
  go_on();
}

/// Continues with the step that the current state requires.
void LiveWizard::go_on() {
  take_result();
  if (auto material = wizard_.take_material()) solve(*std::move(material));
  report_step();
  if (!options_.by_itself) return;
  if (wizard_.is_good()) {
    if (const auto refusal = accept()) console_.warn(*refusal);
  }
  const bool is_unaccepted =
      wizard_.step() == WizardStep::kFailed || wizard_.step() == WizardStep::kDone;
  if (is_unaccepted && options_.begin && !wizard_.act(WizardAction::kStart))
    report_step();
}

void LiveWizard::solve(WizardMaterial material) {
  MAREY_ASSERT(!solver_.joinable());
  is_solved_ = false;
  solver_ = std::jthread([this, material = std::move(material)] {
    result_.emplace(solved(material));
    is_solved_ = true;
    is_solved_.notify_all();
  });
}

/// Solves on the solver's thread; reads only constant members.
Result<LiveWizard::Solved> LiveWizard::solved(const WizardMaterial& material) const {
  const auto& cameras = live_.calibration.cameras;
  const auto& tags = live_.prior.tags;
  for (const auto* seen : {&material.standing, &material.moving}) {
    const Status ok = reconstruct::check_views(cameras, *seen, tags);
    if (!ok) return ok.error();
  }
  auto fit =
      reconstruct::fit_subject(live_.prior, cameras, material.standing, material.moving);
  if (!fit) return fit.error();
  auto chain = LiveChain::make(fit->body, cameras, live_.avatars, live_.settings);
  if (!chain) return chain.error();
  return Solved{*std::move(fit), *std::move(chain)};
}

void LiveWizard::take_result() {
  if (!solver_.joinable() || !is_solved_) return;
  solver_.join();
  auto result = *std::exchange(result_, std::nullopt);
  if (wizard_.step() != WizardStep::kSolve) return;  // It was cancelled.
  if (!result) return wizard_.finish(result.error());
  wizard_.finish(result->fit);
  waiting_.emplace(*std::move(result));
}

std::optional<std::string> LiveWizard::accept() {
  if (const auto refusal = wizard_.act(WizardAction::kAccept)) return refusal;
  MAREY_ASSERT(waiting_);
  const Status written = write_next_to_old(live_.subject_file, waiting_->fit.body);
  if (!written) {
    wizard_.refuse_acceptance(written.error().message());
    return written.error().message();
  }
  accepted_.emplace(
      MeasuredBody{std::move(waiting_->fit.body), std::move(waiting_->chain)});
  waiting_.reset();
  has_measured_ = true;
  options_.begin = false;
  console_.say("the body is in " + live_.subject_file.string());
  report_step();
  return std::nullopt;
}

std::optional<MeasuredBody> LiveWizard::take_body() {
  return std::exchange(accepted_, std::nullopt);
}

/// Prints a new step at once, and a new text of the same step after kTellEvery_s.
void LiveWizard::report_step() {
  const live::PageWizard& now = wizard_.ui_state();
  const bool is_new_step = now.step != shown_step_;
  const bool is_due = !shown_at_ || (now_ && seconds(*now_ - *shown_at_) >= kTellEvery_s);
  if (!is_new_step && (now.text == shown_text_ || !is_due)) return;
  shown_step_ = now.step;
  shown_text_ = now.text;
  shown_at_ = now_;
  if (now.step == WizardStep::kIdle) return;
  if (!is_new_step) return console_.say(now.text);
  console_.say(now.title + ". " + now.text);
  if (!now.error.empty()) console_.warn(now.error);
  for (const Finding& one : now.quality) {
    const bool is_good = one.severity == Severity::kNote;
    console_.say("  " + one.where + ": " + one.cause + (is_good ? "" : " (poor)"));
  }
}

}  // namespace marey::app
