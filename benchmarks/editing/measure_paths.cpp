// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures what the path operation does to captured motions.
//
//   measure_paths ../shared/data/mocap
//
// Applies to each motion of cmu_asfamc/, bandai/ and cmu_bvh_tmoco/: a turn of 90 degrees
// over its length (of at most 4 m: longer ones are cut there), 20 % more and less length,
// and an S through four points. Prints per case, for the source and for the result, as
// they are and with planted feet: the slide (mean horizontal speed of ankles and toe
// joints in contacts of the source), the error of footprints (largest distance of an
// ankle or toe joint in a stance from the rigid image of the source's stance, fitted by
// least squares), and the largest speed of a knee's flexion over the source's. Motions
// that are refused are listed with the cause.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "edit/find/travel_path.h"
#include "edit/ops/path.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"

namespace marey {
namespace {

using edit::EditState;
using Places = std::vector<glm::dvec3>;

/// Places of hip, knee, ankle and toe joint of one side.
struct LegPlaces {
  std::array<Places, 4> joint;
};

std::array<LegPlaces, 2> leg_places(const Motion& motion, const retarget::BodyMap& map) {
  using B = HumanBone;
  constexpr std::array<std::array<B, 4>, 2> kBones{
      {{B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot, B::kLeftToes},
       {B::kRightUpperLeg, B::kRightLowerLeg, B::kRightFoot, B::kRightToes}}};
  std::array<LegPlaces, 2> out;
  for (const Pose& pose : motion.poses) {
    const auto joints = world_from_joints(motion.skeleton, pose);
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t k = 0; k < 4; ++k) {
        const auto joint = map.joint_of[index(kBones[side][k])];
        if (joint) out[side].joint[k].push_back(joints[index(*joint)].translation);
      }
    }
  }
  return out;
}

double slide_cm_per_s(const EditState& of, const Contacts& contacts) {
  const auto legs = leg_places(of.motion, of.map);
  double way_m = 0.0;
  int steps = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t part = 0; part < 2; ++part) {
      const auto& foot = contacts.feet[side];
      const Places& places = legs[side].joint[2 + part];
      if (places.empty()) continue;
      for (const FrameRange& run : part == 0 ? foot.heel : foot.ball) {
        for (int frame = run.first + 1; frame <= run.last; ++frame) {
          const glm::dvec3 step = places[static_cast<std::size_t>(frame)] -
                                  places[static_cast<std::size_t>(frame) - 1];
          way_m += std::hypot(step.x, step.z);
          ++steps;
        }
      }
    }
  }
  return steps == 0 ? 0.0 : 100.0 * way_m / steps * of.motion.rate.hz;
}

/// Returns the largest distance from the best rigid image (turn about the vertical, level
/// shift) of the same stance.
double print_error_mm(const EditState& of, const EditState& source) {
  const auto made = leg_places(of.motion, of.map);
  const auto old = leg_places(source.motion, source.map);
  double worst = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    for (const FrameRange& run : source.contacts.feet[side].stance) {
      std::vector<std::pair<glm::dvec3, glm::dvec3>> pairs;
      for (std::size_t k = 2; k < 4; ++k) {
        for (int frame = run.first; frame <= run.last; ++frame) {
          const auto t = static_cast<std::size_t>(frame);
          if (old[side].joint[k].empty()) continue;
          pairs.emplace_back(old[side].joint[k][t], made[side].joint[k][t]);
        }
      }
      glm::dvec3 a(0.0);
      glm::dvec3 b(0.0);
      for (const auto& [p, q] : pairs) {
        a += p / static_cast<double>(pairs.size());
        b += q / static_cast<double>(pairs.size());
      }
      double sine = 0.0;
      double cosine = 0.0;
      for (const auto& [p, q] : pairs) {
        const glm::dvec3 u = p - a;
        const glm::dvec3 v = q - b;
        sine += u.z * v.x - u.x * v.z;
        cosine += u.x * v.x + u.z * v.z;
      }
      const glm::dquat turn =
          glm::angleAxis(std::atan2(sine, cosine), glm::dvec3(0, 1, 0));
      for (const auto& [p, q] : pairs) {
        worst = std::max(worst, 1e3 * glm::distance(turn * (p - a), q - b));
      }
    }
  }
  return worst;
}

/// Returns the largest speed of a knee's flexion. [rad/s]
double knee_speed(const EditState& of) {
  double largest = 0.0;
  for (const LegPlaces& leg : leg_places(of.motion, of.map)) {
    double before = 0.0;
    for (std::size_t t = 0; t < leg.joint[0].size(); ++t) {
      const glm::dvec3 thigh = leg.joint[1][t] - leg.joint[0][t];
      const glm::dvec3 shank = leg.joint[2][t] - leg.joint[1][t];
      const double flexion =
          std::atan2(glm::length(glm::cross(thigh, shank)), glm::dot(thigh, shank));
      if (t > 0) {
        largest = std::max(largest, std::abs(flexion - before) * of.motion.rate.hz);
      }
      before = flexion;
    }
  }
  return largest;
}

