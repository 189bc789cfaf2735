// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures how far a posture departs from its source when it is balanced.
//
//   measure_adapt_balance [--data FOLDER] [--postures N] [--targets N] [--json FILE]
//                         [CLIP.(bvh|amc)]...
//
// Each clip provides postures at regular intervals in which a foot stands. Each posture
// gets random targets for one wrist, all within reach of the arm alone (shoulder
// unmoved), and the wrists and ankles of another posture of the clip. Each task is solved
// by the strict method with balance, by the thesis' method with balance and by the strict
// method without balance. Default clips: the clips of FOLDER/mocap. All angles are
// computed here, from the postures, in double.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/adaptation/balance_answers.h"
#include "benchmarks/adaptation/posture_measures.h"
#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/quantile.h"
#include "core/humanoid.h"
#include "core/transform.h"
#include "tests/support/program/paths.h"

namespace marey {
namespace {

/// A foot stands when its ankle is at most this much above the lowest of the clip.
constexpr double kLowAnkle_m = 0.05;
/// Targets lie between these shares of the arm's length from the shoulder.
constexpr double kMinReach = 0.45;
constexpr double kMaxReach = 0.94;

struct Arguments {
  std::filesystem::path data = marey::testing::shared_data();
  std::optional<std::filesystem::path> json;
  std::size_t postures = 12;
  std::size_t targets = 6;
  std::vector<std::filesystem::path> clips;
};

/// The arm reaches alone when the answer without balance meets the target (kMet_mm) and
/// rotates no other segment by more than this angle.
constexpr double kAlone_deg = 0.1;
constexpr double kMet_mm = 1.0;
/// Answers of the strict method beyond this angle are listed one by one.
constexpr double kFar_deg = 30.0;

glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> any;
  glm::dvec3 d{any(random), any(random), any(random)};
  return d / std::max(glm::length(d), 1e-9);
}

std::array<JointIndex, 4> ends_of(const Skeleton& s) {
  return {*s.find(HumanBone::kLeftFoot),
          *s.find(HumanBone::kRightFoot),
          *s.find(HumanBone::kLeftHand),
          *s.find(HumanBone::kRightHand)};
}

/// The start frames of the tasks of a clip, and the standing joints in them.
struct Stances {
  std::vector<std::size_t> frames;
  std::vector<std::vector<JointIndex>> standing;
};

Stances find_stances(const CapturedClip& clip, std::size_t maximum) {
  const Skeleton& skeleton = clip.character.skeleton;
  const auto ends = ends_of(skeleton);
  std::array<double, 2> lowest_m{1e9, 1e9};
  std::vector<std::array<double, 2>> heights_m;
  for (const Pose& pose : clip.poses) {
    const auto world = world_from_joints(skeleton, pose);
    heights_m.push_back(
        {world[index(ends[0])].translation.y, world[index(ends[1])].translation.y});
    for (std::size_t side = 0; side < 2; ++side) {
      lowest_m[side] = std::min(lowest_m[side], heights_m.back()[side]);
    }
  }
  Stances out;
  for (std::size_t n = 0; n < maximum; ++n) {
    const std::size_t frame = (2 * n + 1) * clip.poses.size() / (2 * maximum);
    std::vector<JointIndex> standing;
    for (std::size_t side = 0; side < 2; ++side) {
      if (heights_m[frame][side] < lowest_m[side] + kLowAnkle_m) {
        standing.push_back(ends[side]);
      }
    }
    if (standing.empty()) continue;
    out.frames.push_back(frame);
    out.standing.push_back(std::move(standing));
  }
  return out;
}

void ask_reaches(const CapturedClip& clip,
                 const Arguments& arguments,
                 std::mt19937& random,
                 AllFigures& alone,
                 AllFigures& helped) {
  const Skeleton& skeleton = clip.character.skeleton;
  const auto ends = ends_of(skeleton);
  const Stances stances = find_stances(clip, arguments.postures);
  for (std::size_t n = 0; n < stances.frames.size(); ++n) {
    const Pose& reference = clip.poses[stances.frames[n]];
    const auto world = world_from_joints(skeleton, reference);
    for (std::size_t t = 0; t < arguments.targets; ++t) {
      const JointIndex wrist = ends[2 + t % 2];
      const JointIndex elbow = *skeleton[wrist].parent;
      const JointIndex shoulder = *skeleton[elbow].parent;
      const glm::dvec3& at = world[index(shoulder)].translation;
      const double arm_m =
          glm::distance(at, world[index(elbow)].translation) +
          glm::distance(world[index(elbow)].translation, world[index(wrist)].translation);
      std::uniform_real_distribution<double> share(kMinReach, kMaxReach);
      const glm::dvec3 target = at + arm_m * share(random) * random_direction(random);
      AllFigures one;
      answer_all(
          clip.character, {&reference, stances.standing[n], {wrist}, {target}}, one);
      const Figures& free = one.back();
      const bool is_alone =
          free.other_deg.back() <= kAlone_deg && free.target_mm.back() <= kMet_mm;
      for (std::size_t a = 0; a < one.size(); ++a) {
        (is_alone ? alone : helped)[a].add(one[a]);
      }
      if (is_alone && one[0].other_deg.back() > kFar_deg) {
        std::printf("%s, frame %zu, %s to %.3f %.3f %.3f m: %.1f degrees\n",
                    clip.name.c_str(),
                    stances.frames[n],
                    skeleton[wrist].name.c_str(),
                    target.x,
                    target.y,
                    target.z,
                    one[0].other_deg.back());
      }
    }
  }
}

void ask_pairs(const CapturedClip& clip, AllFigures& figures) {
  const Skeleton& skeleton = clip.character.skeleton;
  const auto ends = ends_of(skeleton);
  for (const CapturedPair& pair : choose_pairs(clip, 12)) {
    const auto far = world_from_joints(skeleton, clip.poses[pair.far_frame]);
    Question asked;
    asked.reference = &clip.poses[pair.near_frame];
    const std::array<bool, 4> stands{pair.left_stands, pair.right_stands, false, false};
    for (std::size_t k = 0; k < ends.size(); ++k) {
      if (stands[k]) {
        asked.standing.push_back(ends[k]);
      } else {
        asked.moved.push_back(ends[k]);
        asked.targets_in_world.push_back(far[index(ends[k])].translation);
      }
    }
    answer_all(clip.character, asked, figures);
  }
}

double worst(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

double percentile(const std::vector<double>& values, double share) {
  return values.empty() ? 0.0 : quantile(values, share);
}

std::vector<TableCell> row_of(const std::string& name, const Figures& f) {
  const auto above = [&](double deg) {
    return static_cast<double>(std::count_if(
        f.other_deg.begin(), f.other_deg.end(), [deg](double d) { return d > deg; }));
  };
  return {name,
          static_cast<double>(f.mean_deg.size()),
          mean(f.mean_deg),
          mean(f.chest_deg),
          worst(f.chest_deg),
          mean(f.other_deg),
          percentile(f.other_deg, 0.95),
          worst(f.other_deg),
          above(30.0),
          percentile(f.target_mm, 0.95),
          worst(f.target_mm),
          worst(f.foot_mm),
          percentile(f.com_mm, 0.95),
          worst(f.com_mm)};
}

ResultTable table_of(const std::string& id, const std::string& title) {
  return {id,
          title,
          {{"who"},
           {"n", 0},
           {"mean", 2},
           {"trunk", 2},
           {"max trunk", 1},
           {"others", 2},
           {"p95", 1},
           {"max", 1},
           {"> 30", 0},
           {"target p95 mm", 2},
           {"max mm", 1},
           {"foot mm", 2},
           {"COM p95 mm", 2},
           {"max mm ", 1}},
          {},
          {"degrees from the source, in the world: mean of all segments; the largest of "
           "spine, chest, neck and head; the largest of all but the limbs that reach"}};
}

[[noreturn]] void stop(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(2);
}

Arguments read_arguments(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool is_option = word.substr(0, 2) == "--";
    if (!is_option) {
      arguments.clips.emplace_back(word);
      continue;
    }
    if (++i == argc) stop("an option lacks its value: " + std::string(word));
    if (word == "--data") {
      arguments.data = argv[i];
    } else if (word == "--json") {
      arguments.json = argv[i];
    } else if (word == "--postures") {
      arguments.postures = std::strtoul(argv[i], nullptr, 10);
    } else if (word == "--targets") {
      arguments.targets = std::strtoul(argv[i], nullptr, 10);
    } else {
      stop("unknown option " + std::string(word));
    }
  }
  return arguments;
}

std::vector<CapturedClip> clips_of(const Arguments& arguments) {
  if (arguments.clips.empty()) {
    auto clips = read_clips(arguments.data / "mocap", ClipSet::kAll);
    if (!clips) stop(clips.error().message());
    return *std::move(clips);
  }
  std::vector<CapturedClip> clips;
  for (const std::filesystem::path& file : arguments.clips) {
    auto clip = read_clip(file, file.stem().string());
    if (!clip) stop(clip.error().message());
    clips.push_back(*std::move(clip));
  }
  return clips;
}

int measure(const Arguments& arguments) {
  AllFigures alone;
  AllFigures helped;
  AllFigures pairs;
  std::mt19937 random(17);
  ResultTable per_clip = table_of("balance_clips", "strict, the arm reaches alone");
  for (const CapturedClip& clip : clips_of(arguments)) {
    AllFigures own;
    ask_reaches(clip, arguments, random, own, helped);
    for (std::size_t a = 0; a < own.size(); ++a) alone[a].add(own[a]);
    per_clip.rows.push_back(row_of(clip.name, own[0]));
    ask_pairs(clip, pairs);
  }
  std::vector<ResultTable> tables{std::move(per_clip)};
  const auto print_row =
      [&](const std::string& id, const std::string& title, const AllFigures& all) {
        tables.push_back(table_of(id, title));
        for (std::size_t a = 0; a < all.size(); ++a) {
          tables.back().rows.push_back(row_of(kAnswerers[a].name, all[a]));
        }
      };
  print_row("balance_alone", "a wrist, the arm reaches alone", alone);
  print_row("balance_helped", "a wrist, the arm alone does not reach", helped);
  print_row("balance_pairs", "wrists and feet of a captured far posture", pairs);
  for (const ResultTable& table : tables) print_table(table);
  if (!arguments.json) return 0;
  const Status written = write_tables(*arguments.json, tables);
  if (!written) stop(written.error().message());
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::measure(marey::read_arguments(argc, argv));
}
