// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/trial_checks.h"

#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

#include "core/base/format_text.h"
#include "recordings/markers/file_axes.h"

namespace marey::app {
namespace {

using reconstruct::SideExchange;
using reconstruct::TrialGeometry;
using recordings::Evidence;
using recordings::FileAxis;

// Units differ by a factor of 2.5 or more, people by less.
constexpr double kOtherUnit = 1.8;
// A body that bends or crawls is upright in some frames.
constexpr double kHardlyUpright = 0.1;
constexpr double kCosine60 = 0.5;
// A standing body is near an axis; a lying body is only by chance.
constexpr double kCosine15 = 0.966;

/// Returns the axis of the file that is nearest to a direction in the world.
FileAxis nearest_axis(FileAxis up, const glm::dvec3& in_world) {
  const glm::dvec3 in_file = recordings::turned_to_file(up, in_world);
  FileAxis best = FileAxis::kPlusX;
  for (int i = 1; i < 6; ++i) {
    const auto axis = static_cast<FileAxis>(i);
    if (glm::dot(in_file, recordings::unit_vector(axis)) >
        glm::dot(in_file, recordings::unit_vector(best))) {
      best = axis;
    }
  }
  return best;
}

/// Returns the up axis estimated from the markers alone.
std::optional<FileAxis> up_by_markers(const MarkerTrial& trial) {
  const MarkerTracks& tracks = trial.repair.as_read;
  constexpr std::size_t kFrames = 200;
  const std::size_t step = 1 + tracks.frames() / kFrames;
  recordings::AxisFinder finder;
  std::vector<glm::dvec3> seen;
  for (std::size_t f = 0; f < tracks.frames(); f += step) {
    seen.clear();
    for (std::size_t m = 0; m < tracks.markers(); ++m) {
      const auto& sample = tracks.at(f, m);
      if (!sample) continue;
      seen.push_back(recordings::turned_to_file(
          trial.file.axes.up, trial.file.axes.per_metre * sample->p_in_world));
    }
    finder.add_frame(seen);
  }
  return finder.up();
}

bool is_never_upright(const TrialGeometry& geometry) {
  return geometry.body_up && geometry.upright_share < kHardlyUpright &&
         geometry.body_up->y < kCosine60;
}

/// Returns true if a body that is never upright indicates a wrong axis, and does not lie.
bool is_axis_wrong(const MarkerTrial& trial, const TrialGeometry& geometry) {
  const auto& axes = trial.file.axes;
  if (const auto up = up_by_markers(trial)) return *up != axes.up;
  if (axes.up_from == Evidence::kConvention) return true;
  const FileAxis body = nearest_axis(axes.up, *geometry.body_up);
  const glm::dvec3 along = recordings::turned_to_world(axes.up, unit_vector(body));
  return axes.up_from == Evidence::kUser &&
         glm::dot(along, *geometry.body_up) > kCosine15;
}

std::string how_it_lies(const TrialGeometry& geometry) {
  return geometry.body_up->y < -kCosine60 ? "the body is head down all the time"
                                          : "the body lies all the time";
}

std::string axis_advice(const MarkerTrial& trial, const TrialGeometry& geometry) {
  const FileAxis body = nearest_axis(trial.file.axes.up, *geometry.body_up);
  return "give the up axis of the file with --up: the body stands along its " +
         std::string(name(body)) + " (--up " + std::string(name(body)) + ")";
}

Finding axis_finding(const MarkerTrial& trial, const TrialGeometry& geometry) {
  const auto& axes = trial.file.axes;
  const std::string up(name(axes.up));
  std::string why = " is taken as up, as in most files of its kind";
  if (axes.up_from == Evidence::kUser) why = " is up by --up";
  if (axes.up_from == Evidence::kFile) why = " is up according to the file";
  if (axes.up_from == Evidence::kPlates) why = " is up according to the force plates";
  return {Severity::kPoor,
          "axis",
          trial.path.string(),
          how_it_lies(geometry) + ": its axis " + up + why,
          axis_advice(trial, geometry)};
}

std::string only_path(std::span<const MarkerTrial> trials) {
  return trials.size() == 1 ? trials[0].path.string() : "";
}

/// Returns "the lengths were read in cm, and fit an adult with --unit in; " if all trials
/// were read in one unit and another one gives an adult's stature.
std::string unit_advice(std::span<const MarkerTrial> trials, double stature_m) {
  const auto& axes = trials.front().file.axes;
  for (const MarkerTrial& trial : trials) {
    if (trial.file.axes.per_metre != axes.per_metre) return "";
  }
  constexpr double kAdult_m = 1.7;
  const auto unit = unit_by_scale(axes.per_metre, stature_m / kAdult_m);
  if (!unit) return "";
  return "the lengths were read in " + axes.unit + ", and fit an adult with --unit " +
         *unit + "; ";
}

std::string_view part_words(SideExchange sides) {
  switch (sides) {
    case SideExchange::kTrunk:
      return "the trunk";
    case SideExchange::kLegs:
      return "the legs";
    case SideExchange::kArms:
      return "the arms";
    default:
      return "all labels";
  }
}

Finding sides_finding(std::span<const MarkerTrial> trials,
                      std::size_t trial,
                      SideExchange sides,
                      bool in_all) {
  const std::string part(part_words(sides));
  const bool is_alone = trials.size() == 1;
  std::string cause = "left and right seem exchanged on " + part;
  if (!is_alone) cause += in_all ? " in all trials" : " in this trial";
  cause += sides == SideExchange::kAll
               ? ": with these labels, the markers are a mirror image of a body"
               : ": with these labels, left is on the trunk's right";
  std::string next = "exchange left and right in the labels of " +
                     (sides == SideExchange::kAll ? "this file" : part);
  next += is_alone || in_all ? ", in the recording or with --markers MAP.toml"
                             : " in this file, not in the others";
  if (sides == SideExchange::kAll) {
    next = is_alone || in_all
               ? "correct left and right, in the recording or with --markers MAP.toml, "
                 "or check whether the file's axes are left-handed"
               : "exchange left and right in all labels of this file, not in the others, "
                 "or check whether its axes are left-handed";
  }
  return {
      Severity::kPoor, "sides", in_all ? "" : trials[trial].path.string(), cause, next};
}

}  // namespace

std::optional<std::string> unit_by_scale(double per_metre, double scale) {
  constexpr double kNear = 1.25;
  for (const char* unit : {"mm", "cm", "m", "in", "ft"}) {
    const double off = *recordings::units_per_metre(unit) / (per_metre * scale);
    if (off < kNear && off > 1.0 / kNear) return unit;
  }
  return std::nullopt;
}

Status check_units(std::span<const MarkerTrial> trials,
                   std::span<const TrialGeometry> geometry) {
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const auto& scale = geometry[t].scale;
    const double times = scale.value_or(1.0);
    if (times < kOtherUnit && times > 1.0 / kOtherUnit) continue;
    const auto& axes = trials[t].file.axes;
    const std::string other = trials[geometry[t].scale_of].path.string();
    const auto unit = unit_by_scale(axes.per_metre, *scale);
    std::string next = "correct the unit in the file";
    if (unit) {
      next += ", or write it again with `marey convert FILE NEW --unit " + *unit + "`";
    }
    return bad_input(trials[t].path.string(),
                     "its markers are " + format_text("%.3g", *scale) +
                         " times as far apart as in " + other + ": it was read in " +
                         axes.unit +
                         (unit ? ", and its numbers seem to be " + *unit : std::string()),
                     next);
  }
  return Done{};
}

