// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_jumps DATA [FOLDER...]
//
// Compares the events of jumps (dynamics/jumps/find_jumps.h) and those of find_flights()
// with force plates. Prints the states and accelerations of captured jumps and the time
// of a search. Counts the jumps of the BVH and AMC files below the folders, and the ones
// that independent evidence contradicts. DATA is the shared data.
// docs/accuracy/dynamics.md has figures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "dynamics/flight/find_flights.h"
#include "dynamics/jumps/find_jumps.h"

#include "benchmarks/dynamics/jump_clips.h"
#include "benchmarks/dynamics/jump_library.h"
#include "benchmarks/markers/marker_subject.h"
#include "core/base/quantile.h"
#include "core/base/stopwatch.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

// Take-off speed of DJ1 by the impulse on its plates.
constexpr double kPlateSpeed_m_s = 2.46;

/// A flight as found, by any method.
struct FoundFlight {
  double takeoff_s = 0.0;
  double landing_s = 0.0;
};

class EdgeErrors {
 public:
  void add(double late_ms) { late_ms_.push_back(late_ms); }
  [[nodiscard]] std::string row() const {
    if (late_ms_.empty()) return "none";
    double sum = 0.0;
    std::vector<double> sizes;
    for (const double ms : late_ms_) {
      sum += ms;
      sizes.push_back(std::abs(ms));
    }
    std::sort(sizes.begin(), sizes.end());
    const double n = static_cast<double>(sizes.size());
    const auto most = static_cast<std::size_t>(std::ceil(0.9 * n)) - 1;
    std::array<char, 80> text{};
    std::snprintf(text.data(),
                  text.size(),
                  "%+5.1f, 90 %% %4.1f, worst %4.1f",
                  sum / n,
                  sizes[most],
                  sizes.back());
    return text.data();
  }

 private:
  std::vector<double> late_ms_;
};

void compare_edges(const JumpClip& clip,
                   const char* method,
                   const std::vector<FoundFlight>& found) {
  EdgeErrors takeoff;
  EdgeErrors landing;
  int matched = 0;
  for (const PlateFlight& truth : clip.plate_flights) {
    for (const FoundFlight& one : found) {
      if (one.takeoff_s > truth.landing_s || one.landing_s < truth.takeoff_s) continue;
      takeoff.add(1e3 * (one.takeoff_s - truth.takeoff_s));
      landing.add(1e3 * (one.landing_s - truth.landing_s));
      ++matched;
      break;
    }
  }
  std::printf("%-14s %-12s %2d of %2zu (%2zu found)  take-off %s  landing %s\n",
              clip.name.c_str(),
              method,
              matched,
              clip.plate_flights.size(),
              found.size(),
              takeoff.row().c_str(),
              landing.row().c_str());
}

std::vector<FoundFlight> with_landing(const std::vector<dynamics::Jump>& jumps) {
  std::vector<FoundFlight> out;
  for (const auto& jump : jumps) {
    if (jump.touchdown) out.push_back({jump.takeoff.time_s, jump.touchdown->time_s});
  }
  return out;
}

void measure_events(const std::vector<JumpClip>& clips) {
  std::printf("Events against plates, ms, late is positive: mean, 90 %%, worst.\n");
  for (const JumpClip& clip : clips) {
    if (clip.loads.empty()) continue;
    compare_edges(clip, "find_jumps", with_landing(dynamics::find_jumps(clip.track)));
    std::vector<FoundFlight> peer;
    for (const auto& flight : dynamics::find_flights(clip.motion)) {
      peer.push_back({flight.takeoff_s, flight.landing_s});
    }
    compare_edges(clip, "find_flights", peer);
  }
}

