// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/markers/marker_subject.h"
#include "reconstruct/tracks/find_marker_faults.h"
#include "reconstruct/tracks/repair_gaps.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

/// Errors that are added to the tracks.
struct Harm {
  const char* name;
  double dropped = 0.0;  ///< Share of the samples, in gaps of 0.1 to 1 s.
  int swaps = 0;         ///< Exchanges of two labels, for 0.2 to 1.5 s.
  double noise_m = 0.0;  ///< Standard deviation per coordinate.
  double spikes = 0.0;   ///< Share of the samples that are 5 to 10 cm off.
};

using testing::Dice;

std::size_t below(std::size_t count, Dice& dice) {
  const double place = dice.between(0.0, static_cast<double>(count));
  return std::min(static_cast<std::size_t>(place), count - 1);
}

/// A range of frames with a random start.
struct Stretch {
  std::size_t first, end;
};

Stretch stretch(Dice& dice, const MarkerTracks& tracks, double min_s, double max_s) {
  const auto frames =
      static_cast<std::size_t>(std::lround(dice.between(min_s, max_s) * tracks.rate.hz));
  const std::size_t first = below(tracks.frames(), dice);
  return {first, std::min(first + frames, tracks.frames())};
}

void swap_labels(MarkerTracks& tracks, int swaps, Dice& dice) {
  for (int i = 0; i < swaps; ++i) {
    const std::size_t a = below(tracks.markers(), dice);
    const std::size_t b = (a + 1 + below(tracks.markers() - 1, dice)) % tracks.markers();
    const Stretch s = stretch(dice, tracks, 0.2, 1.5);
    for (std::size_t f = s.first; f < s.end; ++f) {
      std::swap(tracks.at(f, a), tracks.at(f, b));
    }
  }
}

void drop(MarkerTracks& tracks, double share, Dice& dice) {
  std::size_t there = 0;
  for (const auto& sample : tracks.samples) there += sample ? 1U : 0U;
  auto left = static_cast<std::size_t>(share * static_cast<double>(there));
  while (left > 0) {
    const std::size_t marker = below(tracks.markers(), dice);
    const Stretch s = stretch(dice, tracks, 0.1, 1.0);
    for (std::size_t f = s.first; f < s.end && left > 0; ++f) {
      if (!tracks.at(f, marker)) continue;
      tracks.at(f, marker).reset();
      --left;
    }
  }
}

MarkerTracks harmed(const MarkerTracks& clean, const Harm& harm, std::uint64_t seed) {
  MarkerTracks out = clean;
  Dice dice(seed);
  for (auto& sample : out.samples) {
    if (!sample) continue;
    for (int i = 0; i < 3; ++i) sample->p_in_world[i] += dice.noise(harm.noise_m);
    if (dice.between(0.0, 1.0) >= harm.spikes) continue;
    sample->p_in_world += dice.between(0.05, 0.10) * dice.direction();
  }
  swap_labels(out, harm.swaps, dice);
  drop(out, harm.dropped, dice);
  return out;
}

/// Checks and repairs the tracks, as a user does before the fit.
MarkerTracks repaired(const MarkerTracks& raw) {
  return reconstruct::repair_gaps(reconstruct::find_marker_faults(raw).tracks).tracks;
}

void compare(const Motion& mine, const Motion& clean, const std::string& name) {
  const auto a = joints_of(mine);
  const auto b = joints_of(clean);
  Distances all;
  std::vector<Distances> by_joint(clean.skeleton.joints.size());
  for (std::size_t f = 0; f < b.size(); ++f) {
    for (std::size_t j = 0; j < b[f].size(); ++j) {
      const double off = glm::distance(a[f][j], b[f][j]);
      all.add(off);
      by_joint[j].add(off);
    }
  }
  std::size_t worst = 0;
  for (std::size_t j = 0; j < by_joint.size(); ++j) {
    if (by_joint[j].mean_mm() > by_joint[worst].mean_mm()) worst = j;
  }
  std::printf("%-34s mean %5.1f  p95 %5.1f  max %6.1f mm; worst joint %s, mean %.1f\n",
              name.c_str(),
              all.mean_mm(),
              all.quantile_mm(0.95),
              all.quantile_mm(1.0),
              clean.skeleton.joints[worst].name.c_str(),
              by_joint[worst].mean_mm());
}

}  // namespace

int measure_dropouts(const std::filesystem::path& mocap) {
  const std::vector<std::filesystem::path> files{mocap /
                                                 "nimblephysics/c3d/cmu_02_05.c3d"};
  const MarkerPerson person = read_person(files);
  const MarkerTracks& tracks = person.trials[0];
  const auto clean = solve(person.fit.body, tracks);
  const std::vector<Harm> harms{
      {"nothing (checked, repaired)"},
      {"20 % dropped", 0.2},
      {"12 swaps", 0.0, 12},
      {"noise 3 mm", 0.0, 0, 0.003},
      {"0.5 % spikes", 0.0, 0, 0.0, 0.005},
      {"all of them", 0.2, 12, 0.003, 0.005},
  };
  std::printf("joints against those of the clean tracks, all %zu\n",
              clean.estimate.motion.skeleton.joints.size());
  const auto measure = [&](const Harm& harm, std::uint64_t seed, std::string name) {
    const std::vector<MarkerTracks> trials{repaired(harmed(tracks, harm, seed))};
    const Body body = fit_person(trials).body;
    compare(solve(body, trials[0]).estimate.motion, clean.estimate.motion, name);
    name = "  with the clean tracks' body";
    compare(
        solve(person.fit.body, trials[0]).estimate.motion, clean.estimate.motion, name);
  };
  for (const Harm& harm : harms) measure(harm, 1, harm.name);
  for (const std::uint64_t seed : {2U, 3U}) {
    measure(harms.back(), seed, "all of them, seed " + std::to_string(seed));
  }
  return 0;
}

}  // namespace marey
