// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the differences of joint angles from another program's, for every column that
// two motion files share:
//
//   measure_angles MINE.mot THEIRS.mot [--negate COLUMN]... [--shift SECONDS]
//
// MINE is interpolated at the times of THEIRS that it covers. Two models of a body rarely
// agree on the zero of an angle. Therefore the mean difference is printed separately, as
// the offset; the root mean square and the largest value are those of the residual.
// Angles are in degrees, pelvis_tx, ty and tz in mm, and columns that are no coordinates
// in their own unit. A difference of full turns counts as zero.
//
// Then compares the joints of three angles as one rotation each: the angle between the
// two rotations. Neither gimbal lock nor the choice between the two equivalent triples of
// a rotation affects this angle.
//
// --negate knee_angle: THEIRS has the opposite sign of knee_angle_r and _l, as in
// gait2392, gait2354 and Hamner's model. --shift: MINE's times are too early by this
// amount.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/parts/compare_angles.h"
#include "core/base/degrees.h"
#include "recordings/motion/mot.h"

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

void print(const std::string& name, const Difference& d, double unit, const char* word) {
  std::printf("%-28s %6zu %9.2f %9.2f %9.2f%s\n",
              name.c_str(),
              d.rows,
              unit * d.offset,
              unit * d.rms,
              unit * d.worst,
              word);
}

int measure(const Arguments& arguments) {
  const MotTable mine = read(arguments.mine);
  MotTable theirs = read(arguments.theirs);
  for (const std::string& name : arguments.negated) {
    if (!negate_columns(theirs, name)) {
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
    const Difference d = compare_columns(mine, i, theirs, *column, arguments.shift_s);
    const bool is_angle = mine.columns[i].is_angle;
    const bool is_length = name.starts_with("pelvis_t") && !is_angle;
    const double unit = is_angle ? kDegreesPerRadian : is_length ? 1e3 : 1.0;
    print(name, d, unit, is_length ? " mm" : "");
    if (!is_angle || d.rows == 0) continue;
    sum_deg += unit * d.rms;
    ++angles;
  }
  if (angles == 0) stop("the files have no angle and no time in common");
  std::printf("mean rms of %d angles: %.2f degrees\n", angles, sum_deg / angles);
  for (const AngleTriple& triple : angle_triples()) {
    const Difference d = compare_rotations(mine, theirs, triple, arguments.shift_s);
    const std::string& first = triple.columns[0];
    if (d.rows > 0) print(first + " and next two", d, kDegreesPerRadian, "");
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::measure(marey::read_arguments(argc, argv));
}