struct Case {
  std::string name;
  PathOp op;
};

std::vector<Case> cases_of(const edit::TravelPath& path) {
  PathOp bent;
  bent.turn_rad = 0.5 * std::numbers::pi;
  PathOp longer;
  longer.length = 1.2;
  PathOp shorter;
  shorter.length = 0.8;
  // An S about the straight line from start to end, a tenth of its length to each side.
  PathOp curved;
  const glm::dvec2 start = path.origin_m.front();
  const glm::dvec2 way = path.origin_m.back() - start;
  const glm::dvec2 aside(way.y, -way.x);
  for (const auto& [along, across] : {std::pair{0.0, 0.0},
                                      std::pair{0.3, 0.1},
                                      std::pair{0.7, -0.1},
                                      std::pair{1.0, 0.0}}) {
    curved.points_xz_m.push_back(start + along * way + across * aside);
  }
  return {{"90 deg", bent}, {"+20 %", longer}, {"-20 %", shorter}, {"S", curved}};
}

/// Cuts a motion where its path is 4 m long.
EditState first_metres(const EditState& state) {
  constexpr double kLength_m = 4.0;
  const edit::TravelPath path = edit::find_travel_path(state);
  int last = 0;
  while (last + 1 < state.frame_count() &&
         path.way_m[static_cast<std::size_t>(last) + 1] <= kLength_m) {
    ++last;
  }
  return edit::slice_state(state, {0, last});
}

double figure_of(const edit::OpReport& report, const std::string& name) {
  for (const auto& [key, value] : report.figures) {
    if (key == name) return value;
  }
  return 0.0;
}

void add_rows(const std::string& name,
              const EditState& whole,
              std::map<std::string, int>& refused,
              ResultTable& table) {
  const EditState source = first_metres(whole);
  EditState stood = source;
  edit::plant_feet(stood);
  for (const Case& c : cases_of(edit::find_travel_path(source))) {
    EditOp with;
    with.parameters = c.op;
    const edit::EditInputs inputs;
    edit::OpReport report;
    const auto made = edit::apply_path(c.op, {with, 0, inputs}, source, report);
    if (!made) {
      ++refused[name + ": " + made.error().cause];
      continue;
    }
    EditState planted = *made;
    edit::plant_feet(planted);
    table.rows.push_back({name,
                          c.name,
                          figure_of(report, "length_m"),
                          slide_cm_per_s(source, source.contacts),
                          slide_cm_per_s(*made, source.contacts),
                          slide_cm_per_s(planted, source.contacts),
                          print_error_mm(*made, source),
                          print_error_mm(planted, stood),
                          knee_speed(*made) / knee_speed(source),
                          knee_speed(planted) / knee_speed(stood),
                          figure_of(report, "turn_rate_deg_per_s"),
                          figure_of(report, "root_sunk_mm"),
                          figure_of(report, "unreachable_frames")});
  }
}

int run(const std::filesystem::path& mocap) {
  ResultTable table{"paths",
                    "Bent and stretched paths of captured motions",
                    {{"motion"},
                     {"path"},
                     {"length m", 2},
                     {"slide source cm/s", 2},
                     {"result", 2},
                     {"planted", 3},
                     {"print error mm", 4},
                     {"planted", 4},
                     {"knee ratio", 3},
                     {"planted", 3},
                     {"turn rate deg/s", 0},
                     {"root sunk mm", 0},
                     {"unreachable", 0}},
                    {},
                    {}};
  std::map<std::string, int> refused;
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"cmu_asfamc", "bandai", "cmu_bvh_tmoco"}) {
    if (!std::filesystem::exists(mocap / folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(mocap / folder)) {
      const auto kind = entry.path().extension();
      if (kind == ".amc" || kind == ".bvh") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    const std::string name = file.stem().string() + file.extension().string();
    const auto clip = read_clip(file, name);
    if (!clip) {
      ++refused[name + ": " + clip.error().cause];
      continue;
    }
    const auto state = edit::make_edit_state(
        {clip->character.skeleton, {clip->rate_hz}, 0, clip->poses});
    if (!state) {
      ++refused[name + ": " + state.error().cause];
      continue;
    }
    add_rows(name, *state, refused, table);
  }
  print_table(table);
  for (const auto& [cause, count] : refused) {
    std::printf("refused %d x %s\n", count, cause.c_str());
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: measure_paths MOCAP_FOLDER\n");
    return 2;
  }
  return marey::run(argv[1]);
}
