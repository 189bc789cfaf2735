// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/force_plates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "recordings/markers/c3d.h"
#include "recordings/markers/c3d_analog.h"
#include "recordings/markers/plate_model.h"

namespace marey::recordings {
namespace {

/// Force and moment about the centre of the surface, in the plate's frame. [N], [N m]
struct Wrench {
  glm::dvec3 force{0.0};
  glm::dvec3 moment{0.0};
};

/// Channels: Fx12, Fx34, Fy14, Fy23, Fz1 to Fz4. The origin's x and y are half the
/// distances of the sensors, and its z is how deep they are (Kistler, after the C3D User
/// Guide, "Type-3 force plates").
Wrench kistler(const std::array<double, 8>& v, const glm::dvec3& origin) {
  const double a = std::abs(origin.x);
  const double b = std::abs(origin.y);
  Wrench w;
  w.force = {v[0] + v[1], v[2] + v[3], v[4] + v[5] + v[6] + v[7]};
  w.moment = {b * (v[4] + v[5] - v[6] - v[7]),
              a * (-v[4] + v[5] + v[6] - v[7]),
              b * (-v[0] + v[1]) + a * (v[2] - v[3])};
  w.moment += glm::cross(w.force, glm::dvec3(0.0, 0.0, origin.z));
  return w;
}

Wrench wrench_of(const PlateModel& model, const std::array<double, 8>& v) {
  if (model.type == 3) return kistler(v, model.origin);
  std::array<double, 6> f{v[0], v[1], v[2], v[3], v[4], v[5]};
  if (model.type == 4) {
    for (std::size_t row = 0; row < 6; ++row) {
      f.at(row) = 0.0;
      for (std::size_t column = 0; column < 6; ++column) {
        f.at(row) += model.matrix[row + 6 * column] * v.at(column);
      }
    }
  }
  Wrench w;
  w.force = {f[0], f[1], f[2]};
  w.moment = model.metres_per_moment * glm::dvec3(f[3], f[4], f[5]);
  w.moment += glm::cross(w.force, model.origin);
  return w;
}

/// Type 1: force, centre of pressure from the middle of the plate, free moment.
PlateSample pressed(const PlateModel& model,
                    const std::array<double, 8>& v,
                    double per_metre,
                    double min_newton) {
  PlateSample sample;
  sample.force_in_world = model.world_from_plate * glm::dvec3(v[0], v[1], v[2]);
  if (std::abs(v[2]) < min_newton) return sample;
  const glm::dvec3 p = glm::dvec3(v[3], v[4], 0.0) / per_metre;
  sample.centre_in_world = model.centre_in_world + model.world_from_plate * p;
  const double free_moment = v[5] * model.metres_per_moment;
  sample.free_moment_in_world =
      model.world_from_plate * glm::dvec3(0.0, 0.0, free_moment);
  return sample;
}

PlateSample sample_of(const PlateModel& model,
                      const std::array<double, 8>& v,
                      const FileAxes& axes,
                      double min_newton) {
  if (model.type == 1) return pressed(model, v, axes.per_metre, min_newton);
  const Wrench w = wrench_of(model, v);
  PlateSample sample;
  sample.force_in_world = model.world_from_plate * w.force;
  if (std::abs(w.force.z) < min_newton) return sample;
  // On the surface the moment of a force at p is p x F: Mx = py Fz, My = -px Fz.
  const glm::dvec3 p(-w.moment.y / w.force.z, w.moment.x / w.force.z, 0.0);
  sample.centre_in_world = model.centre_in_world + model.world_from_plate * p;
  const double free_moment = w.moment.z - (p.x * w.force.y - p.y * w.force.x);
  sample.free_moment_in_world =
      model.world_from_plate * glm::dvec3(0.0, 0.0, free_moment);
  return sample;
}

using Values = std::array<double, 8>;

/// Calls `visit(plate, values)` with every sample of every plate's channels, in order of
/// time. Values that are not finite become 0, an unloaded plate.
template <class Visit>
Status visit_samples(C3dReader& reader,
                     const std::vector<PlateModel>& models,
                     const Visit& visit) {
  const AnalogScales scales = analog_scales(reader.info());
  const auto channels = static_cast<std::size_t>(reader.info().analog_channels);
  C3dFrame frame;
  for (;;) {
    const Result<bool> more = reader.next(frame);
    if (!more) return more.error();
    if (!*more) return Done{};
    for (std::size_t at = 0; at + channels <= frame.analog.size(); at += channels) {
      for (std::size_t plate = 0; plate < models.size(); ++plate) {
        const std::vector<std::size_t>& own = models[plate].channels;
        Values values{};
        bool sound = true;
        for (std::size_t i = 0; i < own.size(); ++i) {
          values.at(i) = scales.value(own[i], frame.analog[at + own[i]]);
          sound = sound && std::abs(values.at(i)) < 1e12;
        }
        visit(plate, sound ? values : Values{});
      }
    }
  }
}

/// Detects files whose moments are in Nmm though their unit is given as Nm: a body's
/// centre of pressure is within the plate.
Status settle_moments(C3dReader reader,
                      const FileAxes& axes,
                      double min_newton,
                      std::vector<PlateModel>& models,
                      std::vector<std::string>& notes) {
  std::vector<std::vector<double>> levers(models.size());
  Status ok = visit_samples(reader, models, [&](std::size_t i, const Values& v) {
    const PlateModel& model = models[i];
    if (model.type != 2 && model.type != 4) return;
    PlateModel bare = model;
    bare.metres_per_moment = 1.0;
    bare.origin = glm::dvec3(0.0);
    const Wrench w = wrench_of(bare, v);
    if (std::abs(w.force.z) < min_newton) return;
    levers[i].push_back(std::hypot(w.moment.x, w.moment.y) / std::abs(w.force.z));
  });
  if (!ok) return ok;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (levers[i].empty()) continue;
    const auto middle =
        levers[i].begin() + static_cast<std::ptrdiff_t>(levers[i].size() / 2);
    std::nth_element(levers[i].begin(), middle, levers[i].end());
    PlateModel& model = models[i];
    const double size_m =
        glm::distance(model.corners_in_world[0], model.corners_in_world[2]);
    if (*middle * model.metres_per_moment < 2.0 * size_m) continue;
    for (const double unit_m : {1.0 / axes.per_metre, 1e-3}) {
      if (*middle * unit_m > size_m) continue;
      model.metres_per_moment = unit_m;
      notes.push_back(
          "plate " + std::to_string(model.number) +
          ": its moments are not in the unit of ANALOG:UNITS, because the body would be "
          "next to the plate; they are in " +
          (unit_m == 1e-3 ? "N mm" : "N and the unit of length"));
      break;
    }
  }
  return Done{};
}

/// Reverses forces that point down: plates push up, so these were recorded as the body's
/// force on the plate.
void turn_round(const PlateModel& model,
                ForcePlate& plate,
                std::vector<std::string>& notes) {
  double up = 0.0;
  for (const PlateSample& sample : plate.samples) {
    // Squared, so that loads dominate over the drift of an unloaded plate.
    const double force = sample.force_in_world.y;
    if (sample.centre_in_world) up += force * std::abs(force);
  }
  if (up >= 0.0) return;
  notes.push_back("plate " + std::to_string(model.number) +
                  ": the forces point down; their sign was reversed");
  for (PlateSample& sample : plate.samples) {
    sample.force_in_world = -sample.force_in_world;
    sample.free_moment_in_world = -sample.free_moment_in_world;
  }
}

/// `open` returns a new reader at the first frame on each call.
template <class Open>
Result<ForcePlates> read_all(const Open& open,
                             const FileAxes& axes,
                             const ForcePlateOptions& options) {
  Result<C3dReader> reader = open();
  if (!reader) return reader.error();
  const C3dInfo& info = reader->info();
  ForcePlates plates;
  plates.rate = FrameRate{info.rate_hz * info.analog_per_frame};
  plates.start_s = (info.first_frame - 1) / info.rate_hz;
  std::vector<PlateModel> models = plate_models(info, axes, plates.notes);
  if (models.empty()) return plates;
  Result<C3dReader> first = open();
  if (!first) return first.error();
  const double min_newton = options.min_force_N;
  if (Status ok =
          settle_moments(*std::move(first), axes, min_newton, models, plates.notes);
      !ok) {
    return ok.error();
  }
  for (const PlateModel& model : models) {
    plates.plates.push_back({model.type, model.corners_in_world, {}});
  }
  const Status ok = visit_samples(*reader, models, [&](std::size_t i, const Values& v) {
    plates.plates[i].samples.push_back(sample_of(models[i], v, axes, min_newton));
  });
  if (!ok) return ok.error();
  for (std::size_t i = 0; i < models.size(); ++i) {
    turn_round(models[i], plates.plates[i], plates.notes);
  }
  return plates;
}

}  // namespace

Result<ForcePlates> read_force_plates(const std::filesystem::path& path,
                                      const FileAxes& axes,
                                      const ForcePlateOptions& options) {
  return read_all([&] { return C3dReader::open(path); }, axes, options);
}

Result<ForcePlates> parse_force_plates(const std::string& bytes,
                                       const std::string& name,
                                       const FileAxes& axes,
                                       const ForcePlateOptions& options) {
  return read_all([&] { return C3dReader::of_bytes(bytes, name); }, axes, options);
}

}  // namespace marey::recordings
