// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Part of measure_accuracy: how segments are turned, and frames that are missing.
#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "benchmarks/sessions/accuracy_parts.h"
#include "core/base/quantile.h"
#include "core/humanoid.h"
#include "core/source.h"
#include "core/transform.h"
#include "recordings/motion/motion_tables.h"
#include "tests/support/truth/truth.h"

namespace marey::benchmarks {
namespace {

constexpr double kFlipDeg = 60.0;

struct Turn {
  std::size_t trial = 0;
  Source source = Source::kInferred;
  glm::dquat truth_from_found{1, 0, 0, 0};
};

/// The rotation whose angles to all others have the least sum (Weiszfeld, on vectors in
/// its tangent).
glm::dquat middle_of(const std::vector<Turn>& turns) {
  // Starts from the best of a few, so that it cannot start from a flip.
  const auto sum_from = [&](const glm::dquat& q) {
    double sum = 0.0;
    for (const Turn& t : turns) {
      sum += glm::length(rotation_vector(glm::conjugate(q) * t.truth_from_found));
    }
    return sum;
  };
  glm::dquat middle = turns.front().truth_from_found;
  constexpr std::size_t kStarts = 20;
  for (std::size_t i = 0; i < kStarts; ++i) {
    const glm::dquat& other = turns[i * turns.size() / kStarts].truth_from_found;
    if (sum_from(other) < sum_from(middle)) middle = other;
  }
  constexpr int kRounds = 50;
  for (int round = 0; round < kRounds; ++round) {
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (const Turn& t : turns) {
      const glm::dvec3 off = rotation_vector(glm::conjugate(middle) * t.truth_from_found);
      const double weight = 1.0 / std::max(1e-6, glm::length(off));
      sum += weight * off;
      weights += weight;
    }
    middle = glm::normalize(middle * rotation_from_vector(sum / weights));
  }
  return middle;
}

void print(const char* what, const std::vector<double>& errors_deg) {
  if (errors_deg.empty()) return;
  const auto flips = std::count_if(
      errors_deg.begin(), errors_deg.end(), [](double e) { return e > kFlipDeg; });
  std::printf("  %-14s median %5.2f  p95 %5.2f  max %6.2f deg, %td flips in %zu\n",
              what,
              quantile(errors_deg, 0.5),
              quantile(errors_deg, 0.95),
              quantile(errors_deg, 1.0),
              flips,
              errors_deg.size());
}

using TurnsBySegment = std::map<HumanBone, std::vector<Turn>>;

bool read_trial(const AccuracyCase& a, std::size_t number, TurnsBySegment& turns) {
  const std::string& trial = a.trials[number];
  const auto rows = recordings::read_segments_csv(a.out / trial / "segments.csv");
  const auto truth = testing::truth_rotations(a.truth / trial / "truth" / "segments.csv");
  if (!rows || !truth) {
    std::fprintf(stderr, "%s: no segments.csv or no truth of it\n", trial.c_str());
    return false;
  }
  std::set<int> true_frames;
  for (const auto& [key, rotation] : *truth) true_frames.insert(key.first);
  std::map<int, int> found_in;  // Segments with a row, by frame.
  std::set<int> trunk_known;
  for (const auto& row : *rows) {
    const auto bone = human_bone(row.segment);
    const auto is = bone ? truth->find({row.frame, *bone}) : truth->end();
    if (is == truth->end()) continue;
    ++found_in[row.frame];
    const bool trunk = *bone == HumanBone::kHips || *bone == HumanBone::kUpperChest;
    if (trunk && row.source != Source::kInferred) trunk_known.insert(row.frame);
    turns[*bone].push_back(
        {number,
         row.source,
         glm::conjugate(is->second) * row.world_from_segment.rotation});
  }
  const std::size_t segments = truth->size() / true_frames.size();
  const auto lost = std::count_if(true_frames.begin(), true_frames.end(), [&](int frame) {
    return found_in[frame] != static_cast<int>(segments);
  });
  const auto blind =
      std::count_if(true_frames.begin(), true_frames.end(), [&](int frame) {
        return !trunk_known.contains(frame);
      });
  std::printf(
      "%s: %zu frames, %td without a row of every segment, %td with neither hips "
      "nor chest seen or bridged\n",
      trial.c_str(),
      true_frames.size(),
      lost,
      blind);
  return true;
}

}  // namespace

bool measure_segments(const AccuracyCase& a) {
  TurnsBySegment turns;
  for (std::size_t i = 0; i < a.trials.size(); ++i) {
    if (!read_trial(a, i, turns)) return false;
  }
  std::vector<double> all;
  std::vector<std::vector<double>> by_trial(a.trials.size());
  std::map<Source, std::vector<double>> by_source;
  std::printf("segments, turned away from the truth by\n");
  for (const auto& [bone, of_bone] : turns) {
    const glm::dquat constant = middle_of(of_bone);
    std::vector<double> errors;
    for (const Turn& t : of_bone) {
      const double off_deg = glm::degrees(
          glm::length(rotation_vector(glm::conjugate(constant) * t.truth_from_found)));
      errors.push_back(off_deg);
      by_trial[t.trial].push_back(off_deg);
      by_source[t.source].push_back(off_deg);
    }
    print(std::string(name(bone)).c_str(), errors);
    all.insert(all.end(), errors.begin(), errors.end());
  }
  for (const auto& [source, errors] : by_source) {
    print(std::string(name(source)).c_str(), errors);
  }
  for (std::size_t i = 0; i < a.trials.size(); ++i) {
    print(a.trials[i].c_str(), by_trial[i]);
  }
  print("all", all);
  return true;
}

}  // namespace marey::benchmarks