Status check_size(std::span<const MarkerTrial> trials, double stature_m) {
  // Below any human stature, children included; a wrong unit is mostly a factor of 10.
  // [m]
  constexpr double kMinStature_m = 0.4;
  constexpr double kMaxStature_m = 2.7;
  if (stature_m > kMinStature_m && stature_m < kMaxStature_m) return Done{};
  return bad_input(
      only_path(trials),
      format_text("by the distances of its markers this body is %.3g m tall", stature_m),
      unit_advice(trials, stature_m) +
          "see the unit, which --unit corrects, and the labels, which --markers "
          "MAP.toml corrects");
}

std::optional<Finding> assess_small_stature(std::span<const MarkerTrial> trials,
                                            const reconstruct::MeasuredStature& measured,
                                            std::optional<double> given_m) {
  // Children walk from about 0.75 m on; an adult's inches read as centimetres give 0.55
  // to 0.8 m.
  constexpr double kMinWalker_m = 0.8;
  const bool is_expected = given_m && *given_m < kMinWalker_m;
  if (measured.stature_m >= kMinWalker_m || is_expected) return std::nullopt;
  return Finding{
      Severity::kPoor,
      "stature",
      only_path(trials),
      format_text("by its markers the subject is %.2f m tall", measured.stature_m),
      unit_advice(trials, measured.stature_m) +
          "if the subject is a small child, give its --stature"};
}

std::vector<Finding> assess_sides_and_axes(std::span<const MarkerTrial> trials,
                                           std::span<const TrialGeometry> geometry) {
  std::vector<Finding> found;
  bool in_all = trials.size() > 1;
  for (const TrialGeometry& one : geometry) {
    in_all =
        in_all && one.sides != SideExchange::kNone && one.sides == geometry.front().sides;
  }
  if (in_all) found.push_back(sides_finding(trials, 0, geometry.front().sides, true));
  for (std::size_t t = 0; t < trials.size(); ++t) {
    if (is_never_upright(geometry[t]) && is_axis_wrong(trials[t], geometry[t])) {
      found.push_back(axis_finding(trials[t], geometry[t]));
    }
    if (!in_all && geometry[t].sides != SideExchange::kNone) {
      found.push_back(sides_finding(trials, t, geometry[t].sides, false));
    }
  }
  return found;
}

std::vector<Finding> assess_lying(std::span<const MarkerTrial> trials,
                                  std::span<const TrialGeometry> geometry) {
  std::vector<Finding> found;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    if (!is_never_upright(geometry[t]) || is_axis_wrong(trials[t], geometry[t])) continue;
    found.push_back(
        fair_finding("axis",
                     trials[t].path.string(),
                     how_it_lies(geometry[t]),
                     "if this is wrong, " + axis_advice(trials[t], geometry[t])));
  }
  return found;
}

}  // namespace marey::app
