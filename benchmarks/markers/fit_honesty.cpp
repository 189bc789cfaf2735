// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/markers/fit_honesty.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

#include "app/markers/complete_markers.h"
#include "core/pose.h"
#include "reconstruct/tracks/repair_gaps.h"

namespace marey::benchmarks {
namespace {

// The 95 % and 99 % points of chi squared with three degrees of freedom.
constexpr double kChi2At95 = 7.815;
constexpr double kChi2At99 = 11.345;

double squared(const glm::dvec3& v) {
  return glm::dot(v, v);
}

/// "UpperArm" of "leftUpperArm".
std::string without_side(HumanBone bone) {
  std::string text(name(bone));
  for (const std::string side : {"left", "right"}) {
    if (text.starts_with(side)) return text.substr(side.size());
  }
  return text;
}

}  // namespace

void FitHonesty::add_joints(const Body& person,
                            const testing::Movement& movement,
                            const reconstruct::SolvedMarkers& solved) {
  const Skeleton skeleton = make_humanoid(person.proportions);
  const EstimatedMotion& estimate = solved.estimate;
  for (std::size_t f = 0; f < estimate.motion.poses.size(); f += 5) {
    const double time_s = static_cast<double>(f) / estimate.motion.rate.hz;
    const auto truth = world_from_joints(skeleton, movement(time_s));
    const auto ours =
        world_from_joints(estimate.motion.skeleton, estimate.motion.poses[f]);
    for (const HumanBone bone : testing::limb_joints()) {
      const JointUncertainty& uncertainty = estimate.uncertainty[f][index(bone)];
      if (uncertainty.source != Source::kMeasured) continue;
      const double square =
          squared(truth[index(bone)].translation - ours[index(bone)].translation) /
          (uncertainty.sigma_m * uncertainty.sigma_m);
      squares_["joint " + without_side(bone)].push_back(square);
      squares_["joints"].push_back(square);
    }
  }
}

void FitHonesty::add_hidden_markers(int seed,
                                    const Body& body,
                                    const MarkerTracks& tracks) {
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t marker =
        (static_cast<std::size_t>(seed) * 7 + i * 11) % tracks.markers();
    const std::size_t first = tracks.frames() / 4;
    const std::size_t last = first + tracks.frames() / 2;
    MarkerTracks hidden = tracks;
    for (std::size_t f = first; f < last; ++f) hidden.at(f, marker).reset();
    const auto solved = reconstruct::solve_markers(body, hidden);
    if (!solved) continue;
    const MarkerTracks completed = app::complete_markers(body, *solved, hidden).tracks;
    const MarkerTracks repaired = reconstruct::repair_gaps(hidden, {}).tracks;
    for (std::size_t f = first; f < last; f += 5) {
      const auto& truth = tracks.at(f, marker);
      if (!truth) continue;
      const auto add = [&](const std::string& kind, const MarkerTracks& found) {
        const auto& sample = found.at(f, marker);
        if (!sample || sample->sigma_m <= 0.0F) return;
        squares_[kind].push_back(squared(sample->p_in_world - truth->p_in_world) /
                                 (sample->sigma_m * sample->sigma_m));
      };
      add("hidden markers by the skeleton", completed);
      add("hidden markers by repair of gaps", repaired);
    }
  }
}

void FitHonesty::print() const {
  std::printf("\n%-34s samples  within 95 %%  99 %%  median of errors, sigmas\n", "");
  for (const auto& [kind, squares] : squares_) {
    const auto share = [&, &all = squares](double limit) {
      const auto inside =
          std::count_if(all.begin(), all.end(), [&](double s) { return s <= limit; });
      return 100.0 * static_cast<double>(inside) / static_cast<double>(all.size());
    };
    std::vector<double> sorted = squares;
    std::sort(sorted.begin(), sorted.end());
    std::printf("%-34s %7zu %8.1f %8.1f %8.2f\n",
                kind.c_str(),
                squares.size(),
                share(kChi2At95),
                share(kChi2At99),
                std::sqrt(sorted[sorted.size() / 2] / 3.0));
  }
}

}  // namespace marey::benchmarks
