// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/provenance.h"
#include "core/time.h"

namespace marey {

struct PointSample {
  glm::dvec3 p_in_world{0.0};  ///< [m]
  double sigma_m = 0.0;        ///< Standard deviation per coordinate.
  int views = 0;               ///< Cameras that support it.
  Source source = Source::kMeasured;
};

/// One named point over time: a marker, a tag corner. nullopt where it is not known.
struct PointTrack {
  std::string label;
  FrameRate rate;
  std::vector<std::optional<PointSample>> samples;
};

}  // namespace marey
