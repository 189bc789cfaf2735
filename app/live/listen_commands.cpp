// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/listen_commands.h"

#include <chrono>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/live_chain/live_avatar.h"
#include "app/live_chain/live_streams.h"
#include "app/motion/motion_files.h"
#include "app/motion/raw_body.h"
#include "app/shell/option_checks.h"
#include "app/shell/stop_signal.h"
#include "core/base/extension.h"
#include "live/udp/udp_sender.h"
#include "live/vmc/motion_resampler.h"
#include "live/vmc/sender_clock.h"
#include "live/vmc/vmc_receiver.h"
#include "recordings/base/atomic_file.h"

namespace marey::app {
namespace {

using Clock = std::chrono::steady_clock;

/// Output of the received motion: another body, and the receivers of its packets.
struct Onward {
  OpenedAvatar avatar;
  retarget::LiveRetarget retarget;
  live::VmcBody body;
  live::VmcEncoder encoder;
  live::UdpSender sender;
  Pose pose;
  live::VmcPose vmc_pose;
};

live::VmcRest rest_of(const ListenArguments& arguments) {
  return arguments.rest == "raw" ? live::VmcRest::kRaw : live::VmcRest::kVrm0;
}

Result<Onward> open_onward(const ListenArguments& arguments, const Skeleton& performer) {
  auto avatar = open_avatar(arguments.avatars.front());
  if (!avatar) return avatar.error();
  LiveSettings settings;
  settings.avatars.push_back(arguments.avatars.front().filename().string());
  std::vector<StreamTargets> targets;
  const Status planned =
      plan_streams(arguments.vmc, rest_of(arguments), std::nullopt, settings, targets);
  if (!planned) return planned.error();
  if (settings.streams.size() != 1) {
    return bad_input(
        "--vmc",
        "targets on this machine and on others need packets of different sizes",
        "run marey listen once for each");
  }
  auto retarget = make_live_retarget(performer, *avatar);
  if (!retarget) return retarget.error();
  auto body = make_vmc_body(avatar->skeleton, &*avatar, rest_of(arguments));
  if (!body) return body.error();
  live::VmcEncoderOptions encoding;
  encoding.mtu_bytes = settings.streams.front().mtu_bytes;
  auto encoder = live::VmcEncoder::make(encoding);
  if (!encoder) return encoder.error();
  auto sender = live::UdpSender::open(targets.front().addresses);
  if (!sender) return sender.error();
  Pose rest = rest_pose(avatar->skeleton);
  return Onward{*std::move(avatar),
                *std::move(retarget),
                *std::move(body),
                *std::move(encoder),
                *std::move(sender),
                std::move(rest),
                {}};
}

/// One run of the command.
class Listening {
 public:
  Listening(const OpenedAvatar& body,
            live::VmcBody vmc,
            live::VmcReceiver receiver,
            std::optional<Onward> onward)
      : body_(body),
        vmc_(std::move(vmc)),
        receiver_(std::move(receiver)),
        onward_(std::move(onward)),
        pose_(rest_pose(body.skeleton)) {}

  void run(std::optional<double> seconds,
           bool keep,
           const Progress& progress,
           Console& console) {
    constexpr std::chrono::milliseconds kLook{100};
    constexpr int kMaxAtOnce = 256;  // A flood of packets must not block the loop.
    const auto since_start = [begin = Clock::now()] {
      return std::chrono::duration<double>(Clock::now() - begin).count();
    };
    while (!stop_wanted() && !(seconds && since_start() >= *seconds)) {
      receiver_.wait(kLook);
      // All received frames are kept; only the newest is passed on.
      int came = 0;
      double time_s = 0.0;
      for (; came < kMaxAtOnce && receiver_.receive_next(frame_); ++came) {
        time_s = clock_.at_s(frame_.time_s, since_start());
        take(time_s, keep);
      }
      report_tracking(console);
      if (came == 0) continue;
      if (onward_) pass_on(time_s);
      if (progress) progress(static_cast<int>(frames_), kUnknownTotal);
    }
  }

