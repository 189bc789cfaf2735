// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Upward axis, unit and events of a C3D.
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "recordings/markers/c3d_markers.h"

namespace marey::recordings {
namespace {

std::optional<std::string> first_text(const C3dInfo& info,
                                      const char* group,
                                      const char* name) {
  const C3dParameter* p = find_parameter(info.groups, group, name);
  if (p == nullptr) return std::nullopt;
  std::vector<std::string> list = texts(*p);
  if (list.empty() || list[0].empty()) return std::nullopt;
  return list[0];
}

std::string text_of(FileAxis axis) {
  return std::string(name(axis));
}

/// Returns the upward axis for which the force plates' z axes point down, as the format
/// requires. nullopt without plates, or if they are tilted or inconsistent.
std::optional<FileAxis> up_of_plates(const C3dInfo& info) {
  const C3dParameter* p = find_parameter(info.groups, "FORCE_PLATFORM", "CORNERS");
  if (p == nullptr) return std::nullopt;
  const std::vector<double> v = numbers(*p);
  std::optional<FileAxis> found;
  for (std::size_t plate = 0; plate + 12 <= v.size(); plate += 12) {
    const auto corner = [&](std::size_t i) {
      const std::size_t at = plate + 3 * i;
      return glm::dvec3(v[at], v[at + 1], v[at + 2]);
    };
    // Corners 1 to 4 are at +x+y, -x+y, -x-y and +x-y of the plate, whose z is down.
    const glm::dvec3 down = glm::cross(corner(0) - corner(1), corner(0) - corner(3));
    const double length = glm::length(down);
    if (!(length > 0.0) || !std::isfinite(length)) continue;
    std::optional<FileAxis> up;
    for (int axis = 0; axis < 6; ++axis) {
      const auto candidate = static_cast<FileAxis>(axis);
      if (glm::dot(-down / length, unit_vector(candidate)) > 0.9) up = candidate;
    }
    if (!up || (found && *found != *up)) return std::nullopt;
    found = up;
  }
  return found;
}

void find_unit(const C3dInfo& info,
               const AxisFinder& finder,
               const MarkerReadOptions& options,
               FileAxes& axes,
               std::vector<std::string>& notes) {
  const auto set = [&](const std::string& unit, Evidence from) {
    axes.unit = unit;
    axes.per_metre = units_per_metre(unit).value_or(1000.0);
    axes.unit_from = from;
  };
  if (options.unit) {
    MAREY_ASSERT(units_per_metre(*options.unit).has_value());
    set(*options.unit, Evidence::kUser);
    return;
  }
  const auto declared = first_text(info, "POINT", "UNITS");
  if (declared && units_per_metre(*declared)) {
    set(*declared, Evidence::kFile);
    return;
  }
  const std::string silent =
      declared ? "POINT:UNITS is \"" + *declared + "\", which is not a unit of length"
               : "POINT:UNITS is missing";
  if (const auto found = finder.unit()) {
    set(*found, Evidence::kMarkers);
    notes.push_back(silent + "; estimated from the markers' distances it is " + *found);
  } else {
    set("mm", Evidence::kConvention);
    notes.push_back(silent + "; mm is used, as in most C3D files");
  }
}

void find_up_alone(const std::optional<FileAxis>& plates,
                   const AxisFinder& finder,
                   FileAxes& axes,
                   std::vector<std::string>& notes) {
  const std::string silent = "POINT:Y_SCREEN does not determine which axis is up";
  const auto markers = finder.up();
  if (plates) {
    axes.up = *plates;
    axes.up_from = Evidence::kPlates;
    notes.push_back(silent + "; estimated from the force plates it is " +
                    text_of(axes.up));
  } else if (markers) {
    axes.up = *markers;
    axes.up_from = Evidence::kMarkers;
    notes.push_back(silent + "; from the markers' positions, it is " + text_of(axes.up));
  } else {
    axes.up = FileAxis::kPlusZ;
    axes.up_from = Evidence::kConvention;
    notes.push_back(silent +
                    ", and neither do the markers; +Z is used, as in most C3D files");
  }
}

/// Reports an upward axis that the markers contradict. The markers take precedence only
/// if the plates agree with them, because people also lie down.
void check_up(const std::optional<FileAxis>& plates,
              const AxisFinder& finder,
              FileAxes& axes,
              std::vector<std::string>& notes) {
  const auto markers = finder.up();
  if (axes.up_from != Evidence::kFile || !markers) return;
  if (*markers == axes.up || *markers == opposite(axes.up)) return;
  const std::string contradiction = "POINT:Y_SCREEN means that " + text_of(axes.up) +
                                    " is up, and the markers stand along " +
                                    text_of(*markers);
  if (plates == markers) {
    axes.up = *markers;
    axes.up_from = Evidence::kMarkers;
    notes.push_back(contradiction +
                    ", as do the force plates; the markers' axis is used");
  } else {
    notes.push_back(contradiction + "; the file's axis is used");
  }
}

/// Corrects an axis whose sign the markers contradict: some vendors' screens, and some
/// captures, are upside down.
void correct_up(const std::optional<FileAxis>& plates,
                const AxisFinder& finder,
                FileAxes& axes,
                std::vector<std::string>& notes) {
  if (axes.up_from != Evidence::kFile && axes.up_from != Evidence::kPlates) return;
  const FileAxis declared = axes.up;
  const std::string claim = " are upside down when " + text_of(declared) + " is up (by " +
                            std::string(name(axes.up_from)) + "); ";
  const auto markers = finder.up_along(declared);
  if (markers && *markers != declared) {
    axes.up = opposite(declared);
    axes.up_from = Evidence::kMarkers;
    notes.push_back("the markers" + claim + text_of(axes.up) + " is taken");
  } else if (!markers && plates && *plates == opposite(declared)) {
    axes.up = *plates;
    axes.up_from = Evidence::kPlates;
    notes.push_back("the force plates" + claim + text_of(axes.up) + " is taken");
  }
}

}  // namespace

FileAxes axes_of(const C3dInfo& info,
                 const AxisFinder& finder,
                 const MarkerReadOptions& options,
                 std::vector<std::string>& notes) {
  FileAxes axes;
  find_unit(info, finder, options, axes, notes);
  if (options.up) {
    axes.up = *options.up;
    axes.up_from = Evidence::kUser;
    return axes;
  }
  const auto plates = up_of_plates(info);
  const auto screen = first_text(info, "POINT", "Y_SCREEN");
  const auto declared = screen ? axis_of(*screen) : std::nullopt;
  if (declared) {
    axes.up = *declared;
    axes.up_from = Evidence::kFile;
  } else {
    find_up_alone(plates, finder, axes, notes);
  }
  check_up(plates, finder, axes, notes);
  correct_up(plates, finder, axes, notes);
  return axes;
}

std::vector<MarkerEvent> events_of(const C3dInfo& info) {
  std::vector<MarkerEvent> events;
  for (const C3dHeaderEvent& event : info.header_events) {
    events.push_back({event.label, "", "", event.time_s});
  }
  const std::vector<double> times = numbers_of_all(info.groups, "EVENT", "TIMES");
  const auto labels = texts_of_all(info.groups, "EVENT", "LABELS");
  const auto contexts = texts_of_all(info.groups, "EVENT", "CONTEXTS");
  const auto subjects = texts_of_all(info.groups, "EVENT", "SUBJECTS");
  std::size_t used = times.size() / 2;
  if (const C3dParameter* p = find_parameter(info.groups, "EVENT", "USED")) {
    const std::vector<double> count = numbers(*p, true);
    if (!count.empty() && count[0] >= 0.0) {
      // Compared as a real, because it may be too large for an integer.
      if (count[0] < static_cast<double>(used)) used = static_cast<std::size_t>(count[0]);
    }
  }
  for (std::size_t i = 0; i < used; ++i) {
    // Minutes and seconds.
    const double time_s = 60.0 * times[2 * i] + times[2 * i + 1];
    if (!std::isfinite(time_s)) continue;
    const auto text = [&](const std::vector<std::string>& list) {
      return i < list.size() ? list[i] : std::string();
    };
    events.push_back({text(labels), text(contexts), text(subjects), time_s});
  }
  return events;
}

void put_events(C3dInfo& info, const std::vector<MarkerEvent>& events) {
  // Limit of one parameter of times.
  const std::size_t used = std::min<std::size_t>(events.size(), 255);
  C3dParameter count{"USED", "", false, {}, C3dIntegers{static_cast<std::int16_t>(used)}};
  put_parameter(info.groups, "EVENT", std::move(count));
  std::vector<std::string> labels;
  std::vector<std::string> contexts;
  std::vector<std::string> subjects;
  C3dReals times;
  for (std::size_t i = 0; i < used; ++i) {
    labels.push_back(events[i].label);
    contexts.push_back(events[i].context);
    subjects.push_back(events[i].subject);
    times.push_back(0.0F);
    times.push_back(static_cast<float>(events[i].time_s));
  }
  put_texts(info.groups, "EVENT", "LABELS", labels);
  put_texts(info.groups, "EVENT", "CONTEXTS", contexts);
  put_texts(info.groups, "EVENT", "SUBJECTS", subjects);
  C3dParameter p{"TIMES", "", false, {2, static_cast<std::uint8_t>(used)}, times};
  put_parameter(info.groups, "EVENT", std::move(p));
}

}  // namespace marey::recordings
