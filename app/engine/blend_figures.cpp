// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/blend_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "edit/find/peak_acceleration.h"
#include "engine/clips/sample_clip.h"
#include <glm/geometric.hpp>

#include "core/base/in_quotes.h"
#include "core/pose.h"
#include "retarget/contacts/measure_contacts.h"

namespace marey::app {
namespace {

constexpr double kBlendSlide_s = 0.3;
constexpr double kBlendPeak_s = 0.5;

/// Position in contact_paths() of each ClipFootPart: ankles, then toe joints.
constexpr std::array<std::size_t, 4> kPointOfPart{0, 2, 1, 3};

double horizontal_cm_s(const glm::dvec3& from, const glm::dvec3& to) {
  return 100.0 * std::hypot(to.x - from.x, to.z - from.z) * kBlendRate_hz;
}

/// Returns the frame of a clip on the body at a time, never the first one.
std::size_t own_frame(const MotionClip& clip, double time_s, std::size_t frames) {
  double in_clip_s = time_s;
  if (clip.loops) {
    in_clip_s -= std::floor(time_s / clip.duration_s()) * clip.duration_s();
  }
  const auto frame = std::lround(in_clip_s * kBlendRate_hz);
  return static_cast<std::size_t>(std::clamp(frame, 1L, static_cast<long>(frames) - 1));
}

/// Paths of the feet of a motion, as far as the body has them.
std::optional<BlendSlide> measure_slide(const BlendArguments& args,
                                        const BlendInputs& inputs,
                                        const PlayedBlend& played,
                                        const std::array<Motion, 2>& clips) {
  const auto paths = retarget::contact_paths(played.motion, inputs.map);
  const std::array own_paths{retarget::contact_paths(clips[0], inputs.map),
                             retarget::contact_paths(clips[1], inputs.map)};
  const double window_s = std::max(kBlendSlide_s, args.fade_s);
  const auto first = static_cast<std::size_t>(played.switch_frame) + 1;
  const std::size_t end =
      std::min(first + static_cast<std::size_t>(std::lround(window_s * kBlendRate_hz)),
               played.frames.size());
  BlendSlide out;
  double sum = 0.0;
  double own_sum = 0.0;
  int count = 0;
  for (std::size_t t = first; t < end; ++t) {
    const BlendFrame& frame = played.frames[t];
    const std::size_t heavier = frame.weight[1] >= frame.weight[0] ? 1 : 0;
    const MotionClip& clip = heavier == 1 ? inputs.to_clip() : inputs.from_clip();
    const unsigned bears = engine::bearing_at(clip, frame.source_s[heavier]);
    for (std::size_t part = 0; part < kPointOfPart.size(); ++part) {
      const auto& path = paths[kPointOfPart[part]];
      const auto& own = own_paths[heavier][kPointOfPart[part]];
      if ((bears >> part & 1U) == 0 || path.empty() || own.size() < 2) continue;
      const double slide_cm_s = horizontal_cm_s(path[t - 1], path[t]);
      const std::size_t at = own_frame(clip, frame.source_s[heavier], own.size());
      sum += slide_cm_s;
      own_sum += horizontal_cm_s(own[at - 1], own[at]);
      out.worst_cm_s = std::max(out.worst_cm_s, slide_cm_s);
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  out.mean_cm_s = sum / count;
  out.clips_mean_cm_s = own_sum / count;
  return out;
}

void measure_acceleration(const PlayedBlend& played,
                          const std::array<Motion, 2>& clips,
                          BlendFigures& out) {
  const auto around = static_cast<int>(std::lround(kBlendPeak_s * kBlendRate_hz));
  const int last = static_cast<int>(played.motion.poses.size()) - 1;
  const edit::PeakAcceleration peak =
      edit::peak_acceleration(played.motion,
                              {std::max(played.switch_frame - around, 0),
                               std::min(played.switch_frame + around, last)});
  const double of_clips = std::max(edit::peak_acceleration(clips[0]).m_per_s2,
                                   edit::peak_acceleration(clips[1]).m_per_s2);
  // Clips in which nothing moves have no scale.
  out.acceleration_ratio = of_clips > 0.0 ? peak.m_per_s2 / of_clips : 0.0;
  out.accelerated_bone = peak.bone;
  out.accelerated_s = peak.frame / kBlendRate_hz;
}

double hips_departure_cm(const BlendInputs& inputs, const PlayedBlend& played) {
  double farthest_m = 0.0;
  for (std::size_t t = 0; t < played.motion.poses.size(); ++t) {
    const auto world = world_from_joints(played.motion.skeleton, played.motion.poses[t]);
    farthest_m = std::max(farthest_m,
                          glm::distance(played.blend_hips_in_world[t],
                                        world[index(inputs.map.hips())].translation));
  }
  return 100.0 * farthest_m;
}

std::string transition_word(const BlendArguments& args, const PlayedBlend& played) {
  if (played.transition.is_synchronised) return "synchronised";
  if (played.transition.is_inertial) return "inertial";
  return args.kind == "cut" ? "cut" : "crossfade";
}

}  // namespace

BlendFigures measure_blend(const BlendArguments& args,
                           const BlendInputs& inputs,
                           const PlayedBlend& played) {
  const std::array clips{clip_on_body(inputs, inputs.from),
                         clip_on_body(inputs, inputs.to)};
  BlendFigures out;
  out.transition = transition_word(args, played);
  out.entry_s = played.entry_s;
  const bool has_labels =
      inputs.base->has_contacts(inputs.from) && inputs.base->has_contacts(inputs.to);
  const bool is_planned = args.kind == "auto" || args.kind == "synchronised";
  if (has_labels && is_planned) out.incompatible_s = played.transition.incompatible_s;
  out.slide = measure_slide(args, inputs, played, clips);
  measure_acceleration(played, clips, out);
  out.hips_departure_cm = hips_departure_cm(inputs, played);
  for (const std::size_t clip : {inputs.from, inputs.to}) {
    if (inputs.base->has_contacts(clip)) continue;
    out.remarks.push_back("the clip " + in_quotes(inputs.base->clip(clip).name) +
                          " has no contacts of the feet: its supports are unknown");
    if (inputs.from == inputs.to) break;
  }
  return out;
}

}  // namespace marey::app
