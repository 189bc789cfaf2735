// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey {

/// Rate of all clips of the measurement: that of CMU's recordings.
inline constexpr double kTransitionRate_hz = 120.0;

/// Foot points: left ankle, right ankle, left toe joint, right toe joint.
inline constexpr std::size_t kFootPoints = 4;

/// Frames in which each foot point bears, per point and frame.
using BearingLabels = std::array<std::vector<char>, kFootPoints>;

/// A clip between which transitions are measured. Its root joint is the hips.
struct TransitionClip {
  std::string name;
  Motion motion;  ///< At kTransitionRate_hz.
  retarget::BodyMap map;
  /// Places of the foot points in the world, per point and frame; empty: no toes.
  std::array<std::vector<glm::dvec3>, kFootPoints> foot_paths;
  BearingLabels bearing;   ///< label_bearing() of `motion`.
  bool is_cyclic = false;  ///< Repeats a gait: it may be entered in any cycle.

  [[nodiscard]] int frame_count() const { return static_cast<int>(motion.poses.size()); }
  [[nodiscard]] double duration_s() const {
    return (frame_count() - 1) / kTransitionRate_hz;
  }
};

/// Marks the frames in which each foot point bears: its speed (central difference) is
/// below 50 cm/s, and it is less than 5 cm above its resting height, the 2nd percentile
/// of its own heights. Independent of the contact detection of retarget/ and edit/.
[[nodiscard]] BearingLabels label_bearing(const Motion& motion,
                                          const retarget::BodyMap& map);

/// Returns the label of a point at a time of the clip: that of the nearest frame, the
/// first or last one beyond the ends.
[[nodiscard]] bool bears_at(const TransitionClip& clip, std::size_t point, double time_s);

/// Returns the horizontal speed of a point in the step that ends at the nearest frame; 0
/// for missing toes. [cm/s]
[[nodiscard]] double own_slide_cm_s(const TransitionClip& clip,
                                    std::size_t point,
                                    double time_s);

/// Makes a clip of a motion at any rate. Errors: those of map_body().
[[nodiscard]] Result<TransitionClip> make_transition_clip(std::string name,
                                                          const Motion& motion,
                                                          bool is_cyclic);

/// The clips of the measurement.
struct TransitionClips {
  TransitionClip walk;  ///< CMU 02_01
  TransitionClip run;   ///< CMU 02_03
  TransitionClip bandai_walk;
  TransitionClip bandai_kick;
  TransitionClip bandai_dance;
};

/// Reads the clips from the folder that holds `cmu_asfamc` and `bandai`. Errors: a file
/// is missing or cannot be read.
[[nodiscard]] Result<TransitionClips> read_transition_clips(
    const std::filesystem::path& mocap);

}  // namespace marey
