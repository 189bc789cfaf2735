// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/segments/trim_idle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "library/quality/activity.h"
#include "library/quality/quality_frames.h"
#include "library/segments/still_frames.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr double kMinIdle_s = 0.5;
constexpr double kKeptIdle_s = 0.25;
constexpr double kMinKept_s = 0.5;
// Twice the half span of still_frames().
constexpr double kJump_s = 0.2;

// Number of frames from `t` on with a mark.
int marked_from(const std::vector<char>& marks, int t) {
  int count = 0;
  while (t + count < static_cast<int>(marks.size()) &&
         marks[static_cast<std::size_t>(t + count)] != 0) {
    ++count;
  }
  return count;
}

// Idle frames at the start.
std::vector<IdleFrames> idle_at_start(const std::vector<char>& in_t_pose,
                                      const std::vector<char>& still,
                                      double hz) {
  const auto count = static_cast<int>(still.size());
  std::vector<IdleFrames> out;
  for (int t = 0; t < count;) {
    if (const int length = marked_from(in_t_pose, t); length > 0) {
      out.push_back({{t, t + length - 1}, "tpose"});
      t += length;
      continue;
    }
    // A cut from the T-pose to another posture looks like a movement.
    int moving = 0;
    while (t > 0 && moving < kJump_s * hz && t + moving < count &&
           still[static_cast<std::size_t>(t + moving)] == 0) {
      ++moving;
    }
    int length = marked_from(still, t + moving);
    if (length - 1 < kMinIdle_s * hz - 1e-9) break;
    length += moving;
    const int next = t + length;
    if (next < count) {
      length -= static_cast<int>(std::lround(kKeptIdle_s * hz));
    }
    if (length > 0) out.push_back({{t, t + length - 1}, "still"});
    break;
  }
  return out;
}

}  // namespace

TrimmedIdle trim_idle(const Motion& motion, const retarget::BodyMap& map) {
  MAREY_ASSERT(!motion.poses.empty());
  const QualityFrames frames = quality_frames(motion, map);
  std::vector<char> in_t_pose = t_pose_frames(frames, map);
  std::vector<char> still = still_frames(frames);
  const int last = frames.count - 1;
  TrimmedIdle out{{0, last}, idle_at_start(in_t_pose, still, frames.hz), {}};
  if (!out.cut.empty()) out.kept.first = out.cut.back().frames.last + 1;
  const std::size_t before = out.cut.size();
  std::reverse(in_t_pose.begin(), in_t_pose.end());
  std::reverse(still.begin(), still.end());
  for (IdleFrames& idle : idle_at_start(in_t_pose, still, frames.hz)) {
    idle.frames = {last - idle.frames.last, last - idle.frames.first};
    out.kept.last = idle.frames.first - 1;
    out.cut.push_back(std::move(idle));
  }
  if (out.kept.last - out.kept.first < kMinKept_s * frames.hz - 1e-9) {
    return {{0, last}, {}, {}};
  }
  std::reverse(out.cut.begin() + static_cast<std::ptrdiff_t>(before), out.cut.end());
  for (std::size_t k = 0; k < out.cut.size(); ++k) {
    const int frame = k < before ? 0 : out.kept.last - out.kept.first;
    out.events.push_back({frame, out.cut[k].name});
  }
  return out;
}

}  // namespace marey::library
