// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/plate_model.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/lower_case.h"

namespace marey::recordings {
namespace {

std::vector<double> numbers_of(const C3dInfo& info, const char* name) {
  const C3dParameter* p = find_parameter(info.groups, "FORCE_PLATFORM", name);
  return p == nullptr ? std::vector<double>() : numbers(*p);
}

std::size_t channels_of(int type) {
  return type == 3 ? 8 : 6;
}

/// Returns the length in a unit of moment: 1e-3 of "Nmm".
double moment_metres(const C3dInfo& info, const FileAxes& axes, std::size_t channel) {
  const std::vector<std::string> units = texts_of_all(info.groups, "ANALOG", "UNITS");
  std::string unit = channel < units.size() ? units[channel] : "";
  for (char& c : unit) c = lower_case(c);
  if (unit.starts_with("n") && unit.ends_with("mm")) return 1e-3;
  if (unit == "nm" || unit == "n.m" || unit == "n*m" || unit == "ntm") return 1.0;
  return 1.0 / axes.per_metre;
}

/// Corners 1 to 4 are at +x+y, -x+y, -x-y and +x-y of the plate.
bool place(const std::vector<double>& corners,
           std::size_t plate,
           const FileAxes& axes,
           PlateModel& model) {
  if (corners.size() < 12 * (plate + 1)) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = 12 * plate + 3 * i;
    const glm::dvec3 corner(corners[at], corners[at + 1], corners[at + 2]);
    model.corners_in_world.at(i) = turned_to_world(axes.up, corner / axes.per_metre);
    model.centre_in_world += 0.25 * model.corners_in_world.at(i);
  }
  const glm::dvec3 x = model.corners_in_world[0] - model.corners_in_world[1];
  const glm::dvec3 z =
      glm::cross(x, model.corners_in_world[0] - model.corners_in_world[3]);
  const double area = glm::length(z);
  if (!(area > 1e-6) || !std::isfinite(area)) return false;
  const glm::dvec3 down = z / area;
  const glm::dvec3 right = glm::normalize(x);
  model.world_from_plate = glm::dmat3(right, glm::cross(down, right), down);
  return true;
}

void read_origin(const std::vector<double>& origins,
                 std::size_t plate,
                 const FileAxes& axes,
                 PlateModel& model,
                 std::vector<std::string>& notes) {
  if (origins.size() < 3 * (plate + 1)) return;
  glm::dvec3 origin(origins[3 * plate], origins[3 * plate + 1], origins[3 * plate + 2]);
  if (!std::isfinite(origin.x + origin.y + origin.z)) return;
  // The surface is above the sensor, and z is down.
  if (origin.z > 0.0) {
    if (model.type != 3) origin = -origin;
    origin.z = -std::abs(origin.z);
    notes.push_back("plate " + std::to_string(plate + 1) +
                    ": FORCE_PLATFORM:ORIGIN has the sensor above the surface; its sign "
                    "is changed");
  }
  model.origin = origin / axes.per_metre;
}

}  // namespace

std::vector<PlateModel> plate_models(const C3dInfo& info,
                                     const FileAxes& axes,
                                     std::vector<std::string>& notes) {
  std::vector<PlateModel> models;
  const std::vector<double> used = numbers_of(info, "USED");
  const std::vector<double> types = numbers_of(info, "TYPE");
  const std::vector<double> corners = numbers_of(info, "CORNERS");
  const std::vector<double> origins = numbers_of(info, "ORIGIN");
  const std::vector<double> channels = numbers_of(info, "CHANNEL");
  const std::vector<double> matrices = numbers_of(info, "CAL_MATRIX");
  const C3dParameter* channel = find_parameter(info.groups, "FORCE_PLATFORM", "CHANNEL");
  const std::size_t rows =
      channel != nullptr && !channel->dimensions.empty() ? channel->dimensions[0] : 6;
  std::set<std::size_t> taken;
  const double declared = used.empty() ? 0.0 : used[0];
  for (std::size_t plate = 0; static_cast<double>(plate) < std::min(declared, 255.0);
       ++plate) {
    const auto leave_out = [&](const std::string& why) {
      notes.push_back("plate " + std::to_string(plate + 1) + " is left out: " + why);
    };
    PlateModel model;
    model.number = plate + 1;
    // 0 for a real that is no plate type, because it may be too large for an integer.
    const bool has_type =
        plate < types.size() && types[plate] >= 0.0 && types[plate] < 256.0;
    model.type = has_type ? static_cast<int>(types[plate]) : 0;
    if (model.type < 1 || model.type > 4) {
      leave_out("its type is " + std::to_string(model.type) + ", and 1 to 4 are read");
      continue;
    }
    for (std::size_t i = 0; i < channels_of(model.type); ++i) {
      const std::size_t at = rows * plate + i;
      const double number = at < channels.size() && i < rows ? channels[at] : 0.0;
      if (!(number >= 1.0 && number <= info.analog_channels)) break;  // NaN too
      model.channels.push_back(static_cast<std::size_t>(number) - 1);
    }
    if (model.channels.size() < channels_of(model.type)) {
      leave_out("FORCE_PLATFORM:CHANNEL names channels that do not exist");
      continue;
    }
    // Each sensor has its own channels; many plates that share few would use up the
    // memory.
    const auto is_taken = [&](std::size_t c) { return !taken.insert(c).second; };
    if (std::any_of(model.channels.begin(), model.channels.end(), is_taken)) {
      leave_out("FORCE_PLATFORM:CHANNEL names channels of another plate");
      continue;
    }
    if (!place(corners, plate, axes, model)) {
      leave_out("FORCE_PLATFORM:CORNERS span no plate");
      continue;
    }
    if (model.type == 4) {
      const auto begin = static_cast<std::ptrdiff_t>(36 * plate);
      if (matrices.size() < 36 * (plate + 1)) {
        leave_out("FORCE_PLATFORM:CAL_MATRIX has no matrix for it");
        continue;
      }
      model.matrix.assign(matrices.begin() + begin, matrices.begin() + begin + 36);
    }
    read_origin(origins, plate, axes, model, notes);
    model.metres_per_moment = moment_metres(info, axes, model.channels[3]);
    if (model.type == 3) model.metres_per_moment = 1.0 / axes.per_metre;
    models.push_back(std::move(model));
  }
  return models;
}

}  // namespace marey::recordings