  [[nodiscard]] const live::MotionResampler& resampler() const { return resampler_; }
  /// Returns the number of frames that the sender marked as not tracked.
  [[nodiscard]] long untracked() const { return untracked_; }
  [[nodiscard]] const live::VmcReceived& received() const { return receiver_.received(); }

 private:
  /// Reports on the console when the tracking status of the sender changes.
  void report_tracking(Console& console) {
    const live::VmcStatus& status = receiver_.status();
    const bool is_good = status.loaded && status.tracking;
    if (is_good == is_good_) return;
    is_good_ = is_good;
    if (is_good) {
      console.say("the sender tracks its body again");
    } else {
      console.warn(
          status.loaded
              ? "the sender reports that its body is not tracked: the received poses "
                "are old or estimated"
              : "the sender reports that it has no body loaded");
    }
  }

  /// Processes the received frame. `time_s` is on the local clock.
  void take(double time_s, bool keep) {
    vmc_.from_vmc(frame_.pose, pose_);
    ++frames_;
    if (!frame_.status.tracking) ++untracked_;
    if (keep) resampler_.add(time_s, pose_);
  }

  void pass_on(double time_s) {
    // A sender that restarted or paused for long is treated as a new sender.
    constexpr double kMaxWait_s = 1.0;
    constexpr double kUsual_s = 1.0 / 60.0;
    const double since_s = last_s_ ? time_s - *last_s_ : kUsual_s;
    const bool goes_on = since_s > 0.0 && since_s < kMaxWait_s;
    last_s_ = time_s;
    if (!goes_on) onward_->retarget.reset();
    onward_->retarget.step(pose_, goes_on ? since_s : kUsual_s, onward_->pose);
    onward_->body.to_vmc(onward_->pose, onward_->vmc_pose);
    live::VmcStatus status = frame_.status;
    for (const auto& packet :
         onward_->encoder.encode(from_seconds(time_s), onward_->vmc_pose, status)) {
      onward_->sender.send(packet);
    }
  }

