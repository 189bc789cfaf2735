// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/dynamics/jump_library.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "dynamics/jumps/find_jumps.h"

#include "benchmarks/dynamics/jump_clips.h"
#include "core/base/parallel.h"
#include "core/base/quantile.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

// Words in the names of clips that leave the floor.
constexpr std::array kFlightWords{"run", "dash", "jump", "hop"};

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

}  // namespace

void measure_library(const std::filesystem::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto ending = entry.path().extension();
    if (ending == ".bvh" || ending == ".amc") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<ClipResult> results(files.size());
  in_parallel(
      files.size(), 2, [&](std::size_t i) { results[i] = search_file(files[i]); });
  std::printf("\n%s: %zu files\n", folder.c_str(), files.size());
  print_library(results);
}

}  // namespace marey
