// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "benchmarks/markers/marker_subject.h"
#include "benchmarks/parts/compare_angles.h"
#include "core/base/degrees.h"

namespace marey {
namespace {

struct Trial {
  std::string name;
  std::string tracks;
  std::string angles;  ///< Empty: of no subject.
  /// Their frames in between are left out.
  double wrong_from_s = 0.0;
  double wrong_to_s = 0.0;
};

struct Person {
  std::string folder;
  std::vector<std::string> still;  ///< Trials for the fit alone.
  std::vector<Trial> trials;
  bool knee_negated = false;
};

std::vector<Person> persons() {
  const std::string ik = "opensim-core/Applications/IK/tests/resources";
  return {
      {"addbiomechanics/Expert2",
       {},
       {{"Expert2 3.5 m/s", "run0350cms.trc", "run0350cms.mot"},
        {"Expert2 9 m/s", "run0900cms.trc", "run0900cms.mot"}}},
      {"nimblephysics/osim/LaiArnoldSubject5",
       {},
       {{"LaiArnold DJ1", "DJ1.trc", "DJ1.mot"},
        // Their pelvis tips by 20 degrees and back there, which its four markers do not.
        {"  less 1.66 to 1.83 s", "DJ1.trc", "DJ1.mot", 1.66, 1.83},
        {"LaiArnold DJ2", "DJ2.trc", "DJ2.mot"}}},
      {"opensim-models/Hamner",
       {"subject02_static.trc"},
       {{"Hamner running",
         "subject02_running.trc",
         "outputReference/ResultsIK/subject02_running_ik.mot"}},
       true},
      {ik,
       {},
       {{"OpenSim synthetic gait",
         "subject01_synthetic_marker_data.trc",
         "std_subject01_walk1_ik.mot"}},
       true},
      {"opensim-models/Rajagopal/ExpData",
       {"static_walk_1.trc"},
       {{"Rajagopal walk", "motion_capture_walk.trc", ""}}},
      {"opensim-models/Rajagopal/ExpData",
       {"static_run.trc"},
       {{"Rajagopal run", "motion_capture_run.trc", ""}}},
  };
}

recordings::MotTable without(const recordings::MotTable& table,
                             double from_s,
                             double to_s) {
  recordings::MotTable out = table;
  out.time_s.clear();
  out.values.clear();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.time_s[row] > from_s && table.time_s[row] < to_s) continue;
    out.time_s.push_back(table.time_s[row]);
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      out.values.push_back(table.at(row, c));
    }
  }
  return out;
}

constexpr std::array<const char*, 6> kCompared{"knee_angle_r",
                                               "knee_angle_l",
                                               "hip_flexion_r",
                                               "hip_flexion_l",
                                               "ankle_angle_r",
                                               "ankle_angle_l"};

void compare(const recordings::MotTable& mine,
             const std::filesystem::path& file,
             const Trial& trial,
             bool knee_negated) {
  auto theirs = recordings::read_mot(file);
  if (!theirs) stop(theirs.error().message());
  *theirs = without(*theirs, trial.wrong_from_s, trial.wrong_to_s);
  if (knee_negated && !negate_columns(*theirs, "knee_angle")) {
    stop(file.string() + ": no knee_angle");
  }
  double squares = 0.0;
  for (const char* name : kCompared) {
    const auto column = theirs->find(name);
    if (!column) stop(file.string() + ": no column is called " + name);
    const Difference d = compare_columns(mine, *mine.find(name), *theirs, *column);
    std::printf(" %5.2f(%+.1f)", kDegreesPerRadian * d.rms, kDegreesPerRadian * d.offset);
    squares += kDegreesPerRadian * kDegreesPerRadian * d.rms * d.rms;
  }
  std::printf("  %5.2f", std::sqrt(squares / static_cast<double>(kCompared.size())));
}

}  // namespace

int measure_flexion(const std::filesystem::path& mocap) {
  std::printf("degrees: RMS without its mean (the mean)\n%-24s", "");
  for (const char* name : kCompared) std::printf(" %-13s", name);
  std::printf(" all; markers\n");
  for (const Person& person : persons()) {
    const auto folder = mocap / person.folder;
    std::vector<std::filesystem::path> files;
    const auto add = [&](const std::string& name) {
      const auto file = folder / name;
      if (std::find(files.begin(), files.end(), file) == files.end()) {
        files.push_back(file);
      }
    };
    for (const Trial& trial : person.trials) add(trial.tracks);
    for (const std::string& still : person.still) add(still);
    const MarkerPerson measured = read_person(files);
    for (const Trial& trial : person.trials) {
      const auto at = std::find(files.begin(), files.end(), folder / trial.tracks);
      const MarkerTracks& tracks =
          measured.trials[static_cast<std::size_t>(at - files.begin())];
      const auto solved = solve(measured.fit.body, tracks);
      std::printf("%-24s", trial.name.c_str());
      if (!trial.angles.empty()) {
        compare(
            angles_of(solved, tracks), folder / trial.angles, trial, person.knee_negated);
      }
      std::printf("  markers' rms %.1f mm\n", 1e3 * solved.rms_m);
    }
  }
  return 0;
}

}  // namespace marey
