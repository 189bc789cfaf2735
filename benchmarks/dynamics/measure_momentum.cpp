// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_momentum DATA [FOLDER ...]
//
// Angular momentum of captured flights before and after the repair, and the displacement
// that makes them fall freely. DATA is the shared data; each FOLDER adds all .bvh and
// .amc files in it. Prints one row per clip of DATA, and a summary of all flights.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/jumps/find_jumps.h"
#include "dynamics/momentum/ballistic.h"
#include "dynamics/momentum/repair_flight.h"
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "benchmarks/dynamics/jump_clips.h"
#include "core/base/frame_range.h"
#include "core/base/quantile.h"
#include "core/base/stopwatch.h"
#include "tests/support/truth/momentum_judge.h"

namespace marey {
namespace {

using testing::Differences;

constexpr double kDegrees = 57.295779513082321;
// At both ends of a flight the feet may still bear: an edge is known to some 10 ms.
constexpr double kEdge_s = 0.03;
constexpr double kBar_kg_m2_s = 0.01;

struct FlightFigures {
  std::string name;
  double flight_s = 0.0;
  double fall_m_s2 = 0.0;
  double sd_inner = 0.0;  // Captured, without kEdge_s at both ends.
  double sd_stance = 0.0, sd_before = 0.0, sd_after = 0.0;  // Judged, three points.
  double five_before = 0.0, five_after = 0.0;               // Judged, five points.
  double turn_deg = 0.0, landing_deg = 0.0;
  double com_off_m = 0.0;
  double us_per_frame = 0.0;
  double fit_rms_m = 0.0;    // In height from the best parabola, as sd_inner.
  double moved_rms_m = 0.0;  // By make_ballistic().
  bool applied = false;
};

double judged_sd(const JumpClip& clip, std::span<const Pose> poses, Differences kind) {
  return testing::largest_sd(testing::judged_momentum(
      clip.motion.skeleton, clip.masses, clip.hz(), poses, kind));
}

// Rms distance in height from the best parabola of 9.81 m/s^2.
double free_fall_rms_m(const JumpClip& clip, std::span<const Pose> poses) {
  std::vector<glm::dvec3> places;
  double mean_t = 0.0;
  glm::dvec3 mean(0.0);
  const auto n = static_cast<double>(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double t = static_cast<double>(k) / clip.hz();
    places.push_back(testing::judged_com(clip.motion.skeleton, clip.masses, poses[k]) +
                     glm::dvec3(0.0, 0.5 * 9.81 * t * t, 0.0));
    mean_t += t / n;
    mean += places.back() / n;
  }
  glm::dvec3 slope(0.0);
  double squares = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double t = static_cast<double>(k) / clip.hz() - mean_t;
    slope += t * places[k];
    squares += t * t;
  }
  slope /= squares;
  double sum = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double t = static_cast<double>(k) / clip.hz() - mean_t;
    const glm::dvec3 off = places[k] - mean - t * slope;
    sum += off.y * off.y;
  }
  return std::sqrt(sum / n);
}

// Angle between two rotations, from the chord.
double turn_rad(const glm::dquat& a, const glm::dquat& b) {
  const glm::dquat d = glm::dot(a, b) < 0.0 ? a + b : a - b;
  return 4.0 * std::asin(std::min(0.5 * std::sqrt(glm::dot(d, d)), 1.0));
}

FlightFigures measure_flight(const JumpClip& clip,
                             const dynamics::Jump& jump,
                             const FrameRange& frames) {
  const std::vector<Pose>& poses = clip.motion.poses;
  const auto first = static_cast<std::size_t>(frames.first);
  const auto last = static_cast<std::size_t>(frames.last);
  const std::vector<Pose> captured(poses.begin() + frames.first,
                                   poses.begin() + frames.last + 1);
  std::vector<Pose> repaired = captured;
  FlightFigures out;
  out.name = clip.name;
  out.flight_s = jump.touchdown->time_s - jump.takeoff.time_s;
  out.fall_m_s2 = jump.fall_m_s2;
  // The fastest of some runs: others include waiting for the processor.
  constexpr int kRuns = 5;
  out.us_per_frame = 1e9;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Pose> again = captured;
    const Stopwatch watch;
    const auto report = dynamics::keep_angular_momentum(
        clip.motion.skeleton, clip.masses, clip.motion.rate, again);
    out.us_per_frame = std::min(
        out.us_per_frame, 1e6 * watch.seconds() / static_cast<double>(captured.size()));
    out.applied = report.applied;
  }
  const dynamics::MomentumRepair report = dynamics::keep_angular_momentum(
      clip.motion.skeleton, clip.masses, clip.motion.rate, repaired);
  out.sd_before = judged_sd(clip, captured, Differences::kThreePoint);
  out.sd_after = judged_sd(clip, repaired, Differences::kThreePoint);
  out.five_before = judged_sd(clip, captured, Differences::kFivePoint);
  out.five_after = judged_sd(clip, repaired, Differences::kFivePoint);
  const auto push =
      static_cast<std::size_t>(std::max(0.0, std::floor(jump.start.time_s * clip.hz())));
  if (push + 3 < first) {
    out.sd_stance = judged_sd(
        clip, std::span(poses).subspan(push, first - push), Differences::kThreePoint);
  }
  for (std::size_t k = 0; k < captured.size(); ++k) {
    const auto com = [&](const Pose& pose) {
      return testing::judged_com(clip.motion.skeleton, clip.masses, pose);
    };
    const double angle = kDegrees * turn_rad(captured[k].parent_from_joint[0],
                                             repaired[k].parent_from_joint[0]);
    out.turn_deg = std::max(out.turn_deg, angle);
    if (first + k == last) out.landing_deg = angle;
    out.com_off_m =
        std::max(out.com_off_m, glm::distance(com(captured[k]), com(repaired[k])));
  }
  out.turn_deg = report.applied ? out.turn_deg : kDegrees * report.largest_turn_rad;
  const auto edge = static_cast<std::size_t>(std::ceil(kEdge_s * clip.hz()));
  if (captured.size() > 2 * edge + 3) {
    const auto inner = std::span(captured).subspan(edge, captured.size() - 2 * edge);
    out.sd_inner = judged_sd(clip, inner, Differences::kThreePoint);
    out.fit_rms_m = free_fall_rms_m(clip, inner);
  }
  repaired = captured;
  out.moved_rms_m = dynamics::make_ballistic(clip.motion.skeleton,
                                             clip.masses,
                                             clip.motion.rate,
                                             repaired,
                                             {.keep_momentum = false})
                        .moved_rms_m;
  return out;
}

