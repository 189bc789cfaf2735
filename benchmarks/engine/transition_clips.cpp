// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/transition_clips.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "benchmarks/parts/captured_clips.h"
#include "core/base/quantile.h"
#include "core/pose.h"
#include "core/resample.h"
#include "retarget/contacts/measure_contacts.h"

namespace marey {
namespace {

constexpr double kBearingSpeed_m_s = 0.5;
constexpr double kBearingHeight_m = 0.05;
constexpr double kRestingShare = 0.02;

std::vector<char> label_point(const std::vector<glm::dvec3>& path, double hz) {
  std::vector<char> labels(path.size(), 0);
  if (path.size() < 3) return labels;
  std::vector<double> heights;
  for (const glm::dvec3& p_in_world : path) heights.push_back(p_in_world.y);
  const double low_m = quantile(heights, kRestingShare) + kBearingHeight_m;
  for (std::size_t t = 0; t < path.size(); ++t) {
    const std::size_t before = t == 0 ? 0 : t - 1;
    const std::size_t after = std::min(t + 1, path.size() - 1);
    const double speed_m_s = glm::length(path[after] - path[before]) * hz /
                             static_cast<double>(after - before);
    labels[t] = speed_m_s < kBearingSpeed_m_s && path[t].y < low_m ? 1 : 0;
  }
  return labels;
}

Result<TransitionClip> read_transition_clip(const std::filesystem::path& file,
                                            std::string name,
                                            bool is_cyclic) {
  auto clip = read_clip(file, name);
  if (!clip) return clip.error();
  const Motion motion{clip->character.skeleton, {clip->rate_hz}, 0, clip->poses};
  return make_transition_clip(std::move(name), motion, is_cyclic);
}

}  // namespace

BearingLabels label_bearing(const Motion& motion, const retarget::BodyMap& map) {
  const auto paths = retarget::contact_paths(motion, map);
  BearingLabels out;
  for (std::size_t point = 0; point < kFootPoints; ++point) {
    out[point] = label_point(paths[point], motion.rate.hz);
  }
  return out;
}

double own_slide_cm_s(const TransitionClip& clip, std::size_t point, double time_s) {
  const auto& path = clip.foot_paths[point];
  if (path.size() < 2) return 0.0;
  const auto last = static_cast<long>(path.size()) - 1;
  const auto t = static_cast<std::size_t>(
      std::clamp(std::lround(time_s * clip.motion.rate.hz), 1L, last));
  const glm::dvec3 step_m = path[t] - path[t - 1];
  return 100.0 * std::hypot(step_m.x, step_m.z) * clip.motion.rate.hz;
}

bool bears_at(const TransitionClip& clip, std::size_t point, double time_s) {
  const auto& marks = clip.bearing[point];
  if (marks.empty()) return false;
  const auto last = static_cast<long>(marks.size()) - 1;
  const long frame = std::clamp(std::lround(time_s * clip.motion.rate.hz), 0L, last);
  return marks[static_cast<std::size_t>(frame)] != 0;
}

Result<TransitionClip> make_transition_clip(std::string name,
                                            const Motion& motion,
                                            bool is_cyclic) {
  auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  TransitionClip out{std::move(name),
                     resample(motion, {kTransitionRate_hz}),
                     *std::move(map),
                     {},
                     {},
                     is_cyclic};
  out.foot_paths = retarget::contact_paths(out.motion, out.map);
  out.bearing = label_bearing(out.motion, out.map);
  return out;
}

Result<TransitionClips> read_transition_clips(const std::filesystem::path& mocap) {
  struct File {
    TransitionClip TransitionClips::*clip;
    const char* path;
    const char* name;
    bool is_cyclic = false;
  };
  TransitionClips clips;
  for (const File& file :
       {File{&TransitionClips::walk, "cmu_asfamc/02_01.amc", "walk", true},
        File{&TransitionClips::run, "cmu_asfamc/02_03.amc", "run", true},
        File{&TransitionClips::bandai_walk,
             "bandai/dataset-1_walk_normal_001.bvh",
             "walk (Bandai)",
             true},
        File{&TransitionClips::bandai_kick,
             "bandai/dataset-1_kick_normal_001.bvh",
             "kick (Bandai)"},
        File{&TransitionClips::bandai_dance,
             "bandai/dataset-1_dance-short_normal_001.bvh",
             "dance (Bandai)"}}) {
    auto clip = read_transition_clip(mocap / file.path, file.name, file.is_cyclic);
    if (!clip) return clip.error();
    clips.*file.clip = *std::move(clip);
  }
  return clips;
}

}  // namespace marey
