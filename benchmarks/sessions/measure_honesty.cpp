// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Part of measure_accuracy: errors of joint centres against the sigmas they come with.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "benchmarks/sessions/accuracy_parts.h"
#include "core/base/quantile.h"
#include "core/humanoid.h"
#include "core/source.h"
#include "recordings/motion/motion_tables.h"
#include "tests/support/truth/truth.h"

namespace marey::benchmarks {
namespace {

// The 95 % and 99 % points of chi squared with three degrees of freedom.
constexpr double kChi2At95 = 7.815;
constexpr double kChi2At99 = 11.345;

/// Squared errors in sigmas, and sigmas.
struct Sample {
  double squared = 0.0;
  double sigma_mm = 0.0;
};
using Samples = std::vector<Sample>;

void print(const char* what, const Samples& samples) {
  if (samples.empty()) return;
  const auto share = [&](double limit) {
    const auto inside =
        std::count_if(samples.begin(), samples.end(), [&](const Sample& s) {
          return s.squared <= limit;
        });
    return 100.0 * static_cast<double>(inside) / static_cast<double>(samples.size());
  };
  std::vector<double> squared;
  std::vector<double> sigmas_mm;
  double sum = 0.0;
  for (const Sample& s : samples) {
    squared.push_back(s.squared);
    sigmas_mm.push_back(s.sigma_mm);
    sum += s.squared;
  }
  std::printf(
      "  %-14s %6zu  within 95 %%: %5.1f %%  99 %%: %5.1f %%  error / sigma RMS %5.2f, "
      "median %5.2f  sigma median %5.1f mm\n",
      what,
      samples.size(),
      share(kChi2At95),
      share(kChi2At99),
      std::sqrt(sum / (3.0 * static_cast<double>(samples.size()))),
      std::sqrt(quantile(squared, 0.5) / 3.0),
      quantile(sigmas_mm, 0.5));
}

}  // namespace

bool measure_honesty(const AccuracyCase& a) {
  Samples all;
  std::map<Source, Samples> by_source;
  std::map<HumanBone, Samples> by_joint;
  for (const std::string& trial : a.trials) {
    const auto rows = recordings::read_joints_csv(a.out / trial / "joints.csv");
    const auto segments = recordings::read_segments_csv(a.out / trial / "segments.csv");
    const auto places = testing::truth_joints(a.truth / trial / "truth" / "joints.csv");
    if (!rows || !segments || !places) {
      std::fprintf(stderr, "%s: no joints, segments or truth\n", trial.c_str());
      return false;
    }
    std::map<std::pair<int, std::string>, Source> sources;
    for (const auto& row : *segments) sources[{row.frame, row.segment}] = row.source;
    std::map<Source, Samples> here;
    for (const auto& row : *rows) {
      const auto bone = human_bone(row.joint);
      if (!bone) continue;
      const auto place = places->find({row.frame, *bone});
      if (place == places->end()) continue;
      const double off = glm::distance(row.p_in_world, place->second) / row.sigma_m;
      const Sample sample{off * off, 1e3 * row.sigma_m};
      here[sources.at({row.frame, row.joint})].push_back(sample);
      by_joint[*bone].push_back(sample);
    }
    std::printf("%s: joint centres against their sigmas\n", trial.c_str());
    Samples together;
    for (const auto& [source, samples] : here) {
      print(std::string(name(source)).c_str(), samples);
      together.insert(together.end(), samples.begin(), samples.end());
      by_source[source].insert(by_source[source].end(), samples.begin(), samples.end());
    }
    print("all", together);
    all.insert(all.end(), together.begin(), together.end());
  }
  std::printf("all trials: joint centres against their sigmas\n");
  for (const auto& [source, samples] : by_source) {
    print(std::string(name(source)).c_str(), samples);
  }
  print("all", all);
  for (const auto& [bone, samples] : by_joint) {
    print(std::string(name(bone)).c_str(), samples);
  }
  return true;
}

}  // namespace marey::benchmarks