void measure_clip(const JumpClip& clip, std::vector<FlightFigures>& out) {
  for (const dynamics::Jump& jump : dynamics::find_jumps(clip.track)) {
    if (!jump.touchdown) continue;
    const auto frames = dynamics::flight_frames(jump.takeoff.time_s,
                                                jump.touchdown->time_s,
                                                clip.motion.rate,
                                                clip.motion.poses.size());
    // Five-point differences need some frames to vary in.
    if (!frames || frames->last - frames->first < 6) continue;
    out.push_back(measure_flight(clip, jump, *frames));
  }
}

void print_header() {
  std::printf(
      "flight                       s     fall stance  inner  before   after  5-pt "
      "before after "
      " turn landing  COM off   us   height     moved\n"
      "                                  m/s2 ------------------- sd, kg m2/s "
      "------------- "
      "   deg     deg        m frame      mm        mm\n");
}

void print_row(const FlightFigures& f) {
  std::printf(
      "%-26s %.3f %7.2f %6.2f %6.2f %7.2f %7.1e %8.2f %8.3f %6.2f %7.1e %8.1e %5.1f "
      "%8.1f %8.1f%s\n",
      f.name.c_str(),
      f.flight_s,
      f.fall_m_s2,
      f.sd_stance,
      f.sd_inner,
      f.sd_before,
      f.sd_after,
      f.five_before,
      f.five_after,
      f.turn_deg,
      f.landing_deg,
      f.com_off_m,
      f.us_per_frame,
      1e3 * f.fit_rms_m,
      1e3 * f.moved_rms_m,
      f.applied ? "" : "  not applied");
}

void summarize(const char* title, const std::vector<FlightFigures>& flights) {
  if (flights.empty()) return;
  const auto values = [&](double FlightFigures::*member) {
    std::vector<double> out;
    for (const FlightFigures& f : flights) out.push_back(f.*member);
    return out;
  };
  const auto print = [&](const char* name, double FlightFigures::*member, double factor) {
    const std::vector<double> all = values(member);
    std::printf("  %-34s median %9.3g  90 %% %9.3g  worst %9.3g\n",
                name,
                factor * median(all),
                factor * quantile(all, 0.9),
                factor * *std::ranges::max_element(all));
  };
  const auto count = [&](const auto& rule) {
    return static_cast<int>(std::ranges::count_if(flights, rule));
  };
  std::printf(
      "%s: %zu flights, repaired %d, of these at most %.2f kg m2/s: %d, turn at "
      "most 1.5 deg: %d\n",
      title,
      flights.size(),
      count([](const auto& f) { return f.applied; }),
      kBar_kg_m2_s,
      count([](const auto& f) { return f.applied && f.sd_after <= kBar_kg_m2_s; }),
      count([](const auto& f) { return f.applied && f.turn_deg <= 1.5; }));
  print("sd before, kg m2/s", &FlightFigures::sd_before, 1.0);
  print("sd after, kg m2/s", &FlightFigures::sd_after, 1.0);
  print("sd after, five points, kg m2/s", &FlightFigures::five_after, 1.0);
  print("turn, deg", &FlightFigures::turn_deg, 1.0);
  print("landing turn, deg", &FlightFigures::landing_deg, 1.0);
  print("COM off, m", &FlightFigures::com_off_m, 1.0);
  print("us per frame", &FlightFigures::us_per_frame, 1.0);
  print("height off best parabola, rms mm", &FlightFigures::fit_rms_m, 1e3);
  print("make_ballistic moves, rms mm", &FlightFigures::moved_rms_m, 1e3);
}

int measure(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: measure_momentum DATA [FOLDER ...]\n");
    return 2;
  }
  std::vector<FlightFigures> flights;
  for (const JumpClip& clip : jump_clips(argv[1])) measure_clip(clip, flights);
  print_header();
  for (const FlightFigures& f : flights) print_row(f);
  summarize("clips", flights);
  for (int i = 2; i < argc; ++i) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
      const auto ending = entry.path().extension();
      if (ending == ".bvh" || ending == ".amc") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    std::vector<FlightFigures> more;
    int unreadable = 0;
    for (const auto& file : files) {
      if (const auto clip = read_jump_clip(file, "clip")) {
        measure_clip(*clip, more);
      } else {
        ++unreadable;
      }
    }
    std::printf("%s: %zu files, %d not read\n", argv[i], files.size(), unreadable);
    summarize(argv[i], more);
    std::ranges::sort(more, {}, [](const FlightFigures& f) { return -f.turn_deg; });
    if (more.size() > 10) more.resize(10);
    print_header();
    for (const FlightFigures& f : more) print_row(f);
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::measure(argc, argv);
}
