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
#include <map>
#include <string>
#include <vector>

#include "dynamics/flight/find_flights.h"
#include "dynamics/jumps/find_jumps.h"

#include "benchmarks/dynamics/jump_clips.h"
#include "core/base/parallel.h"
#include "core/base/quantile.h"
#include "core/base/stopwatch.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

// Take-off speed of DJ1 by the impulse on its plates.
constexpr double kPlateSpeed_m_s = 2.46;

// Words in the names of clips that leave the floor.
constexpr std::array kFlightWords{"run", "dash", "jump", "hop"};

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

/// Evidence against a found flight. It does not use the rules of find_jumps().
struct Contradictions {
  bool low = false;       ///< The lowest sole stays within 20 mm of its stances.
  bool fall = false;      ///< Over 0.15 s and more, not at 9.81 +- 3 m/s^2.
  bool length = false;    ///< Longer than 0.8 s.
  bool inferred = false;  ///< Neither end is confirmed by a foot.

  [[nodiscard]] bool any() const { return low || fall || length; }
};

double lowest_sole(const BodyTrack& track, int frame) {
  double low_m = 1e9;
  for (const SoleTrack& sole : track.soles) {
    const auto i = static_cast<std::size_t>(frame);
    low_m = std::min({low_m,
                      sole.heel_in_world[i].y,
                      sole.ball_in_world[i].y,
                      sole.tip_in_world[i].y});
  }
  return low_m;
}

Contradictions contradictions(const BodyTrack& track, const dynamics::Jump& jump) {
  Contradictions out;
  const double hz = track.rate.hz;
  const int last = static_cast<int>(track.com_in_world.size()) - 1;
  const double end_s = jump.touchdown ? jump.touchdown->time_s : last / hz;
  // Median of the lowest sole over 0.15 s before and after.
  const auto stance_m = [&](double from_s, double to_s) {
    std::vector<double> heights;
    const int first = std::clamp(static_cast<int>(std::floor(from_s * hz)), 0, last);
    const int end = std::clamp(static_cast<int>(std::ceil(to_s * hz)), first, last);
    for (int i = first; i <= end; ++i) heights.push_back(lowest_sole(track, i));
    return median(heights);
  };
  const double before_m = stance_m(jump.takeoff.time_s - 0.15, jump.takeoff.time_s);
  const double after_m = jump.touchdown ? stance_m(end_s, end_s + 0.15) : before_m;
  double clear_m = -1.0;
  const int first = static_cast<int>(std::ceil(jump.takeoff.time_s * hz));
  for (int i = first; i <= std::min(last, static_cast<int>(end_s * hz)); ++i) {
    const double share =
        (i / hz - jump.takeoff.time_s) / std::max(1e-6, end_s - jump.takeoff.time_s);
    clear_m = std::max(clear_m,
                       lowest_sole(track, i) - before_m - share * (after_m - before_m));
  }
  out.low = clear_m < 0.02;
  const double flight_s = end_s - jump.takeoff.time_s;
  out.fall = flight_s >= 0.15 && std::abs(jump.fall_m_s2 + 9.81) > 3.0;
  out.length = flight_s > 0.8;
  out.inferred = jump.takeoff_source == Source::kInferred &&
                 jump.landing_source == Source::kInferred;
  return out;
}

/// Content of a clip by its file's name: the word after the number of the set.
std::string content_of(const std::string& name) {
  const std::size_t first = name.find('_');
  if (!name.starts_with("dataset-") || first == std::string::npos) return "other";
  return name.substr(first + 1, name.find('_', first + 1) - first - 1);
}

bool is_named_flight(const std::string& name) {
  return std::any_of(kFlightWords.begin(), kFlightWords.end(), [&](const char* word) {
    return name.find(word) != std::string::npos;
  });
}

struct ContentCount {
  int clips = 0;
  int clips_with = 0;
  int jumps = 0;
  int contradicted = 0;
};

struct ClipResult {
  std::string name;
  std::string error;
  std::vector<dynamics::Jump> jumps;
  std::vector<Contradictions> evidence;
};

ClipResult search_file(const fs::path& file) {
  ClipResult out;
  out.name = file.stem().string();
  const auto clip = read_jump_clip(file, "clip");
  if (!clip) {
    out.error = clip.error().message();
    return out;
  }
  out.jumps = dynamics::find_jumps(clip->track);
  for (const auto& jump : out.jumps) {
    out.evidence.push_back(contradictions(clip->track, jump));
  }
  return out;
}

void print_library(const std::vector<ClipResult>& results) {
  std::map<std::string, ContentCount> by_content;
  int low = 0;
  int fall = 0;
  int length = 0;
  int inferred = 0;
  for (const ClipResult& one : results) {
    ContentCount& count = by_content[content_of(one.name)];
    if (!one.error.empty()) {
      std::printf("%s\n", one.error.c_str());
      continue;
    }
    ++count.clips;
    if (!one.jumps.empty()) {
      ++count.clips_with;
    } else if (is_named_flight(one.name)) {
      std::printf("  %-40s no jump\n", one.name.c_str());
    }
    for (std::size_t i = 0; i < one.jumps.size(); ++i) {
      const Contradictions& c = one.evidence[i];
      ++count.jumps;
      count.contradicted += c.any() ? 1 : 0;
      low += c.low ? 1 : 0;
      fall += c.fall ? 1 : 0;
      length += c.length ? 1 : 0;
      inferred += c.inferred ? 1 : 0;
      const auto& jump = one.jumps[i];
      if (c.any() || content_of(one.name) == "other") {
        std::printf("  %-40s %.3f to %.3f s, rise %.3f m, falls at %.1f%s%s%s%s\n",
                    one.name.c_str(),
                    jump.takeoff.time_s,
                    jump.touchdown ? jump.touchdown->time_s : -1.0,
                    jump.rise_m(),
                    jump.fall_m_s2,
                    c.low ? ", soles stay low" : "",
                    c.fall ? ", not free fall" : "",
                    c.length ? ", too long" : "",
                    c.inferred ? ", no foot" : "");
      }
    }
  }
  for (const auto& [content, count] : by_content) {
    std::printf("%-28s %4d clips, %4d with a jump, %4d jumps, %3d contradicted\n",
                content.c_str(),
                count.clips,
                count.clips_with,
                count.jumps,
                count.contradicted);
  }
  std::printf(
      "contradicted: soles stay low %d, not free fall %d, too long %d; not "
      "confirmed by a foot at either end %d\n",
      low,
      fall,
      length,
      inferred);
}

int measure_jumps(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: measure_jumps DATA [FOLDER...]\n");
    return 2;
  }
  const auto clips = jump_clips(argv[1]);
  measure_events(clips);
  measure_states(clips);
  measure_time(clips);
  for (int k = 2; k < argc; ++k) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(argv[k])) {
      const auto ending = entry.path().extension();
      if (ending == ".bvh" || ending == ".amc") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<ClipResult> results(files.size());
    in_parallel(
        files.size(), 2, [&](std::size_t i) { results[i] = search_file(files[i]); });
    std::printf("\n%s: %zu files\n", argv[k], files.size());
    print_library(results);
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::measure_jumps(argc, argv);
}
