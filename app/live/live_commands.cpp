// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_commands.h"

#include <cstdio>
#include <utility>

#include "app/live/live_page.h"
#include "app/live/live_run.h"
#include "app/live/live_takes.h"
#include "app/live/live_wizard.h"
#include "app/live_chain/live_chain.h"
#include "app/live_chain/live_outputs.h"
#include "app/motion/raw_body.h"
#include "app/shell/option_checks.h"
#include "app/shell/stop_signal.h"
#include "app/view/view_commands.h"
#include "core/human/average_proportions.h"
#include "live/vmc/vmc_encoder.h"
#include "live/vmc/vmc_sender.h"

namespace marey::app {
namespace {

/// Opens the outputs. The first stream receives commands. If the default VMC port is in
/// use, the command warns and continues; a port given by the user must be free.
Result<LiveOutputs> open_outputs(const LiveArguments& arguments,
                                 OpenedLive& live,
                                 Console& console) {
  if (live.settings.streams.empty()) return LiveOutputs::open({}, {}, live.vrchat);
  std::optional<int>& port = live.settings.streams.front().listen_port;
  if (!arguments.vmc_send_only)
    port = arguments.vmc_listen.value_or(live::kPerformerPort);
  auto outputs = LiveOutputs::open(live.settings.streams, live.targets, live.vrchat);
  if (outputs || !port || arguments.vmc_listen) return outputs;
  const Error trouble = outputs.error();
  port.reset();
  outputs = LiveOutputs::open(live.settings.streams, live.targets, live.vrchat);
  if (outputs) console.warn("no VMC commands are received: " + trouble.message());
  return outputs;
}

void print_statistics(const LiveStatistics& figures, Console& console) {
  char text[200];
  std::snprintf(
      text,
      sizeof text,
      "%ld frames in %.1f s, %ld with the body tracked; frame to packet %.1f ms "
      "(median), %.1f ms (95 %%)",
      figures.frames,
      figures.seconds,
      figures.tracked,
      1000.0 * figures.times.frame_to_packet.quantile_s(0.5),
      1000.0 * figures.times.frame_to_packet.quantile_s(0.95));
  console.say(text);
  if (figures.behind_s > 0.0) {
    std::snprintf(text,
                  sizeof text,
                  "for %.1f s of it poses did not keep up with the cameras",
                  figures.behind_s);
    console.warn(text);
  }
  for (const LiveCameraFigures& camera : figures.cameras) {
    const long lost = camera.dropped + camera.stale + camera.broken + camera.unused;
    if (lost == 0) continue;
    console.say("camera " + camera.name + ": " + std::to_string(lost) + " of " +
                std::to_string(camera.pictures + camera.dropped) +
                " pictures were not used");
  }
}

LiveWizardOptions wizard_options(const LiveArguments& arguments) {
  return {arguments.calibrate,
          arguments.calibrate && arguments.no_page,
          !arguments.record.empty(),
          arguments.wizard};
}

/// Placeholder body until the subject is measured.
Skeleton average_person(const OpenedLive& live) {
  return make_humanoid(average_proportions(live.prior.stature_m));
}

Exit run(const LiveArguments& arguments, OpenedLive& live, Console& console) {
  auto outputs = open_outputs(arguments, live, console);
  if (!outputs) return console.fail(outputs.error());
  std::optional<LiveChain> chain;
  if (live.body) {
    auto made = LiveChain::make(
        *live.body, live.calibration.cameras, live.avatars, live.settings);
    if (!made) return console.fail(made.error());
    chain.emplace(*std::move(made));
  }
  LiveTakes takes(
      live,
      arguments.record.empty() ? live.folder / "takes" / "live" : arguments.record,
      console);
  std::optional<LiveWizard> wizard;
  if (!live.prior.tags.empty()) {
    wizard.emplace(live, wizard_options(arguments), console);
  }
  std::unique_ptr<LivePage> page;
  if (!arguments.no_page) {
    auto opened = LivePage::open(arguments.page,
                                 live,
                                 chain ? chain->performer() : average_person(live),
                                 wizard ? &*wizard : nullptr);
    if (!opened) return console.fail(opened.error());
    page = *std::move(opened);
  }
  // After all other steps that can fail, because it creates a folder.
  if (!arguments.record.empty()) {
    const Status ok = takes.begin_with_run(arguments.record);
    if (!ok) return console.fail(ok.error());
  }
  if (page && arguments.json) {
    // Standard output is reserved for the figures.
    for (const std::string& address : page->server().addresses) console.say(address);
  } else if (page) {
    print_addresses(page->server(), arguments.page);
  }
  LiveRunOptions options;
  options.seconds = arguments.seconds;
  options.max_wait =
      std::chrono::nanoseconds(static_cast<long long>(1e6 * arguments.wait_ms));
  catch_stop_signals();
  if (!arguments.seconds) console.say("live; Ctrl-C ends it");
  if (live.settings.balance_preview)
    console.say("poses are balanced and sent 0.8 s late");
  auto figures = run_live(live,
                          chain,
                          *outputs,
                          wizard ? &*wizard : nullptr,
                          &takes,
                          page.get(),
                          options,
                          stop_wanted,
                          console);
  if (!figures) {
    (void)takes.finish();
    return console.fail(figures.error());
  }
  Exit exit = Exit::kOk;
  if (arguments.calibrate && !wizard->has_measured()) {
    console.warn("no subject was measured");
    exit = Exit::kQualityGate;
  }
  if (const Status ok = takes.finish(); !ok) exit = console.fail(ok.error());
  figures->recording.reset();
  figures->takes = takes.finished();
  figures->recording_trouble = takes.trouble();
  print_statistics(*figures, console);
  if (arguments.json) std::fputs(live_json_text(*figures).c_str(), stdout);
  return exit;
}

/// Adds the options of VMC: receivers, packets, and commands that are received.
void add_vmc_options(CLI::App& command, LiveArguments& live) {
  command
      .add_option(
          "--vmc", live.vmc, "Receiver of VMC: [AVATAR=]HOST[:PORT]; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--vmc-rest", live.vmc_rest, "Pose without rotations: vrm0 or raw")
      ->check(one_of({"vrm0", "raw"}));
  command
      .add_option("--vmc-mtu",
                  live.vmc_mtu,
                  "Largest packet in bytes; 0: one bundle a frame, as on this machine")
      ->check(zero_or_between(live::kMinPacketBytes, live::kMaxPacketBytes));
  CLI::Option* listens =
      command.add_option("--vmc-listen", live.vmc_listen, "Port to receive commands on")
          ->check(whole_between(1, 65535));
  command.add_flag("--vmc-send-only", live.vmc_send_only, "Receive no commands")
      ->excludes(listens);
  command
      .add_flag("--vmc-deaf", live.vmc_send_only)  // The former name.
      ->excludes(listens)
      ->group("");
}

}  // namespace

Exit run_live_command(const LiveArguments& arguments, Console& console) {
  auto live = open_live(arguments, console);
  if (!live) return console.fail(live.error());
  return run(arguments, *live, console);
}

void add_live_command(CLI::App& app,
                      LiveArguments& live,
                      std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("live", "Track a subject live and move characters");
  command->add_option("SESSION", live.session, "session.toml, or its folder")->required();
  command->add_option("--results",
                      live.results,
                      "Folder with calibration.toml and subject.toml, if not the "
                      "session's");
  command
      ->add_option("--play",
                   live.play,
                   "Play the videos of this trial as cameras; may be repeated, played "
                   "in order")
      ->allow_extra_args(false);
  command->add_flag("--loop", live.loop, "Repeat the played trials endlessly");
  command->add_option("--camera", live.cameras, "Use only this camera; may be repeated")
      ->allow_extra_args(false);
  command->add_option(
      "--media", live.media, "Folder that the session's video paths are relative to");
  command
      ->add_option("-a,--avatar",
                   live.avatars,
                   "Body to retarget to: " + body_extensions() + "; may be repeated")
      ->allow_extra_args(false);
  add_vmc_options(*command, live);
  command
      ->add_option("--vrchat",
                   live.vrchat,
                   "Receiver of VRChat trackers: HOST[:PORT]; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--balance",
                   live.balance,
                   "off, or preview: sends all poses 0.8 s later, moved so that the zero "
                   "moment point stays nearer to the feet that stand")
      ->check(one_of({"off", "preview"}));
  command->add_option("--record", live.record, "Folder for the take of this run");
  command
      ->add_flag("--calibrate",
                 live.calibrate,
                 "Measure the subject first, or again: standing, then moving")
      ->excludes("--record");
  command
      ->add_option("--stand-s", live.wizard.stand_s, "Duration of the standing step [s]")
      ->check(between(0.5, 60.0));
  command
      ->add_option("--move-s",
                   live.wizard.move_s,
                   "Duration of the moving step [s]; up to twice if a part is not seen")
      ->check(between(5.0, 600.0));
  command->add_option("--seconds", live.seconds, "Stop after this time [s]")
      ->check(between(0.001, 1e6));
  command
      ->add_option("--wait-ms", live.wait_ms, "Longest wait for a camera's picture [ms]")
      ->check(between(1.0, 1000.0));
  add_page_options(*command, live.page);
  command->add_flag("--no-page", live.no_page, "Serve no page");
  command->add_flag("--json", live.json, "Print the figures as JSON on standard output");
  command->callback([&] {
    chosen = [&live](Console& console) { return run_live_command(live, console); };
  });
}

}  // namespace marey::app
