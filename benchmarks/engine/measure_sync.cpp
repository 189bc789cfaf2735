// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_sync CMU_FOLDER BANDAI_FOLDER
//
// Cost of plan_sync() over random pairs of phase tables, and plans for captured clips:
// 24 random instants of the lead for each pair, the follower asked for at a random place
// (walk and run) or at its start (kick, dance), with an entry of 0.5 s. Kick and dance
// start with both feet on the floor; "within" is a random place in them.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "engine/sync/plan_sync.h"

#include "benchmarks/parts/stand_as_marey.h"
#include "core/motion.h"
#include "recordings/motion/asf.h"
#include "recordings/motion/bvh.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::engine {
namespace {

struct SyncClip {
  std::vector<Phase> phases;
  double duration_s = 0.0;
};

[[noreturn]] void stop(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  std::exit(1);
}

SyncClip clip_of(Motion motion, const retarget::FileUnit& unit) {
  const auto frame = stand_as_marey(unit, motion);
  if (!frame) stop(frame.error());
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) stop(map.error());
  const Contacts contacts = retarget::detect_contacts(motion, *map);
  MotionClip clip;
  clip.rate_hz = static_cast<float>(motion.rate.hz);
  clip.frames.resize(motion.poses.size());
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const auto add = [&](std::size_t part, const std::vector<FrameRange>& ranges) {
      for (const FrameRange& range : ranges) {
        clip.contacts[2 * foot + part].push_back(
            {(static_cast<float>(range.first) - 0.5F) / clip.rate_hz,
             (static_cast<float>(range.last) + 0.5F) / clip.rate_hz});
      }
    };
    add(0, contacts.feet[foot].heel);
    add(1, contacts.feet[foot].ball);
  }
  return {phases_of(clip, 0.03), clip.duration_s()};
}

SyncClip read_cmu(const std::filesystem::path& folder, const std::string& name) {
  const auto skeleton = recordings::read_asf(folder / "02.asf");
  if (!skeleton) stop(skeleton.error());
  const auto amc = recordings::read_amc(folder / name, *skeleton);
  if (!amc) stop(amc.error());
  return clip_of(amc->motion, {1.0, true});
}

SyncClip read_bandai(const std::filesystem::path& folder, const std::string& name) {
  const auto bvh =
      recordings::read_bvh(folder / ("dataset-1_" + name + "_normal_001.bvh"));
  if (!bvh) stop(bvh.error());
  return clip_of(bvh->motion, {0.01, false});
}

void measure_pair(const char* name,
                  const SyncClip& lead,
                  const SyncClip& follower,
                  bool from_start,
                  double horizon_s) {
  std::mt19937_64 random(7);
  const auto place = [&](double duration_s) {
    return std::uniform_real_distribution<double>(
        0.0, std::max(0.1, duration_s - 1.2))(random);
  };
  int fits = 0;
  int unplanned_fits = 0;
  int inertial = 0;
  std::vector<double> incompatible_s;
  for (int i = 0; i < 24; ++i) {
    const SyncSide a{lead.phases, lead.duration_s, false, place(lead.duration_s), 1.0};
    const SyncSide b{follower.phases,
                     follower.duration_s,
                     false,
                     from_start ? 0.0 : place(follower.duration_s),
                     1.0};
    const SyncPlan plan = plan_sync(a, b, {.horizon_s = horizon_s, .entry_s = 0.5});
    fits += plan.incompatible_s < 0.05 ? 1 : 0;
    unplanned_fits += incompatible_time_s(a, b, horizon_s) < 0.05 ? 1 : 0;
    inertial += plan.only_inertial ? 1 : 0;
    incompatible_s.push_back(plan.incompatible_s);
  }
  std::sort(incompatible_s.begin(), incompatible_s.end());
  std::printf("%-14s %4d / 24 %12d / 24 %10d / 24 %16.3f\n",
              name,
              fits,
              unplanned_fits,
              inertial,
              incompatible_s[12]);
}

std::vector<Phase> random_phases(std::mt19937_64& random) {
  std::vector<Phase> phases;
  double t = 0.0;
  while (phases.size() < 8) {
    const auto feet = static_cast<PhaseClass>(random() % 4);
    if (!phases.empty() && feet == phases.back().feet) continue;
    const double end_s = t + std::uniform_real_distribution<double>(0.08, 0.4)(random);
    phases.push_back({feet, t, end_s});
    t = end_s;
  }
  return phases;
}

void measure_cost(bool loops) {
  std::mt19937_64 random(8);
  std::vector<double> cost_us;
  double sum = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const auto a = random_phases(random);
    const auto b = random_phases(random);
    const SyncSide lead{a, a.back().end_s, true, 0.3, 1.0};
    const SyncSide follower{b, b.back().end_s, loops, 0.4, 1.0};
    const auto before = std::chrono::steady_clock::now();
    sum += plan_sync(lead, follower, {.entry_s = 0.5}).cost;
    cost_us.push_back(std::chrono::duration<double, std::micro>(
                          std::chrono::steady_clock::now() - before)
                          .count());
  }
  std::sort(cost_us.begin(), cost_us.end());
  std::printf(
      "plan_sync, 8 phases each, follower %s: %.1f us median, %.1f p99 (cost %.2f)\n",
      loops ? "loops" : "plays once",
      cost_us[1000],
      cost_us[1980],
      sum / 2000);
}

int measure(const std::filesystem::path& cmu, const std::filesystem::path& bandai) {
  measure_cost(false);
  measure_cost(true);
  const SyncClip walk = read_cmu(cmu, "02_01.amc");
  const SyncClip run = read_cmu(cmu, "02_03.amc");
  const SyncClip slow = read_bandai(bandai, "walk");
  const SyncClip kick = read_bandai(bandai, "kick");
  const SyncClip dance = read_bandai(bandai, "dance-short");
  std::printf("%-14s %9s %17s %15s %16s\n",
              "lead > follower",
              "< 0.05 s",
              "without plan",
              "only inertial",
              "incompatible [s]");
  for (const double horizon_s : {1.2, 0.6, 0.3}) {
    std::printf("horizon %.1f s\n", horizon_s);
    measure_pair("walk > run", walk, run, false, horizon_s);
    measure_pair("run > walk", run, walk, false, horizon_s);
    measure_pair("walk > walk", walk, walk, false, horizon_s);
    measure_pair("walk > kick", slow, kick, true, horizon_s);
    measure_pair("walk > dance", slow, dance, true, horizon_s);
    measure_pair("> within kick", slow, kick, false, horizon_s);
    measure_pair("> within dance", slow, dance, false, horizon_s);
  }
  return 0;
}

}  // namespace
}  // namespace marey::engine

int main(int count, char** words) {
  if (count != 3) {
    std::fprintf(stderr, "usage: measure_sync CMU_FOLDER BANDAI_FOLDER\n");
    return 2;
  }
  return marey::engine::measure(words[1], words[2]);
}
