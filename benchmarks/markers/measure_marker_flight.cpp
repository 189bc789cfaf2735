// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "dynamics/flight/find_flights.h"

#include "benchmarks/markers/marker_subject.h"

namespace marey {
namespace {

struct Interval {
  double first_s, last_s;
};

/// When no plate bears anything, between two times when some do.
std::vector<Interval> unloaded(const recordings::MotTable& forces) {
  constexpr double kMinN = 20.0;
  constexpr double kMinFlight_s = 0.03;
  std::vector<std::size_t> vertical;
  for (std::size_t c = 0; c < forces.columns.size(); ++c) {
    const std::string& name = forces.columns[c].name;
    if (name.ends_with("_vy")) vertical.push_back(c);
  }
  std::vector<Interval> out;
  bool bore = false;
  double since_s = 0.0;
  for (std::size_t row = 0; row < forces.rows(); ++row) {
    double sum_N = 0.0;
    for (const std::size_t c : vertical) sum_N += forces.at(row, c);
    const bool bears = std::abs(sum_N) > kMinN;
    const double time_s = forces.time_s[row];
    if (bears && !bore && since_s > 0.0 && time_s - since_s > kMinFlight_s) {
      out.push_back({since_s, time_s});
    }
    if (!bears && bore) since_s = time_s;
    bore = bears;
  }
  return out;
}

void compare(const char* name,
             const MarkerPerson& person,
             std::size_t trial,
             const std::filesystem::path& forces_file) {
  const MarkerTracks& tracks = person.trials[trial];
  const auto forces = recordings::read_mot(forces_file);
  if (!forces) stop(forces.error().message());
  const auto solved = solve(person.fit.body, tracks);
  const auto flights = dynamics::find_flights(solved.estimate.motion);
  const double pose_ms = 1e3 / tracks.rate.hz;
  std::array<double, 3> mean_ms{};
  std::array<double, 3> worst_ms{};
  int matched = 0;
  const auto real = unloaded(*forces);
  for (const Interval& truth : real) {
    for (const auto& flight : flights) {
      const double takeoff_s = tracks.start_s + flight.takeoff_s;
      const double landing_s = tracks.start_s + flight.landing_s;
      if (takeoff_s > truth.last_s || landing_s < truth.first_s) continue;
      const double late_ms = 1e3 * (takeoff_s - truth.first_s);
      const double landing_late_ms = 1e3 * (landing_s - truth.last_s);
      const std::array off_ms{late_ms, landing_late_ms, landing_late_ms - late_ms};
      for (std::size_t i = 0; i < off_ms.size(); ++i) {
        mean_ms[i] += off_ms[i];
        worst_ms[i] = std::max(worst_ms[i], std::abs(off_ms[i]));
      }
      if (real.size() == 1) {
        std::printf(
            "%-18s plates %.3f to %.3f s, ours %.3f to %.3f s; rise %.3f m, "
            "falls with %.2f m/s^2\n",
            name,
            truth.first_s,
            truth.last_s,
            takeoff_s,
            landing_s,
            flight.rise_m,
            flight.acceleration_m_s2);
      }
      ++matched;
      break;
    }
  }
  for (double& ms : mean_ms) ms /= std::max(matched, 1);
  std::printf(
      "%-18s %2d of %2zu flights (%zu found), a pose is %.1f ms: mean (worst) late, "
      "take-off %+.1f (%.1f), landing %+.1f (%.1f), duration %+.1f (%.1f) ms\n",
      name,
      matched,
      real.size(),
      flights.size(),
      pose_ms,
      mean_ms[0],
      worst_ms[0],
      mean_ms[1],
      worst_ms[1],
      mean_ms[2],
      worst_ms[2]);
}

}  // namespace

int measure_flight(const std::filesystem::path& mocap) {
  const auto lai = mocap / "nimblephysics/osim/LaiArnoldSubject5";
  const auto hamner = mocap / "opensim-models/Hamner";
  const auto rajagopal = mocap / "opensim-models/Rajagopal/ExpData";
  const auto person = [](const std::filesystem::path& a, const std::filesystem::path& b) {
    return read_person(std::vector{a, b});
  };
  compare("drop jump DJ1",
          person(lai / "DJ1.trc", lai / "DJ2.trc"),
          0,
          lai / "DJ1_forces.mot");
  compare("Rajagopal running",
          person(rajagopal / "motion_capture_run.trc", rajagopal / "static_run.trc"),
          0,
          rajagopal / "grf_run.mot");
  compare("Hamner running",
          person(hamner / "subject02_running.trc", hamner / "subject02_static.trc"),
          0,
          hamner / "subject02_running_grf.mot");
  return 0;
}

}  // namespace marey
