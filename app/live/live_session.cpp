// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_session.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "app/check/mean_centre_sigma.h"
#include "app/record/record_device.h"
#include "capture/feeds/device_feed.h"
#include "live/vmc/vrchat_trackers.h"
#include "recordings/session/session.h"
#include "recordings/session/subject_file.h"

namespace marey::app {
namespace {

using recordings::Session;
using recordings::Trial;
/// Trials to be played, one after the other; empty: real cameras.
using Trials = std::vector<const Trial*>;

const recordings::TrialVideo* video_of(const Trial& trial, CameraId camera) {
  const auto found =
      std::find_if(trial.videos.begin(), trial.videos.end(), [&](const auto& video) {
        return video.camera == camera;
      });
  return found == trial.videos.end() ? nullptr : &*found;
}

std::string names_of(const Trials& trials) {
  std::string names;
  for (const Trial* trial : trials) {
    names += (names.empty() ? "\"" : ", \"") + trial->name + "\"";
  }
  return names;
}

/// Returns the cameras to be used, in the order of the session.
Result<std::vector<CameraId>> chosen_cameras(const Session& session,
                                             const LiveArguments& arguments,
                                             const Trials& trials) {
  for (const std::string& name : arguments.cameras) {
    if (std::find(session.cameras.begin(), session.cameras.end(), name) ==
        session.cameras.end()) {
      std::string names;
      for (const std::string& one : session.cameras) names += " " + one;
      return bad_input(session.file.string(),
                       "there is no camera \"" + name + "\"",
                       "choose one of:" + names);
    }
  }
  std::vector<CameraId> chosen;
  for (std::size_t c = 0; c < session.cameras.size(); ++c) {
    const CameraId id{static_cast<int>(c)};
    const bool is_wanted = arguments.cameras.empty() ||
                           std::find(arguments.cameras.begin(),
                                     arguments.cameras.end(),
                                     session.cameras[c]) != arguments.cameras.end();
    const bool is_there =
        trials.empty() ? session.devices[c].has_value()
                       : std::all_of(trials.begin(), trials.end(), [&](const Trial* one) {
                           return video_of(*one, id) != nullptr;
                         });
    if (is_wanted && is_there) chosen.push_back(id);
  }
  if (chosen.size() >= 2) return chosen;
  const std::string which = arguments.cameras.empty() ? "cameras" : "named cameras";
  return bad_input(session.file.string(),
                   "tracking needs at least two " + which + " with a " +
                       (trials.empty() ? std::string("device")
                                       : "video in trial " + names_of(trials)) +
                       ", and there " + (chosen.empty() ? "is none" : "is one"),
                   !arguments.cameras.empty()
                       ? "name two or more such cameras with --camera, or leave "
                         "the option out"
                   : trials.empty()
                       ? "give each [[camera]] its device = \"/dev/video0\", or play a "
                         "recorded trial with --play"
                       : "play another trial");
}

Result<Trials> trials_to_play(const Session& session, const LiveArguments& arguments) {
  Trials trials;
  for (const std::string& wanted : arguments.play) {
    trials.push_back(session.find(wanted));
    if (trials.back()) continue;
    std::string names;
    for (const Trial& one : session.trials) names += " " + one.name;
    return bad_input(session.file.string(),
                     "there is no trial \"" + wanted + "\"",
                     "choose one of:" + names);
  }
  return trials;
}

std::filesystem::path results_of(const Session& session, const LiveArguments& arguments) {
  return arguments.results.empty() ? session.file.parent_path() : arguments.results;
}

Status need_file(const std::filesystem::path& path, const std::string& what) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) return Done{};
  return bad_input(path.string(),
                   "there is no " + what + ", which live tracking needs",
                   "give with --results the folder that marey process (or calibrate, "
                   "then solve) wrote, or run one of these commands");
}

/// Reads the calibration of the chosen cameras, in the order of the session.
Result<recordings::Calibration> calibration_of(const Session& session,
                                               const std::vector<CameraId>& chosen,
                                               const std::filesystem::path& file) {
  if (const Status ok = need_file(file, "calibration"); !ok) return ok.error();
  const auto all = recordings::read_calibration(file);
  if (!all) return all.error();
  recordings::Calibration out;
  out.rms_px = all->rms_px;
  for (const CameraId id : chosen) {
    const std::string& name = session.cameras[index(id)];
    const auto found =
        std::find_if(all->cameras.begin(), all->cameras.end(), [&](const Camera& camera) {
          return camera.name == name;
        });
    if (found == all->cameras.end()) {
      std::string names;
      for (const Camera& camera : all->cameras) names += " " + camera.name;
      return bad_input(file.string(),
                       "the session's camera \"" + name +
                           "\" is not in the calibration, "
                           "which has:" +
                           names,
                       "calibrate again, or give it its name in the calibration");
    }
    const auto place = static_cast<std::size_t>(found - all->cameras.begin());
    out.cameras.push_back(*found);
    out.quality.push_back(all->quality[place]);
    out.clocks.push_back(all->clocks[place]);
  }
  return out;
}

/// Opens the videos of a camera. Precondition: it has a video in every trial.
Result<std::unique_ptr<capture::VideoFeed>> open_video(const Trials& trials,
                                                       CameraId camera,
                                                       const std::string& name,
                                                       bool loop) {
  std::vector<capture::VideoPart> parts;
  for (const Trial* trial : trials) {
    parts.push_back({video_of(*trial, camera)->path});
    if (!trial->frames) continue;
    parts.back().first_frame = trial->frames->first;
    parts.back().last_frame = trial->frames->last;
  }
  capture::VideoFeedOptions options;
  options.name = name;
  options.path = parts.front().path;
  options.first_frame = parts.front().first_frame;
  options.last_frame = parts.front().last_frame;
  options.then.assign(parts.begin() + 1, parts.end());
  options.rate = trials.front()->rate;
  options.loop = loop;
  return capture::VideoFeed::open(options);
}

