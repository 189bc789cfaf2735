// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/process/painted_tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>

#include "capture/tags/tag_pattern.h"
#include "core/detection.h"

namespace marey::testing {
namespace {

constexpr float kWall = 0.35F;
constexpr float kInk = 0.02F;
constexpr float kPaper = 0.72F;
constexpr int kFiner = 3;  // Rays per pixel and axis.

TagPattern pattern_of(TagId id) {
  const auto patterns = capture::tag_patterns("tag36h11", std::array{id});
  if (!patterns) throw std::invalid_argument(patterns.error().message());
  return patterns->front();
}

/// Pixels that the tag and its margin may cover; empty when it is not seen.
cv::Rect around(const Camera& camera, const PaintedTag& tag, double paper_m) {
  const cv::Rect picture(0, 0, camera.intrinsics.width_px, camera.intrinsics.height_px);
  const glm::dvec3 into_tag = tag.world_from_tag.rotation * glm::dvec3(0, 0, 1);
  const glm::dvec3 sight = tag.world_from_tag.translation - centre_in_world(camera);
  if (glm::dot(into_tag, sight) <= 0.0) return {};
  glm::dvec2 minimum(1e9);
  glm::dvec2 greatest(-1e9);
  for (int i = 0; i < 4; ++i) {
    const auto pixel = project(camera, tag.world_from_tag * corner_in_tag(i, paper_m));
    if (!pixel) return {};
    minimum = glm::min(minimum, *pixel);
    greatest = glm::max(greatest, *pixel);
  }
  const cv::Point from(static_cast<int>(std::floor(minimum.x)) - 2,
                       static_cast<int>(std::floor(minimum.y)) - 2);
  const cv::Point to(static_cast<int>(std::ceil(greatest.x)) + 3,
                     static_cast<int>(std::ceil(greatest.y)) + 3);
  return cv::Rect(from, to) & picture;
}

void paint(const Camera& camera, const PaintedTag& tag, cv::Mat& light) {
  const TagPattern pattern = pattern_of(tag.id);
  const int square = pattern.cells - 2 * pattern.margin_cells;
  const double cell_m = tag.size_m / square;
  const double paper_m = cell_m * pattern.cells;
  const RigidTransform tag_from_camera =
      inverse(tag.world_from_tag) * inverse(camera.camera_from_world);
  const cv::Rect area = around(camera, tag, paper_m);
  for (int v = area.y; v < area.y + area.height; ++v) {
    for (int u = area.x; u < area.x + area.width; ++u) {
      float sum = 0.0F;
      for (int i = 0; i < kFiner * kFiner; ++i) {
        const glm::dvec2 at(u + (i % kFiner + 0.5) / kFiner - 0.5,
                            v + (i / kFiner + 0.5) / kFiner - 0.5);
        sum += light.at<float>(v, u);
        const auto ray = unproject(camera.intrinsics, at);
        if (!ray) continue;
        const glm::dvec3 along = tag_from_camera.rotation * glm::dvec3(*ray, 1.0);
        const glm::dvec3& from = tag_from_camera.translation;
        const glm::dvec3 p = from - along * (from.z / along.z);
        const int column = static_cast<int>(std::floor((p.x + 0.5 * paper_m) / cell_m));
        const int row = static_cast<int>(std::floor((p.y + 0.5 * paper_m) / cell_m));
        if (std::min(row, column) < 0 || std::max(row, column) >= pattern.cells) continue;
        const auto cell = static_cast<std::size_t>(row * pattern.cells + column);
        sum += (pattern.white[cell] != 0 ? kPaper : kInk) - light.at<float>(v, u);
      }
      light.at<float>(v, u) = sum / (kFiner * kFiner);
    }
  }
}

}  // namespace

cv::Mat paint_tags(const Camera& camera,
                   const std::vector<PaintedTag>& tags,
                   unsigned seed) {
  cv::Mat picture(
      camera.intrinsics.height_px, camera.intrinsics.width_px, CV_32F, cv::Scalar(kWall));
  for (const PaintedTag& tag : tags) paint(camera, tag, picture);
  picture.forEach<float>([](float& light, const int*) {
    light = 255.0F * (1.055F * std::pow(light, 1.0F / 2.4F) - 0.055F);
  });
  cv::Mat noise(picture.size(), CV_32F);
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 1.5);
  cv::Mat out;
  cv::Mat(picture + noise).convertTo(out, CV_8U);
  return out;
}

}  // namespace marey::testing
