// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/camera.h"
#include "core/detection.h"

namespace marey::tests {

/// A rendered session of the shared data with its truth: where every corner of every tag
/// was, and the cameras. The world is the data's own (Z up); only pixels leave here.
struct RenderedTruth {
  std::filesystem::path folder;
  std::vector<Camera> cameras;
  /// Per camera: by how many frames it is late. A session's clock is the first camera's.
  std::vector<double> late_frames;
  /// By frame and tag: the corners in the world, in TagDetection's order. [m]
  std::map<std::pair<int, int>, std::array<glm::dvec3, 4>> corners_in_world;

  [[nodiscard]] std::filesystem::path video(std::size_t camera) const {
    return folder / ("cam" + std::to_string(camera) + ".mp4");
  }
};

/// Precondition: `folder` is a session of the rendered data set (board or body).
[[nodiscard]] RenderedTruth load_rendered_truth(const std::filesystem::path& folder);

/// Error of one corner of a found tag against the truth.
struct CornerResidual {
  int frame = 0;
  int tag = 0;
  int corner = 0;
  double side_px = 0.0;        ///< Mean side of the true tag.
  double sigma_px = 0.0;       ///< As the detection claims.
  glm::dvec2 error_px{0.0};    ///< Found minus true.
  glm::dvec2 outward_px{0.0};  ///< Unit direction from the tag's centre to the corner.
};

/// Residuals of all tags whose truth is known, at the camera's own time: between frames,
/// on a cubic through the four around. Precondition: `found` is of this session's
/// camera `camera`.
[[nodiscard]] std::vector<CornerResidual> residuals(const RenderedTruth& truth,
                                                    std::size_t camera,
                                                    const CameraDetections& found);

}  // namespace marey::tests
