// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_floor FOLDER...
//
// The floor under motions (library/clips/put_on_floor.h), on the BVH and AMC files below
// the folders. Compares it with soles that do not move, whatever their height: ankles and
// toe joints that move by less than 1.7 % of the leg in 0.1 s. Prints, per file and for
// all: the floor; the lower twentieth and the median of the heights of these soles over
// it, and the lowest sole of all. docs/accuracy/library_duplicates.md has figures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "library/clips/put_on_floor.h"

#include "app/motion/retarget_files.h"
#include "benchmarks/library/library_clips.h"
#include "core/base/parallel.h"
#include "core/base/quantile.h"
#include "core/pose.h"

namespace marey {
namespace {

constexpr double kStill_legs = 0.017;

struct MeasuredFloor {
  bool is_known = false;
  double floor_m = 0.0;
  double still_low_m = 0.0;
  double still_middle_m = 0.0;
  double lowest_m = 0.0;
};

std::vector<std::vector<glm::dvec3>> sole_paths(const Motion& motion,
                                                const retarget::BodyMap& map) {
  std::vector<std::vector<glm::dvec3>> out(4);
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    for (std::size_t side = 0; side < 2; ++side) {
      const retarget::FootMap& foot = map.feet[side];
      const auto add = [&](std::size_t path, JointIndex joint, double height_m) {
        out[path].push_back(world[index(joint)].translation -
                            glm::dvec3(0.0, height_m, 0.0));
      };
      add(2 * side, map.leg(static_cast<int>(side)).end, foot.ankle_height_m);
      const auto toes =
          map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
      if (toes) add(2 * side + 1, *toes, foot.ball_height_m);
    }
  }
  return out;
}

MeasuredFloor measure(const Motion& motion, const retarget::BodyMap& map) {
  const auto floor_m = library::floor_height_m(motion, map);
  if (!floor_m) return {};
  const auto half =
      static_cast<std::size_t>(std::max(1L, std::lround(0.05 * motion.rate.hz)));
  std::vector<double> still;
  std::vector<double> all;
  for (const auto& path : sole_paths(motion, map)) {
    for (std::size_t t = 0; t < path.size(); ++t) {
      all.push_back(path[t].y - *floor_m);
      if (t < half || t + half >= path.size()) continue;
      if (glm::distance(path[t - half], path[t + half]) <
          kStill_legs * map.leg_length_m) {
        still.push_back(path[t].y - *floor_m);
      }
    }
  }
  if (still.empty()) return {};
  return {true,
          *floor_m,
          quantile(still, 0.05),
          median(still),
          *std::min_element(all.begin(), all.end())};
}

void print_quantiles(const char* title, const std::vector<double>& values_m) {
  std::printf("%-36s", title);
  for (const double share : {0.0, 0.01, 0.05, 0.5, 0.95, 0.99, 1.0}) {
    std::printf(" %7.1f", 1000.0 * quantile(values_m, share));
  }
  std::printf("\n");
}

int run(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  for (int k = 1; k < argc; ++k) {
    for (const char* ending : {".amc", ".bvh"}) {
      const auto more = files_below(argv[k], ending);
      files.insert(files.end(), more.begin(), more.end());
    }
  }
  std::vector<MeasuredFloor> floors(files.size());
  in_parallel(files.size(), 2, [&](std::size_t k) {
    const auto read = app::read_motion(files[k]);
    if (!read) return;
    const auto map = retarget::map_body((*read).motion.skeleton);
    if (map) floors[k] = measure((*read).motion, *map);
  });
  std::vector<double> low;
  std::vector<double> middle;
  std::vector<double> lowest;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const MeasuredFloor& one = floors[k];
    if (!one.is_known) continue;
    std::printf("%-44s floor %7.3f m; still %6.1f, %6.1f; lowest %6.1f mm\n",
                files[k].filename().c_str(),
                one.floor_m,
                1000.0 * one.still_low_m,
                1000.0 * one.still_middle_m,
                1000.0 * one.lowest_m);
    low.push_back(one.still_low_m);
    middle.push_back(one.still_middle_m);
    lowest.push_back(one.lowest_m);
  }
  if (low.empty()) return 1;
  std::printf("%zu motions of %zu files; quantiles 0, 1, 5, 50, 95, 99, 100 %%, mm\n",
              low.size(),
              files.size());
  print_quantiles("still soles, lower twentieth", low);
  print_quantiles("still soles, median", middle);
  print_quantiles("lowest sole", lowest);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "use: measure_floor FOLDER...\n");
    return 2;
  }
  return marey::run(argc, argv);
}
