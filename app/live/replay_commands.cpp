// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/replay_commands.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include <nlohmann/json.hpp>

#include "app/live_chain/live_chain.h"
#include "app/live_chain/live_outputs.h"
#include "app/live_chain/live_results.h"
#include "app/live_chain/open_live_take.h"
#include "app/shell/option_checks.h"
#include "app/shell/stop_signal.h"
#include "core/base/input_file.h"

namespace marey::app {
namespace {

/// Result of a replay.
struct Replayed {
  long frames = 0;
  long differing = 0;
  std::optional<std::int64_t> first_differing;
};

/// Waits for the time of an instant. Returns false if the user stops the replay.
bool wait_until(std::chrono::steady_clock::time_point instant) {
  constexpr std::chrono::milliseconds kLook{50};
  while (!stop_wanted()) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= instant) return true;
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(instant - now, kLook));
  }
  return false;
}

/// Plans the targets of the replay. The packets are those of the recorded streams,
/// independent of their recorded targets.
Result<LiveOutputs> open_outputs(const ReplayArguments& arguments,
                                 const OpenedTake& opened) {
  LiveSettings wanted;
  wanted.avatars = opened.settings.avatars;
  std::vector<StreamTargets> targets;
  const Status ok = plan_streams(arguments.vmc, {}, 0, wanted, targets);
  if (!ok) return ok.error();
  std::vector<VmcStream> streams = opened.settings.streams;
  for (VmcStream& stream : streams) stream.listen_port.reset();
  std::vector<StreamTargets> by_stream(streams.size());
  for (std::size_t w = 0; w < wanted.streams.size(); ++w) {
    std::size_t s = 0;
    while (s < streams.size() && streams[s].avatar != wanted.streams[w].avatar) ++s;
    if (s == streams.size()) {
      return bad_input(arguments.take.string(),
                       "the recorded run has no packets of that body",
                       "record with --vmc");
    }
    for (const live::UdpAddress& address : targets[w].addresses) {
      by_stream[s].addresses.push_back(address);
    }
  }
  return LiveOutputs::open(streams, by_stream);
}

Result<Replayed> replay(const ReplayArguments& arguments,
                        const OpenedTake& opened,
                        LiveChain& chain,
                        LiveOutputs& outputs,
                        const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  const std::string file = (arguments.take / recordings::kLiveTakeFile).string();
  Clock::time_point begin = Clock::now();
  const auto& instants = opened.take.instants;
  Replayed found;
  std::vector<std::byte> results;
  // An instant without results belongs to the lead-in of a take.
  const auto first = std::ranges::find_if(
      instants, [](const auto& one) { return !one.results.empty(); });
  for (const recordings::LiveTakeInstant& one : instants) {
    const bool leads_in = one.results.empty();
    if (!arguments.fast && !leads_in) {
      const auto since_first = one.seen.time - first->seen.time;
      const auto later = std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(seconds(since_first) / arguments.speed));
      if (!wait_until(begin + later)) break;
    } else if (stop_wanted()) {
      break;
    }
    const auto requests = parse_live_requests(one.requests, file);
    if (!requests) return requests.error();
    const LiveResult& result = chain.step(one.seen, *requests);
    if (leads_in) {
      begin = Clock::now();
      continue;
    }
    outputs.send(result);
    write_results(result, results);
    ++found.frames;
    if (results != one.results) {
      ++found.differing;
      if (!found.first_differing) found.first_differing = one.seen.number;
    }
    if (progress) {
      progress(static_cast<int>(found.frames), static_cast<int>(instants.size()));
    }
  }
  return found;
}

Status check_take_folder(const std::filesystem::path& take) {
  std::error_code ignored;
  if (std::filesystem::is_directory(take, ignored)) return Done{};
  if (!std::filesystem::exists(take, ignored)) return check_input_file(take);
  return bad_input(take.string(),
                   "this is a file, not the folder of a take",
                   "name the folder that marey live --record made");
}

void print(const Replayed& found) {
  nlohmann::ordered_json out{{"frames", found.frames}, {"differing", found.differing}};
  out["first_differing"] = found.first_differing
                               ? nlohmann::ordered_json(*found.first_differing)
                               : nlohmann::ordered_json(nullptr);
  std::fputs((out.dump(2) + "\n").c_str(), stdout);
}

}  // namespace

Exit run_replay(const ReplayArguments& arguments, Console& console) {
  if (const Status ok = check_take_folder(arguments.take); !ok) {
    return console.fail(ok.error());
  }
  const auto opened = open_live_take(arguments.take);
  if (!opened) return console.fail(opened.error());
  if (!opened->take.finished) {
    console.warn("the recording was cut off; the recorded part is replayed");
  }
  auto outputs = open_outputs(arguments, *opened);
  if (!outputs) return console.fail(outputs.error());
  auto chain = LiveChain::make(
      opened->body, opened->calibration.cameras, opened->avatars, opened->settings);
  if (!chain) return console.fail(chain.error());
  catch_stop_signals();
  const auto found =
      replay(arguments, *opened, *chain, *outputs, console.stage("replay"));
  if (!found) return console.fail(found.error());
  if (arguments.json) print(*found);
  if (found->differing > 0) {
    return console.fail({Errc::kQuality,
                         arguments.take.string(),
                         std::to_string(found->differing) + " of " +
                             std::to_string(found->frames) +
                             " frames differ from the recording, "
                             "the first one is number " +
                             std::to_string(*found->first_differing),
                         "replay it with the version of marey that recorded it"});
  }
  if (found->frames == 0 && !stop_wanted()) {
    return console.fail({Errc::kQuality,
                         arguments.take.string(),
                         "the take holds no frame to compare",
                         "record again, with the body tracked for some seconds"});
  }
  console.say(std::to_string(found->frames) +
              " frames, each with the same bytes as live");
  return Exit::kOk;
}

void add_replay_command(CLI::App& app,
                        ReplayArguments& args,
                        std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("replay", "Repeat a recorded live run; it sends the same bytes");
  command->add_option("TAKE", args.take, "Folder written by marey live --record")
      ->required();
  command->add_option("--vmc", args.vmc, "Receiver of the packets: [AVATAR=]HOST[:PORT]")
      ->allow_extra_args(false);
  command->add_option("--speed", args.speed, "Speed factor: 1 is the recorded speed")
      ->check(between(0.01, 100.0));
  command->add_flag("--fast", args.fast, "Replay without pauses");
  command->add_flag("--json", args.json, "Print the figures as JSON");
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_replay(args, console); }; });
}

}  // namespace marey::app
