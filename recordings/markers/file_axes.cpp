// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/file_axes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/common.hpp>

#include "core/base/lower_case.h"
#include "core/base/quantile.h"

namespace marey::recordings {
namespace {

constexpr std::array<std::string_view, 6> kAxisNames{"+X", "+Y", "+Z", "-X", "-Y", "-Z"};

int coordinate(FileAxis axis) {
  return static_cast<int>(axis) % 3;
}

bool is_negative(FileAxis axis) {
  return static_cast<int>(axis) >= 3;
}

std::string letters_of(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) > ' ' && c != '"' && c != '.') {
      out += lower_case(c);
    }
  }
  return out;
}

// Ankle markers are at 0.05 of the stature, and the floor estimate of a walking body is
// 0.02 to 0.1; jumps from a box and stairs reach 0.4 and 0.65. The head of a standing
// body is at 1.
constexpr double kFloor = 0.7;
constexpr double kClear = 2.0;
constexpr double kBelow = 5.0;
// Arms held out make bodies wider than high, by less than this factor.
constexpr double kMaxWidthRatio = 1.6;

}  // namespace

std::string_view name(FileAxis axis) {
  return kAxisNames.at(static_cast<std::size_t>(axis));
}

std::optional<FileAxis> axis_of(std::string_view text) {
  const std::string word = letters_of(text);
  if (word.empty() || word.size() > 2) return std::nullopt;
  const char letter = word.back();
  if (letter < 'x' || letter > 'z') return std::nullopt;
  if (word.size() == 2 && word[0] != '+' && word[0] != '-') return std::nullopt;
  const auto axis = static_cast<FileAxis>(letter - 'x');
  return word[0] == '-' ? opposite(axis) : axis;
}

FileAxis opposite(FileAxis axis) {
  return static_cast<FileAxis>((static_cast<int>(axis) + 3) % 6);
}

glm::dvec3 unit_vector(FileAxis axis) {
  glm::dvec3 v(0.0);
  v[coordinate(axis)] = is_negative(axis) ? -1.0 : 1.0;
  return v;
}

std::string_view name(Evidence evidence) {
  switch (evidence) {
    case Evidence::kFile:
      return "file";
    case Evidence::kMarkers:
      return "markers";
    case Evidence::kPlates:
      return "force plates";
    case Evidence::kConvention:
      return "habit";
    case Evidence::kUser:
      return "user";
  }
  return "habit";
}

std::optional<double> units_per_metre(std::string_view name) {
  const std::string unit = letters_of(name);
  if (unit == "mm" || unit.starts_with("milli")) return 1000.0;
  if (unit == "cm" || unit.starts_with("centi")) return 100.0;
  if (unit == "dm" || unit.starts_with("deci")) return 10.0;
  // "mete": some files store only four letters.
  if (unit == "m" || unit.starts_with("met")) return 1.0;
  if (unit == "in" || unit.starts_with("inch")) return 1.0 / 0.0254;
  if (unit == "ft" || unit.starts_with("feet") || unit.starts_with("foot")) {
    return 1.0 / 0.3048;
  }
  return std::nullopt;
}

glm::dvec3 turned_to_world(FileAxis up, const glm::dvec3& v) {
  switch (up) {
    case FileAxis::kPlusX:
      return {-v.y, v.x, v.z};
    case FileAxis::kPlusY:
      return v;
    case FileAxis::kPlusZ:
      return {v.x, v.z, -v.y};
    case FileAxis::kMinusX:
      return {v.y, -v.x, v.z};
    case FileAxis::kMinusY:
      return {v.x, -v.y, -v.z};
    case FileAxis::kMinusZ:
      return {v.x, -v.z, v.y};
  }
  return v;
}

glm::dvec3 turned_to_file(FileAxis up, const glm::dvec3& v) {
  switch (up) {
    case FileAxis::kPlusX:
      return {v.y, -v.x, v.z};
    case FileAxis::kPlusY:
      return v;
    case FileAxis::kPlusZ:
      return {v.x, -v.z, v.y};
    case FileAxis::kMinusX:
      return {-v.y, v.x, v.z};
    case FileAxis::kMinusY:
      return {v.x, -v.y, -v.z};
    case FileAxis::kMinusZ:
      return {v.x, v.z, -v.y};
  }
  return v;
}