Status open_feeds(const Session& session,
                  const std::vector<CameraId>& chosen,
                  const Trials& trials,
                  bool loop,
                  Console& console,
                  OpenedLive& out) {
  const auto warn = [&console](const std::string& text) { console.warn(text); };
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    const std::string& name = session.cameras[index(chosen[c])];
    if (!trials.empty()) {
      auto feed = open_video(trials, chosen[c], name, loop);
      if (!feed) return feed.error();
      out.videos.push_back(feed->get());
      out.feeds.push_back(*std::move(feed));
    } else {
      console.say("opening camera " + name + ": this may take some seconds");
      auto feed = capture::DeviceFeed::open(
          name, request_of(*session.devices[index(chosen[c])]), warn);
      if (!feed) return feed.error();
      out.feeds.push_back(*std::move(feed));
    }
    const capture::DeviceSettings& settings = out.feeds.back()->settings();
    const Intrinsics& expected = out.calibration.cameras[c].intrinsics;
    if (settings.width_px == expected.width_px &&
        settings.height_px == expected.height_px) {
      continue;
    }
    return bad_input(session.file.string(),
                     "camera \"" + name + "\" was calibrated with pictures of " +
                         std::to_string(expected.width_px) + "x" +
                         std::to_string(expected.height_px) + " and now has " +
                         std::to_string(settings.width_px) + "x" +
                         std::to_string(settings.height_px),
                     "set the width and height of the calibration, or calibrate again");
  }
  return Done{};
}

/// Reads the body to be tracked, and the prior of the subject to be measured.
Status find_body(const Session& session,
                 const std::filesystem::path& results,
                 const LiveArguments& arguments,
                 Console& console,
                 OpenedLive& out) {
  out.subject_file = results / "subject.toml";
  out.prior = {session.subject.name,
               session.subject.stature_m,
               session.subject.mass_kg,
               session.tags};
  if (arguments.calibrate && session.tags.empty()) {
    return bad_input(session.file.string(),
                     "it names no subject to be measured, or no tags on the body",
                     "add [subject] and [[tags.tag]], see docs/formats/session.md");
  }
  const Status there = need_file(out.subject_file, "subject");
  if (!there && arguments.calibrate) return Done{};
  if (!there) {
    Error error = there.error();
    error.next += "; --calibrate measures a subject live";
    return error;
  }
  auto body = recordings::read_subject(out.subject_file);
  if (!body) return body.error();
  for (const Finding& warning : body->warnings) {
    console.warn(out.subject_file.string() + ": " + warning.cause +
                 ". Next: " + warning.next);
  }
  out.body = *std::move(body);
  return Done{};
}

FrameRate rate_of_feeds(const OpenedLive& live) {
  double max_hz = 0.0;
  for (const auto& feed : live.feeds) {
    max_hz = std::max(max_hz, feed->settings().rate.hz);
  }
  return {max_hz > 0.0 ? max_hz : 30.0};
}

}  // namespace

Result<OpenedLive> open_live(const LiveArguments& arguments, Console& console) {
  const auto session = recordings::read_session(arguments.session, {arguments.media});
  if (!session) return session.error();
  const auto trials = trials_to_play(*session, arguments);
  if (!trials) return trials.error();
  const auto chosen = chosen_cameras(*session, arguments, *trials);
  if (!chosen) return chosen.error();
  const std::filesystem::path results = results_of(*session, arguments);
  OpenedLive out;
  out.session = session->name;
  out.folder = session->file.parent_path();
  auto calibration = calibration_of(*session, *chosen, results / "calibration.toml");
  if (!calibration) return calibration.error();
  out.calibration = *std::move(calibration);
  if (const Status ok = find_body(*session, results, arguments, console, out); !ok) {
    return ok.error();
  }
  for (const auto& path : arguments.avatars) {
    auto avatar = open_avatar(path);
    if (!avatar) return avatar.error();
    for (const std::string& remark : avatar->remarks) {
      console.warn(path.string() + ": " + remark);
    }
    out.settings.avatars.push_back(shown_name(path));
    out.avatars.push_back(*std::move(avatar));
  }
  const auto rest =
      arguments.vmc_rest == "raw" ? live::VmcRest::kRaw : live::VmcRest::kVrm0;
  const Status streams =
      plan_streams(arguments.vmc, rest, arguments.vmc_mtu, out.settings, out.targets);
  if (!streams) return streams.error();
  for (const std::string& text : arguments.vrchat) {
    auto address = live::parse_udp_address(text, live::kVrchatPort);
    if (!address) return address.error();
    out.vrchat.push_back(*std::move(address));
  }
  out.settings.vrchat = !out.vrchat.empty();
  out.settings.balance_preview = arguments.balance == "preview";
  out.settings.camera_sigma_m = mean_centre_sigma_m(out.calibration.quality);
  out.settings.lag_known.assign(chosen->size(), false);
  out.detector.families = session->families;
  const Status feeds =
      open_feeds(*session, *chosen, *trials, arguments.loop, console, out);
  if (!feeds) return feeds.error();
  out.settings.rate = rate_of_feeds(out);
  return out;
}

}  // namespace marey::app
