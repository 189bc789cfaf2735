// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/record/record_commands.h"

#include <memory>

#include "app/record/record_device.h"
#include "app/record/record_take.h"
#include "app/shell/option_checks.h"
#include "app/shell/stop_signal.h"
#include "capture/feeds/device_feed.h"
#include "recordings/base/atomic_file.h"
#include "recordings/session/session_copy.h"

namespace marey::app {
namespace {

using recordings::Session;
using recordings::Trial;

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

Exit print_summaries(const std::vector<CameraSummary>& cameras, Console& console) {
  Exit exit = Exit::kOk;
  for (const CameraSummary& camera : cameras) {
    std::string text = "camera " + camera.name + ": " + std::to_string(camera.frames) +
                       " frames, " + std::to_string(camera.dropped) + " dropped";
    if (camera.unsaved > 0) {
      text +=
          ", " + std::to_string(camera.unsaved) + " lost because the disk was too slow";
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
  const auto warn = [&console](const std::string& text) { console.warn(text); };
  std::vector<std::unique_ptr<capture::DeviceFeed>> feeds;
  std::vector<RecordedCamera> cameras;
  Exit opened = Exit::kOk;
  for (std::size_t c = 0; c < session->cameras.size(); ++c) {
    if (!session->devices[c]) {
      console.warn("camera " + session->cameras[c] +
                   " has no device in session.toml: it is not recorded");
      continue;
    }
    auto feed = capture::DeviceFeed::open(
        session->cameras[c], request_of(*session->devices[c]), warn);
    if (!feed) {
      // The other cameras still record, as the movement may not be repeatable.
      opened = console.fail(feed.error());
      continue;
    }
    feeds.push_back(std::move(*feed));
    cameras.push_back({session->cameras[c], feeds.back().get()});
  }
  if (cameras.empty()) return opened;
  if (const Status ok = recordings::copy_session(*session, arguments.out, **trial); !ok) {
    return console.fail(ok.error());
  }
  catch_stop_signals();
  if (!options.seconds) console.say("recording; Ctrl-C ends it");
  const auto recorded = record_take(
      cameras, options, stop_wanted, console.stage("recording " + options.trial));
  if (!recorded) return console.fail(recorded.error());
  const Exit ended = print_summaries(*recorded, console);
  console.say("recorded to " + options.folder.string());
  return ended == Exit::kOk ? opened : ended;
}

void add_record_command(CLI::App& app,
                        RecordArguments& args,
                        std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand("record", "Record a trial from the cameras");
  command->add_option("SESSION", args.session, "session.toml, or its folder")->required();
  command->add_option("-o,--out", args.out, "Folder of the take")->required();
  command->add_option("--trial", args.trial, "The session's trial to record")->required();
  command->add_option("--seconds", args.seconds, "Stop after this time [s]")
      ->check(between(0.001, 1e6));
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_record(args, console); }; });
}

}  // namespace marey::app