void AxisFinder::add_frame(std::span<const glm::dvec3> p_in_file) {
  // 10 km in the smallest unit; larger values mark samples that were not seen.
  constexpr double kMaxCoordinate = 1e7;
  Box box;
  for (const glm::dvec3& p : p_in_file) {
    if (!(std::abs(p.x) < kMaxCoordinate && std::abs(p.y) < kMaxCoordinate &&
          std::abs(p.z) < kMaxCoordinate)) {
      continue;
    }
    box.min = box.markers == 0 ? p : glm::min(box.min, p);
    box.max = box.markers == 0 ? p : glm::max(box.max, p);
    ++box.markers;
  }
  constexpr std::size_t kMinMarkers = 3;
  if (box.markers >= kMinMarkers) boxes_.push_back(box);
}

std::vector<AxisFinder::Box> AxisFinder::full_boxes() const {
  std::size_t max_markers = 0;
  for (const Box& box : boxes_) max_markers = std::max(max_markers, box.markers);
  std::vector<Box> full;
  for (const Box& box : boxes_) {
    if (10 * box.markers >= 7 * max_markers) full.push_back(box);
  }
  return full;
}

std::optional<AxisFinder::Stance> AxisFinder::stance(FileAxis axis) const {
  const std::vector<Box> boxes = full_boxes();
  if (boxes.empty()) return std::nullopt;
  const int i = coordinate(axis);
  std::vector<double> low;
  std::vector<double> extent;
  for (const Box& box : boxes) {
    low.push_back(is_negative(axis) ? -box.max[i] : box.min[i]);
    extent.push_back(box.max[i] - box.min[i]);
  }
  Stance found;
  found.extent = median(extent);
  if (!(found.extent > 0.0)) return std::nullopt;
  const double spread = quantile(low, 0.9) - quantile(low, 0.1);
  // Jumps and stairs are above the floor; no marker is far below it.
  const double lowest = median(low);
  found.floor =
      (lowest < 0.0 ? -kBelow * lowest : lowest) / found.extent + spread / found.extent;
  return found;
}

std::optional<FileAxis> AxisFinder::up() const {
  double widest = 0.0;
  std::array<std::optional<Stance>, 6> stances;
  for (std::size_t i = 0; i < stances.size(); ++i) {
    stances.at(i) = stance(static_cast<FileAxis>(i));
    if (stances.at(i)) widest = std::max(widest, stances.at(i)->extent);
  }
  std::optional<FileAxis> best;
  double best_cost = 0.0;
  double next_cost = 0.0;
  for (std::size_t i = 0; i < stances.size(); ++i) {
    if (!stances.at(i) || stances.at(i)->extent * kMaxWidthRatio < widest) continue;
    const double cost = stances.at(i)->floor * widest / stances.at(i)->extent;
    if (!best || cost < best_cost) {
      next_cost = best ? best_cost : cost;
      best_cost = cost;
      best = static_cast<FileAxis>(i);
    } else if (next_cost <= best_cost || cost < next_cost) {
      next_cost = cost;
    }
  }
  const bool clear = best && best_cost < kFloor && next_cost > kClear * best_cost;
  return clear ? best : std::nullopt;
}

std::optional<FileAxis> AxisFinder::up_along(FileAxis axis) const {
  const auto along = stance(axis);
  const auto against = stance(opposite(axis));
  if (!along || !against) return std::nullopt;
  if (along->floor < kFloor && against->floor > kClear * along->floor) return axis;
  if (against->floor < kFloor && along->floor > kClear * against->floor) {
    return opposite(axis);
  }
  return std::nullopt;
}

std::optional<std::string> AxisFinder::unit() const {
  const std::vector<Box> boxes = full_boxes();
  if (boxes.empty()) return std::nullopt;
  std::vector<double> extents;
  for (const Box& box : boxes) {
    const glm::dvec3 extent = box.max - box.min;
    extents.push_back(std::max({extent.x, extent.y, extent.z}));
  }
  // The extent of a hand is 15 cm, that of bodies and their objects a few metres.
  const double extent = median(std::move(extents));
  if (extent >= 0.15 && extent < 15.0) return "m";
  if (extent >= 15.0 && extent < 200.0) return "cm";
  if (extent >= 200.0 && extent < 15000.0) return "mm";
  return std::nullopt;
}

}  // namespace marey::recordings