  const OpenedAvatar& body_;
  live::VmcBody vmc_;
  live::VmcReceiver receiver_;
  std::optional<Onward> onward_;
  live::VmcFrame frame_;
  Pose pose_;
  live::SenderClock clock_;
  live::MotionResampler resampler_;
  std::optional<double> last_s_;
  long frames_ = 0;
  long untracked_ = 0;
  bool is_good_ = true;
};

Result<MotionFormat> format_of(const std::filesystem::path& out) {
  const std::string kind = kind_by_extension(out);
  const auto format = kind.empty() ? std::nullopt : motion_format(kind.substr(1));
  if (format) return *format;
  return bad_input(out.string(),
                   "the extension is not that of a motion format",
                   "give the file one of the extensions " + motion_extensions());
}

void print(const live::VmcReceived& received, std::size_t kept, long untracked) {
  const nlohmann::ordered_json out{{"frames", received.frames},
                                   {"kept", kept},
                                   {"untracked", untracked},
                                   {"incomplete", received.incomplete},
                                   {"packets", received.packets},
                                   {"malformed", received.malformed},
                                   {"declined", received.declined},
                                   {"ignored", received.ignored}};
  std::fputs((out.dump(2) + "\n").c_str(), stdout);
}

Status write(const ListenArguments& arguments,
             MotionFormat format,
             const OpenedAvatar& body,
             const live::MotionResampler& resampler) {
  const auto motion = resampler.at_rate(body.skeleton, {arguments.rate_hz});
  if (!motion) {
    return Error{Errc::kDevice,
                 arguments.from,
                 "no pose was received, so there is no motion to write",
                 "check that the sender sends VMC to this address and port"};
  }
  return write_motion_file(arguments.out, format, *motion, body.look);
}

}  // namespace

Exit run_listen(const ListenArguments& arguments, Console& console) {
  if (arguments.out.empty() && arguments.avatars.empty()) {
    return console.fail(bad_usage("marey listen",
                                  "no output is given for the received motion",
                                  "give --out FILE, or --avatar FILE with --vmc HOST"));
  }
  if (arguments.avatars.empty() != arguments.vmc.empty()) {
    return console.fail(bad_usage("marey listen",
                                  "--avatar and --vmc go together",
                                  "give both the body and the receiver of its packets"));
  }
  if (const Status ok = check_out_file(arguments.out); !ok) {
    return console.fail(ok.error());
  }
  Result<MotionFormat> format = MotionFormat::kBvh;
  if (!arguments.out.empty()) format = format_of(arguments.out);
  if (!format) return console.fail(format.error());
  const auto body = open_avatar(arguments.body);
  if (!body) return console.fail(body.error());
  for (const std::string& remark : body->remarks) console.warn(remark);
  if (!arguments.out.empty()) {
    if (const Status ok = can_hold(*format, body->skeleton, body->look); !ok) {
      return console.fail(ok.error());
    }
  }
  auto vmc = make_vmc_body(body->skeleton, &*body, rest_of(arguments));
  if (!vmc) return console.fail(vmc.error());
  std::optional<Onward> onward;
  if (!arguments.avatars.empty()) {
    auto opened = open_onward(arguments, body->skeleton);
    if (!opened) return console.fail(opened.error());
    onward.emplace(*std::move(opened));
  }
  const auto at = live::parse_udp_address(arguments.from, live::kMarionettePort);
  if (!at) return console.fail(at.error());
  auto receiver = live::VmcReceiver::open(*at);
  if (!receiver) return console.fail(receiver.error());
  catch_stop_signals();
  console.say("listening at " + live::text_of(*at) +
              (arguments.seconds ? "" : "; Ctrl-C ends it"));
  Listening listening(*body, *std::move(vmc), *std::move(receiver), std::move(onward));
  listening.run(
      arguments.seconds, !arguments.out.empty(), console.stage("listen"), console);
  if (arguments.json) {
    print(listening.received(), listening.resampler().size(), listening.untracked());
  }
  if (listening.untracked() > 0) {
    console.warn("in " + std::to_string(listening.untracked()) + " of " +
                 std::to_string(listening.received().frames) +
                 " frames the sender reported that its body is not tracked");
  }
  if (arguments.out.empty()) return Exit::kOk;
  const Status ok = write(arguments, *format, *body, listening.resampler());
  if (!ok) return console.fail(ok.error());
  console.say("written to " + arguments.out.string());
  return Exit::kOk;
}

void add_listen_command(CLI::App& app,
                        ListenArguments& arguments,
                        std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand(
      "listen", "Receive VMC and write a motion or send it on another body");
  command->add_option("BODY", arguments.body, "The sender's avatar: " + body_extensions())
      ->required();
  command->add_option("-o,--out", arguments.out, "The motion: " + motion_extensions());
  command->add_option("--at", arguments.from, "Address to listen on: HOST[:PORT]");
  command->add_option("--rest", arguments.rest, "Pose without rotations: vrm0 or raw")
      ->check(one_of({"vrm0", "raw"}));
  command->add_option("-a,--avatar", arguments.avatars, "Body for live retargeting")
      ->expected(1);
  command->add_option("--vmc", arguments.vmc, "Receiver of its VMC packets: HOST[:PORT]")
      ->allow_extra_args(false);
  command->add_option("--rate", arguments.rate_hz, "Frames per second of the motion")
      ->check(between(1.0, 1000.0));
  command->add_option("--seconds", arguments.seconds, "Stop after this time [s]")
      ->check(between(0.001, 1e6));
  command->add_flag("--json", arguments.json, "Print the counts as JSON");
  command->callback([&] {
    chosen = [&arguments](Console& console) { return run_listen(arguments, console); };
  });
}

}  // namespace marey::app
