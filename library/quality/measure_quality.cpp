// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/measure_quality.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "library/quality/activity.h"
#include "library/quality/body_checks.h"
#include "library/quality/discontinuities.h"
#include "library/quality/exchanged_limbs.h"
#include "library/quality/explain_problems.h"
#include "library/quality/feet_on_floor.h"
#include "library/quality/flight_rate.h"
#include "library/quality/floor_tilt.h"
#include "library/quality/joint_certainty.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"
#include "library/quality/rotation_faults.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

std::string joint_name(const std::optional<HumanBone>& bone) {
  return bone ? std::string(name(*bone)) : std::string();
}

/// Turns found figures into verdicts and problems.
class Judge {
 public:
  Judge(const QualityLimits& limits, int count)
      : limits_(limits), all_frames_{0, std::max(0, count - 1)} {}

  template <class Figures>
  void add(const Figures& figures) {
    for (const FoundFigure& figure : figures) add_one(figure);
  }

  [[nodiscard]] QualityResult result() && {
    remove_explained(out_.problems);
    out_.main_kind = main_kind(out_.problems, limits_.rules());
    std::sort(out_.figures.begin(), out_.figures.end(), [](const auto& a, const auto& b) {
      return a.name < b.name;
    });
    std::sort(
        out_.problems.begin(), out_.problems.end(), [](const auto& a, const auto& b) {
          return std::tie(a.frames.first, a.kind, a.joint, a.frames.last, a.value) <
                 std::tie(b.frames.first, b.kind, b.joint, b.frames.last, b.value);
        });
    return std::move(out_);
  }

 private:
  void add_one(const FoundFigure& figure) {
    const auto verdict = limits_.verdict(figure.name, figure.value);
    out_.figures.push_back({std::string(figure.name),
                            figure.value,
                            verdict,
                            joint_name(figure.bone),
                            figure.frames});
    if (!verdict || *verdict == Verdict::kPass) return;
    out_.quality = std::max(out_.quality, *verdict);
    const std::string kind(limits_[figure.name].kind);
    for (const FoundPlace& place : figure.places) {
      out_.problems.push_back({place.frames, kind, joint_name(place.bone), place.value});
    }
    if (!figure.places.empty() || !limits_[figure.name].is_outside) return;
    out_.problems.push_back({figure.frames.value_or(all_frames_),
                             kind,
                             joint_name(figure.bone),
                             figure.value});
  }

  const QualityLimits& limits_;
  FrameRange all_frames_;
  QualityResult out_;
};

}  // namespace

QualityResult measure_quality(const LibraryMotion& clip,
                              const retarget::BodyMap& map,
                              std::span<const QualityLimit> own_limits,
                              std::span<const FoundFigure> outside) {
  MAREY_ASSERT(clip.motion.rate.hz > 0.0);
  MAREY_ASSERT(clip.contacts.empty() || clip.contacts.size() == clip.motion.poses.size());
  const QualityLimits limits(own_limits);
  const QualityFrames frames = quality_frames(clip.motion, map);
  Judge judge(limits, frames.count);
  for (const FoundFigure& figure : outside) {
    MAREY_ASSERT(limits[figure.name].is_outside);
  }
  judge.add(outside);
  judge.add(check_body(frames, map, limits));
  judge.add(find_exchanged_limbs(frames, limits));
  judge.add(measure_flight_rate(frames, limits));
  judge.add(find_rotation_faults(frames, clip.motion, limits));
  judge.add(find_discontinuities(frames, limits));
  judge.add(measure_feet_on_floor(frames, clip.contacts, limits));
  judge.add(std::array{measure_tilt(frames, clip.contacts, limits)});
  judge.add(measure_certainty(clip, map, limits));
  judge.add(measure_activity(frames, map));
  return std::move(judge).result();
}

}  // namespace marey::library