void print_jump(const JumpClip& clip, const dynamics::Jump& jump) {
  std::printf(
      "%-14s P1 %.3f P2 %.3f P3 %.3f P4 %.3f P5 %.3f s, up %.3f m/s, rise %.3f m, "
      "falls at %.2f (rising %.2f, falling %.2f) m/s^2, off the parabola %.1f mm rms\n",
      clip.name.c_str(),
      jump.start.time_s,
      jump.lowest_s,
      jump.takeoff.time_s,
      jump.touchdown ? jump.touchdown->time_s : -1.0,
      jump.rest ? jump.rest->time_s : -1.0,
      jump.takeoff.velocity_m_s.y,
      jump.rise_m(),
      jump.fall_m_s2,
      jump.fall_rising_m_s2,
      jump.fall_falling_m_s2,
      1e3 * jump.flight_rms_m);
  for (const Finding& finding : jump.findings) {
    std::printf("%-14s   %s\n", "", finding.message().c_str());
  }
}

void measure_states(const std::vector<JumpClip>& clips) {
  std::printf("\nJumps (-1: not in the clip).\n");
  for (const JumpClip& clip : clips) {
    if (clip.kind != "jump") continue;
    for (const auto& jump : dynamics::find_jumps(clip.track)) {
      print_jump(clip, jump);
      if (clip.plate_flights.size() != 1 ||
          std::abs(jump.takeoff.time_s - clip.plate_flights[0].takeoff_s) > 0.1) {
        continue;
      }
      const double speed_m_s = jump.takeoff.velocity_m_s.y;
      std::printf("%-14s   take-off speed %.3f m/s, plates %.2f m/s: %+.1f %%\n",
                  "",
                  speed_m_s,
                  kPlateSpeed_m_s,
                  100.0 * (speed_m_s / kPlateSpeed_m_s - 1.0));
    }
  }
}

// Runs without plates, kept apart: constants were chosen on other recordings.
void measure_kept_apart(const fs::path& mocap) {
  const fs::path folder = mocap / "addbiomechanics/Expert2";
  const std::array<fs::path, 2> files{folder / "run0350cms.trc",
                                      folder / "run0900cms.trc"};
  if (!fs::exists(files[0]) || !fs::exists(files[1])) return;
  const MarkerPerson person = read_person(files);
  std::printf("\nRuns kept apart, without plates.\n");
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto clip =
        jump_clip_of(files[k].stem().string(),
                     "run",
                     solve(person.fit.body, person.trials[k]).estimate.motion);
    if (!clip) stop(clip.error().message());
    const auto jumps = dynamics::find_jumps(clip->track);
    int takeoffs = 0;
    int landings = 0;
    std::vector<double> falls;
    for (const auto& jump : jumps) {
      takeoffs += jump.takeoff_source == Source::kMeasured ? 1 : 0;
      landings += jump.landing_source == Source::kMeasured ? 1 : 0;
      falls.push_back(jump.fall_m_s2);
    }
    std::printf(
        "%-14s %zu flights (find_flights %zu), by the feet: take-off %d, landing "
        "%d; fall %.2f m/s^2, %.2f to %.2f\n",
        clip->name.c_str(),
        jumps.size(),
        dynamics::find_flights(clip->motion).size(),
        takeoffs,
        landings,
        falls.empty() ? 0.0 : median(falls),
        falls.empty() ? 0.0 : *std::min_element(falls.begin(), falls.end()),
        falls.empty() ? 0.0 : *std::max_element(falls.begin(), falls.end()));
  }
}

void measure_time(const std::vector<JumpClip>& clips) {
  for (const JumpClip& clip : clips) {
    if (clip.name != "rendered jump") continue;
    std::vector<double> times_ms;
    std::size_t found = 0;
    for (int k = 0; k < 101; ++k) {
      const Stopwatch watch;
      found += dynamics::find_jumps(clip.track).size();
      times_ms.push_back(1e3 * watch.seconds());
    }
    std::printf(
        "\nTime of find_jumps(): %.3f ms, median of %zu, %zu frames (%zu found)\n",
        median(times_ms),
        times_ms.size(),
        clip.frames(),
        found / times_ms.size());
  }
}

int measure_jumps(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: measure_jumps DATA [FOLDER...]\n");
    return 2;
  }
  const auto clips = jump_clips(argv[1]);
  measure_events(clips);
  measure_states(clips);
  measure_kept_apart(fs::path(argv[1]) / "mocap");
  measure_time(clips);
  for (int k = 2; k < argc; ++k) measure_library(argv[k]);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::measure_jumps(argc, argv);
}
