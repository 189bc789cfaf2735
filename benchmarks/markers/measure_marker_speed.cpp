// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "benchmarks/markers/marker_subject.h"
#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/program/thread_time.h"

namespace marey {
namespace {

MarkerTracks repeated(const MarkerTracks& once, int times) {
  MarkerTracks out = once;
  out.samples.clear();
  out.samples.reserve(once.samples.size() * static_cast<std::size_t>(times));
  for (int i = 0; i < times; ++i) {
    out.samples.insert(out.samples.end(), once.samples.begin(), once.samples.end());
  }
  return out;
}

void measure_batch(const char* name, const Body& body, const MarkerTracks& tracks) {
  constexpr int kRuns = 9;
  std::vector<double> ms;
  for (int run = 0; run < kRuns; ++run) {
    const double start_s = testing::thread_time_s();
    const auto solved = solve(body, tracks);
    ms.push_back(1e3 * (testing::thread_time_s() - start_s) /
                 static_cast<double>(tracks.frames()));
  }
  std::printf(
      "batch, %s: %zu markers of the body, %zu labels, %zu frames: median %.3f, "
      "best %.3f ms a frame of %d runs\n",
      name,
      body.markers.size(),
      tracks.markers(),
      tracks.frames(),
      median(ms),
      quantile(ms, 0.0),
      kRuns);
}

struct Live {
  std::vector<double> ms;
  Motion motion;
  std::vector<double> numbers;  ///< All poses, concatenated.
  long allocations = 0;         ///< After the first pose.
};

Live run_live(const Body& body, const MarkerTracks& tracks) {
  Live out;
  reconstruct::MarkerTracker tracker(body, tracks.labels, tracks.rate);
  out.motion.skeleton = tracker.skeleton();
  Pose pose;
  std::vector<JointUncertainty> uncertainty;
  bool first = true;
  out.ms.reserve(tracks.frames());
  out.numbers.reserve(tracks.frames() * (3 + 4 * kHumanBoneCount));
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    const auto frame =
        std::span(tracks.samples).subspan(f * tracks.markers(), tracks.markers());
    const long before = testing::allocations();
    const double start_s = testing::thread_time_s();
    const bool solved = tracker.step(frame, pose, uncertainty);
    out.ms.push_back(1e3 * (testing::thread_time_s() - start_s));
    if (!solved) continue;
    if (!first) out.allocations += testing::allocations() - before;
    first = false;
    out.motion.poses.push_back(pose);
    for (int i = 0; i < 3; ++i) out.numbers.push_back(pose.root_in_world[i]);
    for (const glm::dquat& q : pose.parent_from_joint) {
      for (int i = 0; i < 4; ++i) out.numbers.push_back(q[i]);
    }
  }
  return out;
}

void measure_live(const char* name, const Body& body, const MarkerTracks& tracks) {
  const Live live = run_live(body, tracks);
  const Live again = run_live(body, tracks);
  const bool same = live.numbers.size() == again.numbers.size() &&
                    std::memcmp(live.numbers.data(),
                                again.numbers.data(),
                                live.numbers.size() * sizeof(double)) == 0;
  // Every frame of these takes has a pose.
  MAREY_ASSERT(live.motion.poses.size() == tracks.frames());
  const auto there = joints_of(live.motion);
  const auto back = joints_of(solve(body, tracks).estimate.motion);
  Distances apart;
  for (std::size_t f = 0; f < back.size(); ++f) {
    for (std::size_t j = 0; j < back[f].size(); ++j) {
      apart.add(glm::distance(there[f][j], back[f][j]));
    }
  }
  std::printf(
      "live, %s: %zu markers, median %.3f, p99 %.3f, worst %.3f ms (first %.3f); "
      "%ld allocations after the first; a second run %s; joints %.1f mm (p95 %.1f) from "
      "batch\n",
      name,
      body.markers.size(),
      median(live.ms),
      quantile(live.ms, 0.99),
      quantile(live.ms, 1.0),
      live.ms.front(),
      live.allocations,
      same ? "has the same bytes" : "DIFFERS",
      apart.mean_mm(),
      apart.quantile_mm(0.95));
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Returns the resident memory of this process.
double held_mb() {
  // Returns freed memory to the system first.
  malloc_trim(0);
  std::ifstream statm("/proc/self/statm");
  long pages = 0;
  statm >> pages >> pages;
  return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) /
         1024.0 / 1024.0;
}

/// Measures the memory for the solve of a take, in a separate process. Prints the
/// increase of resident memory by the result, and the peak above the memory after the
/// solve.
void measure_memory(const Body& body, const MarkerTracks& once, int times) {
  std::fflush(stdout);
  static_cast<void>(held_mb());
  const pid_t child = fork();
  if (child == 0) {
    const MarkerTracks tracks = repeated(once, times);
    const double before_mb = held_mb();
    const auto solved = solve(body, tracks);
    const double peak = peak_mb();
    const double after_mb = held_mb();
    std::printf(
        "memory, %zu frames: the result takes %.1f MB, solving %.1f MB beyond it\n",
        solved.estimate.motion.poses.size(),
        after_mb - before_mb,
        peak - after_mb);
    std::fflush(stdout);
    _exit(0);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || status != 0) {
    stop("the process whose memory is measured did not end well");
  }
}

}  // namespace

int measure_speed(const std::filesystem::path& mocap) {
  const auto hamner = mocap / "opensim-models/Hamner";
  const std::vector<std::filesystem::path> runner_files{hamner / "subject02_static.trc",
                                                        hamner / "subject02_running.trc"};
  const std::vector<std::filesystem::path> cmu_files{mocap /
                                                     "nimblephysics/c3d/cmu_02_05.c3d"};
  const MarkerPerson runner = read_person(runner_files);
  const MarkerPerson boxer = read_person(cmu_files);
  measure_batch("Hamner static", runner.fit.body, runner.trials[0]);
  measure_batch("Hamner running", runner.fit.body, runner.trials[1]);
  measure_batch("cmu_02_05", boxer.fit.body, boxer.trials[0]);
  measure_live("Hamner running", runner.fit.body, runner.trials[1]);
  measure_live("cmu_02_05", boxer.fit.body, boxer.trials[0]);
  measure_memory(boxer.fit.body, boxer.trials[0], 1);
  measure_memory(boxer.fit.body, boxer.trials[0], 8);
  return 0;
}

}  // namespace marey
