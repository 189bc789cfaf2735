// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/plan/plan_map.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/pages/page_text.h"

namespace marey::app {

namespace {

/// Part of the floor that a page shows: the volume and all cameras.
struct Frame {
  glm::dvec2 corner_min{0.0};
  glm::dvec2 extent{0.0};
};

glm::dvec2 flat(const glm::dvec3& p) {
  return {p.x, p.z};
}

Frame frame_of(const PlanReport& report) {
  glm::dvec2 corner_min = flat(report.grid.min_in_world);
  glm::dvec2 corner_max = flat(report.grid.max_in_world);
  for (const Camera& camera : report.cameras) {
    const glm::dvec2 place = flat(centre_in_world(camera));
    corner_min = glm::min(corner_min, place);
    corner_max = glm::max(corner_max, place);
  }
  constexpr double kRim_m = 0.7;
  return {corner_min - kRim_m, corner_max - corner_min + 2.0 * kRim_m};
}

/// Returns the direction on the floor plan of the ray through `pixel`; nullopt for a
/// vertical ray.
std::optional<glm::dvec2> heading(const Camera& camera, const glm::dvec2& pixel) {
  const auto ray = unproject(camera.intrinsics, pixel);
  if (!ray) return std::nullopt;
  const RigidTransform world_from_camera = inverse(camera.camera_from_world);
  const glm::dvec2 way =
      flat(world_from_camera.rotation * glm::dvec3(ray->x, ray->y, 1.0));
  const double length = glm::length(way);
  if (!(length > 1e-9)) return std::nullopt;
  return way / length;
}

std::string polygon(const char* name, std::initializer_list<glm::dvec2> corners) {
  std::string out = "<polygon class=\"" + std::string(name) + "\" points=\"";
  for (const glm::dvec2& corner : corners)
    out += text_of("%.3f,%.3f ", corner.x, corner.y);
  return out + "\"/>";
}

std::string cone(const char* name, const Camera& camera, double length_m) {
  const Intrinsics& k = camera.intrinsics;
  const double middle = 0.5 * (k.height_px - 1);
  const auto left = heading(camera, {0.0, middle});
  const auto right = heading(camera, {k.width_px - 1.0, middle});
  if (!left || !right) return "";
  const glm::dvec2 at = flat(centre_in_world(camera));
  return polygon(name, {at, at + length_m * *left, at + length_m * *right});
}

/// Draws a camera as a wedge that opens in its viewing direction, with its name behind
/// it.
std::string body(const Camera& camera, double size_m, const Frame& frame) {
  const Intrinsics& k = camera.intrinsics;
  const auto ahead = heading(camera, k.centre_px);
  const glm::dvec2 at = flat(centre_in_world(camera));
  const glm::dvec2 way = ahead.value_or(glm::dvec2(0.0, 1.0));
  const glm::dvec2 aside{-way.y, way.x};
  std::string out = polygon("body",
                            {at - 0.5 * size_m * way,
                             at + size_m * (0.6 * way + 0.6 * aside),
                             at + size_m * (0.6 * way - 0.6 * aside)});
  glm::dvec2 name = at + glm::dvec2(0.0, (way.y > 0.0 ? -0.9 : 1.6) * size_m);
  // The width of a letter is about 0.55 of its height, so the name stays inside.
  const double half_m = std::min(
      0.3 * size_m * static_cast<double>(camera.name.size() + 1), 0.5 * frame.extent.x);
  name.x = std::clamp(
      name.x, frame.corner_min.x + half_m, frame.corner_min.x + frame.extent.x - half_m);
  return out +
         text_of(
             "<text x=\"%.3f\" y=\"%.3f\" font-size=\"%.3f\">", name.x, name.y, size_m) +
         escaped(camera.name) + "</text>";
}

std::string metres(const Frame& frame) {
  const glm::dvec2 end = frame.corner_min + frame.extent;
  // Integer steps: far from the origin, adding 1 to a double may have no effect.
  const auto lines = [](double from, double to) {
    return static_cast<int>(std::floor(to - std::ceil(from))) + 1;
  };
  std::string out;
  for (int i = 0; i < lines(frame.corner_min.x, end.x); ++i) {
    const double x = std::ceil(frame.corner_min.x) + i;
    out += text_of("<line class=\"metre\" x1=\"%.3f\" x2=\"%.3f\" ", x, x) +
           text_of("y1=\"%.3f\" y2=\"%.3f\"/>", frame.corner_min.y, end.y);
  }
  for (int i = 0; i < lines(frame.corner_min.y, end.y); ++i) {
    const double z = std::ceil(frame.corner_min.y) + i;
    out +=
        text_of(
            "<line class=\"metre\" x1=\"%.3f\" x2=\"%.3f\" ", frame.corner_min.x, end.x) +
        text_of("y1=\"%.3f\" y2=\"%.3f\"/>", z, z);
  }
  return out;
}

}  // namespace

std::string floor_map(const PlanReport& report,
                      std::span<const MapCell> cells,
                      double step_m,
                      const std::string& caption) {
  const Frame frame = frame_of(report);
  const double size_m = std::max(frame.extent.x, frame.extent.y) / 30.0;
  std::string out =
      "<figure class=\"map\"><svg role=\"img\" aria-label=\"" + escaped(caption) +
      "\" viewBox=\"" + text_of("%.3f %.3f ", frame.corner_min.x, frame.corner_min.y) +
      text_of("%.3f %.3f\">", frame.extent.x, frame.extent.y) + metres(frame);
  const double far_m = 2.0 * glm::length(frame.extent);
  for (const Camera& camera : report.cameras) out += cone("sight", camera, far_m);
  for (const MapCell& cell : cells) {
    // Slightly larger than the cell, so that no seams show.
    out +=
        text_of("<rect x=\"%.3f\" y=\"%.3f\" ",
                cell.at.x - 0.5 * step_m,
                cell.at.y - 0.5 * step_m) +
        text_of("width=\"%.3f\" height=\"%.3f\" ", 1.02 * step_m, 1.02 * step_m) +
        (cell.share ? "fill=\"" + colour(*cell.share) + "\"" : "class=\"unseen-cell\"") +
        "><title>" + escaped(cell.words) + "</title></rect>";
  }
  for (const Camera& camera : report.cameras) {
    out += cone("cone", camera, far_m);
  }
  for (const Camera& camera : report.cameras) out += body(camera, size_m, frame);
  return out + "</svg><figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

}  // namespace marey::app
