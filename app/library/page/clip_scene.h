// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "app/view/view_page.h"
#include "core/base/result.h"
#include "core/motion.h"

namespace marey::app {

/// A motion that is shown next to the chosen clip, and the part that corresponds to it.
struct ComparedMotion {
  std::string name;
  Motion motion;
  double start_s = 0.0;  ///< Since its first frame.
  double end_s = 0.0;
};

/// A scene for the page, and the step of its frames.
struct ClipScene {
  PageOfRecording page;
  int frame_step = 1;  ///< Each frame of the scene is this number of frames of the clip.
};

/// Frames of a scene at most; longer clips are shown with fewer frames per second.
inline constexpr std::size_t kMaxSceneFrames = 6000;

/// Places a clip and other motions in lanes, each from the front, from the start
/// of its part on. The parts run as fast as the first `compared_s` seconds of the clip,
/// so that they begin and end together; after that a motion continues to its end.
/// Media are numbered from `first_media` on. Linear in frames times joints.
/// Preconditions: motions are in normal form, have poses and a positive rate.
[[nodiscard]] Result<ClipScene> make_clip_scene(const std::string& name,
                                                const Motion& clip,
                                                double compared_s,
                                                std::span<const ComparedMotion> others,
                                                std::size_t first_media);

}  // namespace marey::app
