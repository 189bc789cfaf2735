// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include "app/commands.h"
#include "app/record_take.h"
#include "app/stop_signal.h"
#include "capture/reopening_device.h"
#include "recordings/atomic_file.h"
#include "recordings/session_copy.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::Session;
using recordings::SessionDevice;
using recordings::Trial;

/// A real camera, which is opened again when it was unplugged.
class DeviceFeed final : public FrameFeed {
 public:
  /// `console` outlives it.
  static Result<std::unique_ptr<DeviceFeed>> open(const std::string& name,
                                                  const SessionDevice& wanted,
                                                  Console& console) {
    capture::DeviceRequest request;
    request.path = wanted.path;
    request.width_px = wanted.width_px;
    request.height_px = wanted.height_px;
    request.rate = wanted.rate;
    request.exposure_s = wanted.exposure_s;
    request.focus = wanted.focus;
    request.gain = wanted.gain;
    // On the heap first: the listener points to it.
    auto feed = std::unique_ptr<DeviceFeed>(new DeviceFeed(name, console));
    auto device = capture::ReopeningDevice::open(
        request,
        [raw = feed.get()](const capture::CameraStatus& status) { raw->hear(status); });
    if (!device) return device.error();
    feed->device_.emplace(std::move(*device));
    for (const std::string& difference : feed->settings().differences) {
      console.warn(std::string("camera ").append(name).append(": ").append(difference));
    }
    return feed;
  }

  std::optional<capture::RawFrame> next(std::chrono::milliseconds timeout) override {
    return device_->next(timeout);
  }
  [[nodiscard]] const capture::DeviceSettings& settings() const override {
    return device_->settings();
  }
  [[nodiscard]] std::string device() const override {
    return device_->info().path + " " + device_->info().card;
  }
  std::vector<FeedEvent> events() override { return std::exchange(events_, {}); }

 private:
  DeviceFeed(std::string name, Console& console)
      : name_(std::move(name)), console_(&console) {}

  void hear(const capture::CameraStatus& status) {
    std::string text = capture::name(status.state);
    if (status.trouble) text += ": " + status.trouble->message();
    console_->warn("camera " + name_ + " is " + text);
    events_.push_back({status.since, std::move(text)});
  }

  std::string name_;
  Console* console_;
  std::vector<FeedEvent> events_;
  std::optional<capture::ReopeningDevice> device_;
};

Result<const Trial*> trial_to_record(const Session& session, const std::string& name) {
  const Trial* trial = session.find(name);
  if (trial == nullptr) {
    std::string names;
    for (const Trial& one : session.trials) names += " " + one.name;
    return bad_input(session.file.string(),
                     "there is no trial \"" + name + "\"",
                     "choose one of:" + names + "; or add a [[trial]] with its kind");
  }
  if (trial->is_recorded) return trial;
  return bad_input(session.file.string() + ":" + std::to_string(trial->line),
                   "trial \"" + name +
                       "\" cannot be recorded: it has videos, or no camera "
                       "has a device",
                   "give each [[camera]] its device = \"/dev/video0\", and remove the "
                   "trial's videos");
}

Exit tell(const std::vector<CameraSummary>& cameras, Console& console) {
  Exit exit = Exit::kOk;
  for (const CameraSummary& camera : cameras) {
    std::string text = "camera " + camera.name + ": " + std::to_string(camera.frames) +
                       " frames, " + std::to_string(camera.dropped) + " dropped";
    if (camera.unsaved > 0) {
      text += ", " + std::to_string(camera.unsaved) + " of them for a slow disk";
    }
    console.say(text);
    if (camera.error) exit = console.fail(*camera.error);
  }
  return exit;
}

}  // namespace

Exit run_record(const RecordArguments& arguments, Console& console) {
  const auto session = recordings::read_session(arguments.session);
  if (!session) return console.fail(session.error());
  const auto trial = trial_to_record(*session, arguments.trial);
  if (!trial) return console.fail(trial.error());
  std::vector<std::string> names;
  for (std::size_t c = 0; c < session->cameras.size(); ++c) {
    if (session->devices[c]) names.push_back(session->cameras[c]);
  }
  RecordOptions options;
  options.folder = arguments.out / (*trial)->name;
  options.trial = (*trial)->name;
  options.seconds = arguments.seconds;
  if (const Status ok = check_unrecorded(options.folder, names); !ok) {
    return console.fail(ok.error());
  }
  std::vector<std::unique_ptr<DeviceFeed>> feeds;
  std::vector<RecordedCamera> cameras;
  for (std::size_t c = 0; c < session->cameras.size(); ++c) {
    if (!session->devices[c]) continue;
    auto feed = DeviceFeed::open(session->cameras[c], *session->devices[c], console);
    if (!feed) return console.fail(feed.error());
    feeds.push_back(std::move(*feed));
    cameras.push_back({session->cameras[c], feeds.back().get()});
  }
  if (const Status ok = recordings::copy_session(*session, arguments.out, **trial); !ok) {
    return console.fail(ok.error());
  }
  catch_stop_signals();
  if (!options.seconds) console.say("recording; Ctrl-C ends it");
  const auto recorded = record_take(
      cameras, options, stop_wanted, console.stage("recording " + options.trial));
  if (!recorded) return console.fail(recorded.error());
  const Exit exit = tell(*recorded, console);
  console.say("recorded to " + options.folder.string());
  return exit;
}

}  // namespace marey::app
