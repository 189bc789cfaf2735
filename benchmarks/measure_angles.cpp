// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// How far joint angles are from another program's, for every column that two motion files
// share:
//
//   measure_angles MINE.mot THEIRS.mot [--negate COLUMN]... [--shift SECONDS]
//
// MINE is interpolated at the times of THEIRS that it covers. Two models of a body hardly
// agree on where zero is, so that the mean difference is told apart, as the offset, from
// the root mean square and the largest of what is left. Degrees; mm for pelvis_tx, ty,
// tz; columns that are no coordinates in their own unit. A difference of full turns is
// none.
//
// Then the joints of three angles as what they are, one rotation: how far it is turned
// from theirs, which gimbal lock, and a triple that was told by the other of its two, do
// not blur.
//
// --negate knee_angle: THEIRS counts knee_angle_r and _l the other way round, as
// gait2392, gait2354 and Hamner's model do. --shift: MINE's times are that much too
// early.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "recordings/mot.h"

namespace marey {
namespace {

using recordings::MotTable;

struct Arguments {
  std::string mine;
  std::string theirs;
  std::vector<std::string> negated;
  double shift_s = 0.0;
};

[[noreturn]] void stop(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(1);
}

Arguments read_arguments(int argc, char** argv) {
  const char* usage =
      "usage: measure_angles MINE.mot THEIRS.mot [--negate COLUMN]... [--shift SECONDS]";
  Arguments arguments;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool is_option = word.starts_with("--");
    if (is_option && i + 1 == argc) stop(usage);
    if (word == "--negate") {
      arguments.negated.emplace_back(argv[++i]);
    } else if (word == "--shift") {
      char* end = nullptr;
      arguments.shift_s = std::strtod(argv[++i], &end);
      if (end == argv[i] || *end != '\0') stop(usage);
    } else if (is_option) {
      stop(usage);
    } else {
      files.emplace_back(word);
    }
  }
  if (files.size() != 2) stop(usage);
  arguments.mine = files[0];
  arguments.theirs = files[1];
  return arguments;
}

MotTable read(const std::string& path) {
  auto table = recordings::read_mot(path);
  if (!table) stop(table.error().message());
  for (const std::string& note : table->notes) {
    std::printf("%s: %s\n", path.c_str(), note.c_str());
  }
  return *std::move(table);
}

/// A column at a time between two rows; nullopt before the first and after the last, and
/// where a number is missing.
std::optional<double> at_time(const MotTable& table, std::size_t column, double time_s) {
  // Times are written with few digits: a row that is a tenth of a millisecond off is it.
  constexpr double kNearS = 1e-4;
  const auto& times = table.time_s;
  if (times.empty() || time_s < times.front() - kNearS ||
      time_s > times.back() + kNearS) {
    return std::nullopt;
  }
  const auto after = std::lower_bound(times.begin(), times.end(), time_s);
  const auto row = static_cast<std::size_t>(after - times.begin());
  if (row == 0) return table.at(0, column);
  if (row == times.size()) return table.at(row - 1, column);
  const double step_s = times[row] - times[row - 1];
  const double share = step_s > 0.0 ? (time_s - times[row - 1]) / step_s : 0.0;
  const double before = table.at(row - 1, column);
  const double value = before + share * (table.at(row, column) - before);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

struct Difference {
  std::size_t rows = 0;
  double offset = 0.0;
  double rms = 0.0;
  double worst = 0.0;
};

Difference compare(const MotTable& mine,
                   std::size_t column,
                   const MotTable& theirs,
                   std::size_t their_column,
                   double shift_s) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::vector<double> off;
  for (std::size_t row = 0; row < theirs.rows(); ++row) {
    const double their = theirs.at(row, their_column);
    const auto my = at_time(mine, column, theirs.time_s[row] - shift_s);
    if (!my || std::isnan(their)) continue;
    double difference = *my - their;
    if (mine.columns[column].is_angle) {
      const double near = off.empty() ? 0.0 : off.back();
      difference = near + std::remainder(difference - near, kTurn);
    }
    off.push_back(difference);
  }
  Difference out;
  out.rows = off.size();
  if (off.empty()) return out;
  for (const double d : off) out.offset += d / static_cast<double>(off.size());
  for (const double d : off) {
    out.rms += (d - out.offset) * (d - out.offset) / static_cast<double>(off.size());
    out.worst = std::max(out.worst, std::abs(d - out.offset));
  }
  out.rms = std::sqrt(out.rms);
  return out;
}

/// Angles about Z, X and Y, each axis carried along by those before.
struct Joint {
  std::array<std::string, 3> columns;
};

std::vector<Joint> joints() {
  std::vector<Joint> out{
      {{"pelvis_tilt", "pelvis_list", "pelvis_rotation"}},
      {{"lumbar_extension", "lumbar_bending", "lumbar_rotation"}},
  };
  for (const std::string side : {"_r", "_l"}) {
    out.push_back(
        {{"hip_flexion" + side, "hip_adduction" + side, "hip_rotation" + side}});
    out.push_back({{"arm_flex" + side, "arm_add" + side, "arm_rot" + side}});
  }
  return out;
}

/// The joint's rotation at a time; of a left one its mirror image's, which is turned by
/// the same angle.
std::optional<glm::dquat> rotation_at(const MotTable& table,
                                      const Joint& joint,
                                      double time_s) {
  constexpr std::array<int, 3> kAxes{2, 0, 1};
  glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = table.find(joint.columns[i]);
    const auto angle = column ? at_time(table, *column, time_s) : std::nullopt;
    if (!angle) return std::nullopt;
    glm::dvec3 axis(0.0);
    axis[kAxes[i]] = 1.0;
    rotation = rotation * glm::angleAxis(*angle, axis);
  }
  return rotation;
}

