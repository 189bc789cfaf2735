// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "benchmarks/dynamics/svg_drawing.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey {

/// Colours of a body, by distance from the viewer.
struct Colours {
  const char* near_limb;
  const char* trunk;
  const char* far_limb;
};
/// A jump as it is drawn.
struct ShownJump {
  Motion motion;
  std::array<double, 6> times_s{};  ///< P1, P2, P3, apex, P4, P5.
  std::vector<glm::dvec3> com_in_world;
  double rise_m = 0.0;
  double apex_m = 0.0;
  double peak_push_g = 0.0;

  [[nodiscard]] std::size_t frame(double time_s) const {
    const double last = static_cast<double>(motion.poses.size()) - 1.0;
    return static_cast<std::size_t>(
        std::clamp(std::round(time_s * motion.rate.hz), 0.0, last));
  }
  [[nodiscard]] glm::dvec3 com_at(double time_s) const {
    const double last = static_cast<double>(motion.poses.size()) - 1.0;
    const double at = std::clamp(time_s * motion.rate.hz, 0.0, last);
    const auto k = static_cast<std::size_t>(std::min(std::floor(at), last - 1.0));
    return glm::mix(com_in_world[k], com_in_world[k + 1], at - static_cast<double>(k));
  }
};

/// One jump of the picture.
struct JumpPanel {
  double left = 0.0;
  const char* title = "";
  const ShownJump& jump;
  const Colours& colours;
  const ShownJump* captured = nullptr;  ///< Drawn behind; nullptr: this is the captured.
};

/// Width of a panel, and height of the picture of all panels. [px]
inline constexpr double kPanelWidth = 362.0;
inline constexpr double kPictureHeight = 620.0;

/// Draws the bodies at P1 to P5 and the apex, the track of the centre of mass, and its
/// height over time. Bodies are seen from `right_in_world` to the right; heights are
/// true.
void draw_panel(Drawing& drawing,
                const retarget::BodyMap& map,
                const glm::dvec3& right_in_world,
                const JumpPanel& panel);

}  // namespace marey
