// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/segments/still_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

namespace marey::library {
namespace {

constexpr double kStillSpeed_m_s = 0.05;
constexpr double kHalfSpan_s = 0.1;

}  // namespace

std::vector<char> still_frames(const QualityFrames& frames) {
  std::vector<char> out(static_cast<std::size_t>(frames.count), 1);
  const auto half = std::max(1, static_cast<int>(std::lround(kHalfSpan_s * frames.hz)));
  for (int t = 0; t < frames.count; ++t) {
    const int before = std::max(0, t - half);
    const int after = std::min(frames.count - 1, t + half);
    const double limit_m = kStillSpeed_m_s * (after - before) / frames.hz;
    const bool moves =
        std::any_of(frames.bones.begin(), frames.bones.end(), [&](const BonePath& bone) {
          return !bone.empty() &&
                 glm::distance(bone.p_in_world[static_cast<std::size_t>(after)],
                               bone.p_in_world[static_cast<std::size_t>(before)]) >
                     limit_m;
        });
    if (moves) out[static_cast<std::size_t>(t)] = 0;
  }
  return out;
}

std::vector<FrameRange> runs_of(const std::vector<char>& marks, double hz, double min_s) {
  std::vector<FrameRange> out;
  for (std::size_t t = 0; t < marks.size(); ++t) {
    if (marks[t] == 0) continue;
    FrameRange run{static_cast<int>(t), static_cast<int>(t)};
    while (t + 1 < marks.size() && marks[t + 1] != 0) run.last = static_cast<int>(++t);
    if (run.last - run.first >= min_s * hz - 1e-9) out.push_back(run);
  }
  return out;
}

}  // namespace marey::library