double angle_of(const glm::dquat& q) {
  return 2.0 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), std::abs(q.w));
}

/// As compare(): the offset is the mean rotation between the two, the rest what is left.
Difference compare(const MotTable& mine,
                   const MotTable& theirs,
                   const Joint& joint,
                   double shift_s) {
  std::vector<glm::dquat> off;
  glm::dquat sum(0.0, 0.0, 0.0, 0.0);
  for (const double time_s : theirs.time_s) {
    const auto my = rotation_at(mine, joint, time_s - shift_s);
    const auto their = rotation_at(theirs, joint, time_s);
    if (!my || !their) continue;
    glm::dquat difference = glm::conjugate(*their) * *my;
    if (glm::dot(difference, sum) < 0.0) difference = -difference;
    sum = sum + difference;
    off.push_back(difference);
  }
  Difference out;
  out.rows = off.size();
  if (off.empty()) return out;
  const glm::dquat mean = glm::normalize(sum);
  out.offset = angle_of(mean);
  for (const glm::dquat& d : off) {
    const double left = angle_of(glm::conjugate(mean) * d);
    out.rms += left * left / static_cast<double>(off.size());
    out.worst = std::max(out.worst, left);
  }
  out.rms = std::sqrt(out.rms);
  return out;
}

void print(const std::string& name, const Difference& d, double unit, const char* word) {
  std::printf("%-28s %6zu %9.2f %9.2f %9.2f%s\n",
              name.c_str(),
              d.rows,
              unit * d.offset,
              unit * d.rms,
              unit * d.worst,
              word);
}

/// Turns round the columns that have this name, with or without a side.
bool negate(MotTable& table, const std::string& name) {
  bool found = false;
  for (const char* side : {"", "_r", "_l"}) {
    const auto column = table.find(name + side);
    if (!column) continue;
    found = true;
    for (std::size_t row = 0; row < table.rows(); ++row) table.at(row, *column) *= -1.0;
  }
  return found;
}

int measure(const Arguments& arguments) {
  const MotTable mine = read(arguments.mine);
  MotTable theirs = read(arguments.theirs);
  for (const std::string& name : arguments.negated) {
    if (!negate(theirs, name)) {
      stop(arguments.theirs + ": no column is called " + name);
    }
  }
  std::printf("%-28s %6s %9s %9s %9s\n", "column", "rows", "offset", "rms", "worst");
  double sum_deg = 0.0;
  int angles = 0;
  for (std::size_t i = 0; i < mine.columns.size(); ++i) {
    const std::string& name = mine.columns[i].name;
    const auto column = theirs.find(name);
    if (!column) continue;
    const Difference d = compare(mine, i, theirs, *column, arguments.shift_s);
    const bool is_angle = mine.columns[i].is_angle;
    const bool is_length = name.starts_with("pelvis_t") && !is_angle;
    const double unit = is_angle ? 180.0 / std::numbers::pi : is_length ? 1e3 : 1.0;
    print(name, d, unit, is_length ? " mm" : "");
    if (!is_angle || d.rows == 0) continue;
    sum_deg += unit * d.rms;
    ++angles;
  }
  if (angles == 0) stop("the files have no angle and no time in common");
  std::printf("mean rms of %d angles: %.2f degrees\n", angles, sum_deg / angles);
  for (const Joint& joint : joints()) {
    const Difference d = compare(mine, theirs, joint, arguments.shift_s);
    const std::string& first = joint.columns[0];
    if (d.rows > 0) print(first + " and next two", d, 180.0 / std::numbers::pi, "");
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::measure(marey::read_arguments(argc, argv));
}
