// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_duplicates FOLDER [--half tuning|held|all] [--only CAUSE] [--list]
// measure_duplicates FOLDER --clips N
//
// The search for duplicates (library/duplicates/find_duplicates.h) on the BVH and AMC
// files of FOLDER/bandai and FOLDER/cmu: false duplicates among the clips as they are,
// and copies by cause. With --clips, time and recall on N
// clips made of them instead.
// docs/accuracy/library_duplicates.md has figures. Bandai's clips belong to one half by a
// hash of their name: limits were chosen on the tuning half. --list prints all errors.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "library/clips/normal_form.h"
#include "library/clips/put_on_floor.h"
#include "library/duplicates/find_duplicates.h"
#include "library/features/body_features.h"

#include "app/motion/retarget_files.h"
#include "benchmarks/library/library_clips.h"
#include "core/base/parallel.h"
#include "core/human/average_proportions.h"
#include "core/resample.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using library::DuplicateClip;
using Rows = std::vector<float>;

struct Options {
  fs::path folder;
  std::string half = "held";
  int made_clips = 0;
  bool lists_errors = false;
  std::string only;  ///< Start of the names of the causes measured; empty: all.
};

struct SourceMotion {
  std::string name;
  Motion motion;  ///< On the floor.
};

[[noreturn]] void stop(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

retarget::BodyMap body_map(const Motion& motion) {
  auto map = retarget::map_body(motion.skeleton);
  if (!map) stop(map.error().message());
  return std::move(*map);
}

Rows features_of(Motion motion) {
  const retarget::BodyMap map = body_map(motion);
  library::put_on_floor(motion, map);
  return library::body_features(motion, map).rows;
}

std::vector<SourceMotion> read_motions(const fs::path& folder, const Options& options) {
  std::vector<fs::path> files;
  for (const char* ending : {".amc", ".bvh"}) {
    for (const fs::path& file : files_below(folder, ending)) {
      const bool is_bandai = file.stem().string().starts_with("dataset");
      const bool is_tuning = is_tuned_on(file.stem().string());
      if (!is_bandai || options.half == "all" ||
          is_tuning == (options.half == "tuning")) {
        files.push_back(file);
      }
    }
  }
  std::vector<SourceMotion> out(files.size());
  in_parallel(files.size(), 2, [&](std::size_t k) {
    auto read = app::read_motion(files[k]);
    if (!read) stop(read.error().message());
    auto clip = library::make_library_motion((*read).motion);
    if (!clip) stop(clip.error().message());
    out[k] = {files[k].stem().string(), std::move((*clip).motion)};
  });
  return out;
}

/// Clips in memory, and their names.
struct Clips {
  std::vector<float> values;
  std::vector<std::uint64_t> begins{0};
  std::vector<std::string> names;

  void add(const std::string& name, const Rows& rows) {
    values.insert(values.end(), rows.begin(), rows.end());
    begins.push_back(values.size() / library::kFeatureStride);
    names.push_back(name);
  }
  [[nodiscard]] library::ClipRows rows() const {
    return {values, library::kFeatureStride, begins};
  }
};

/// A change of a motion that leaves a duplicate, or nullopt if the motion is too short.
struct Cause {
  const char* name = "";
  std::function<std::optional<Rows>(const Motion&)> copy;
};

Motion at_rate(const Motion& motion, double hz) {
  return resample(motion, FrameRate{hz});
}

std::optional<Rows> cut_copy(const Motion& motion, double from, double to, double hz) {
  const auto count = static_cast<double>(motion.poses.size());
  LibraryMotion whole{motion, std::vector<FootParts>(motion.poses.size()), {}};
  const int first = static_cast<int>(from * count);
  const int last = static_cast<int>(to * count) - 1;
  if ((last - first) / motion.rate.hz < 1.5) return std::nullopt;
  Motion part = library::part_of(whole, first, last).motion;
  part.first_frame = 0;
  if (hz > 0.0) part = at_rate(part, hz);
  return features_of(std::move(part));
}

std::vector<Cause> causes(const std::vector<Skeleton>& bodies) {
  std::vector<Cause> out;
  out.push_back({"same rows", [](const Motion& m) { return features_of(m); }});
  const auto at_factor = [](double factor) {
    return [=](const Motion& m) { return features_of(at_rate(m, factor * m.rate.hz)); };
  };
  out.push_back({"rate x 0.8", at_factor(0.8)});
  out.push_back({"rate x 2", at_factor(2.0)});
  out.push_back({"rate x 0.5", at_factor(0.5)});
  out.push_back({"cut, middle 60 %, 1.5 s or more",
                 [](const Motion& m) { return cut_copy(m, 0.23, 0.83, 0.0); }});
  out.push_back({"cut, last 70 %, rate x 2", [](const Motion& m) {
                   return cut_copy(m, 0.31, 1.0, 2.0 * m.rate.hz);
                 }});
  out.push_back({"mirror image", [](const Motion& m) {
                   return library::mirrored_features(features_of(m));
                 }});
  out.push_back({"mirror image of a cut", [](const Motion& m) -> std::optional<Rows> {
                   const auto rows = cut_copy(m, 0.23, 0.83, 0.0);
                   if (!rows) return std::nullopt;
                   return library::mirrored_features(*rows);
                 }});
  static constexpr const char* kBodies[] = {
      "other body: average adult", "other body: CMU 02", "other body: 101 joints"};
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Skeleton& body = bodies[b];
    out.push_back({kBodies[b], [&body](const Motion& m) -> std::optional<Rows> {
                     auto other = retarget::retarget_motion(m, body);
                     if (!other) return std::nullopt;
                     return features_of(at_rate((*other).motion, 24.0));
                   }});
  }
  return out;
}

struct Tally {
  int copies = 0, right = 0, elsewhere = 0, missed = 0;
};

// Originals first, then their copies.
void measure_cause(const Cause& cause,
                   const std::vector<SourceMotion>& motions,
                   const Options& options) {
  std::vector<std::optional<Rows>> copies(motions.size());
  std::vector<Rows> rows(motions.size());
  in_parallel(motions.size(), 2, [&](std::size_t k) {
    rows[k] = features_of(motions[k].motion);
    copies[k] = cause.copy(motions[k].motion);
  });
  // The second library has the originals of odd numbers, and the copies of the others.
  Clips with;
  Clips without;
  std::vector<int> original_of(motions.size(), -1);
  for (std::size_t k = 0; k < motions.size(); ++k) with.add(motions[k].name, rows[k]);
  for (std::size_t k = 1; k < motions.size(); k += 2) {
    without.add(motions[k].name, rows[k]);
  }
  const int kept = static_cast<int>(without.names.size());
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (!copies[k]) continue;
    with.add(motions[k].name, *copies[k]);
    original_of.push_back(static_cast<int>(k));
    if (k % 2 == 0) without.add(motions[k].name, *copies[k]);
  }
  Tally tally;
  std::vector<int> found(with.names.size(), -1);
  for (const DuplicateClip& one : library::find_duplicates(with.rows(), {}, 2)) {
    found[static_cast<std::size_t>(one.clip)] = one.original;
  }
  for (std::size_t c = motions.size(); c < found.size(); ++c) {
    ++tally.copies;
    if (found[c] == original_of[c]) {
      ++tally.right;
      continue;
    }
    ++(found[c] < 0 ? tally.missed : tally.elsewhere);
    if (options.lists_errors) {
      std::printf("  %s: %s\n",
                  with.names[c].c_str(),
                  found[c] < 0 ? "missed"
                               : with.names[static_cast<std::size_t>(found[c])].c_str());
    }
  }
  int false_ones = 0;
  for (const DuplicateClip& one : library::find_duplicates(without.rows(), {}, 2)) {
    if (one.clip < kept) continue;
    ++false_ones;
  }
  const int asked = static_cast<int>(without.names.size()) - kept;
  std::printf("%-34s %6d %7.4f %7d %7d   %d of %d\n",
              cause.name,
              tally.copies,
              static_cast<double>(tally.right) / std::max(1, tally.copies),
              tally.elsewhere,
              tally.missed,
              false_ones,
              asked);
  std::fflush(stdout);
}

void print_found(const Clips& clips, const std::vector<DuplicateClip>& found) {
  for (const DuplicateClip& one : found) {
    std::printf("  %s: %s%s%s, shift %.2f s, distance %.3f\n",
                clips.names[static_cast<std::size_t>(one.clip)].c_str(),
                clips.names[static_cast<std::size_t>(one.original)].c_str(),
                one.is_contained ? ", contained" : "",
                one.is_mirrored ? ", mirrored" : "",
                one.shift_s,
                one.distance);
  }
}

void measure_library(const Options& options) {
  const auto bandai = read_motions(options.folder / "bandai", options);
  const auto cmu = read_motions(options.folder / "cmu", options);
  Clips clips;
  for (const auto& one : bandai) clips.add(one.name, features_of(one.motion));
  const auto alone = library::find_duplicates(clips.rows(), {}, 2);
  std::printf(
      "%zu clips of Bandai as they are: %zu duplicates\n", bandai.size(), alone.size());
  print_found(clips, alone);
  for (const auto& one : cmu) clips.add(one.name, features_of(one.motion));
  const auto all = library::find_duplicates(clips.rows(), {}, 2);
  std::printf("with %zu motions of CMU: %zu duplicates\n", cmu.size(), all.size());
  print_found(clips, all);
  std::vector<Skeleton> bodies{make_humanoid(average_proportions(1.6))};
  for (const char* name : {"02_05", "002_05"}) {
    const auto there = std::find_if(
        cmu.begin(), cmu.end(), [&](const auto& one) { return one.name == name; });
    if (there == cmu.end()) stop("no motion " + std::string(name));
    bodies.push_back(there->motion.skeleton);
  }
  std::printf("%-34s %6s %7s %7s %7s   %s\n",
              "copies",
              "clips",
              "right",
              "other",
              "missed",
              "found without original");
  for (const Cause& cause : causes(bodies)) {
    if (!std::string(cause.name).starts_with(options.only)) continue;
    measure_cause(cause, bandai, options);
  }
}

// Another motion of the same kind: slower or faster, each column enlarged or reduced.
Rows varied(const Rows& rows, testing::Dice& dice) {
  constexpr auto kStride = static_cast<std::size_t>(library::kFeatureStride);
  const double speed = dice.between(0.7, 1.4);
  std::array<float, kStride> factors{};
  for (float& factor : factors) factor = static_cast<float>(dice.between(0.7, 1.3));
  const std::size_t count = rows.size() / kStride;
  Rows out;
  for (double at = 0.0; at <= static_cast<double>(count - 1); at += speed) {
    const auto before = static_cast<std::size_t>(at);
    const std::size_t after = std::min(before + 1, count - 1);
    const auto part = static_cast<float>(at - static_cast<double>(before));
    for (std::size_t c = 0; c < kStride; ++c) {
      const float value =
          (1.0F - part) * rows[before * kStride + c] + part * rows[after * kStride + c];
      out.push_back(factors[c] * value);
    }
  }
  return out;
}

// Every tenth clip is a disturbed copy of an earlier one: the same, a part, or mirrored.
void measure_scale(const Options& options) {
  std::vector<Rows> sources;
  for (const auto& one : read_motions(options.folder / "bandai", options)) {
    sources.push_back(features_of(one.motion));
  }
  testing::Dice dice(20);
  Clips clips;
  std::vector<int> original_of;
  for (int k = 0; k < options.made_clips; ++k) {
    if (k % 10 != 9) {
      clips.add("", varied(sources[static_cast<std::size_t>(k) % sources.size()], dice));
      original_of.push_back(-1);
      continue;
    }
    const int original = k - 1 - static_cast<int>(dice.between(0.0, 8.9));
    const auto all = clips.rows().rows(original);
    Rows copy(all.begin(), all.end());
    const int count = static_cast<int>(copy.size()) / library::kFeatureStride;
    if (k % 30 == 19) {
      const int first = static_cast<int>(dice.between(0.0, 0.4) * count);
      copy = Rows(all.begin() + first * library::kFeatureStride, all.end());
    }
    for (std::size_t v = 0; v < copy.size(); ++v) {
      if (v % library::kFeatureStride < library::kFeatureCount) {
        copy[v] += static_cast<float>(dice.noise(0.0003));
      }
    }
    if (k % 30 == 29) copy = library::mirrored_features(copy);
    clips.add("", copy);
    original_of.push_back(original);
  }
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const auto found = library::find_duplicates(clips.rows(), {}, 2);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double cpu_s = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  std::vector<int> told(original_of.size(), -1);
  for (const auto& one : found) told[static_cast<std::size_t>(one.clip)] = one.original;
  // An original may itself be similar to another clip that was made of the same one.
  const auto first_of = [&](int clip) {
    const int before = told[static_cast<std::size_t>(clip)];
    return before >= 0 ? before : clip;
  };
  int copies = 0;
  int right = 0;
  int missed = 0;
  for (std::size_t k = 0; k < told.size(); ++k) {
    if (original_of[k] < 0) continue;
    ++copies;
    missed += told[k] < 0 ? 1 : 0;
    right += told[k] >= 0 && first_of(original_of[k]) == told[k] ? 1 : 0;
  }
  std::printf(
      "%d made clips, %zu rows: %.1f s on two threads, %.1f s of processor "
      "time; %d of %d copies, %d not found\n",
      options.made_clips,
      clips.values.size() / library::kFeatureStride,
      seconds,
      cpu_s,
      right,
      copies,
      missed);
}

int run(int argc, char** argv) {
  Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--half" && k + 1 < argc) {
      options.half = argv[++k];
    } else if (word == "--clips" && k + 1 < argc) {
      options.made_clips = std::atoi(argv[++k]);
    } else if (word == "--only" && k + 1 < argc) {
      options.only = argv[++k];
    } else if (word == "--list") {
      options.lists_errors = true;
    } else {
      options.folder = word;
    }
  }
  if (!options.folder.empty() && options.made_clips > 0) {
    measure_scale(options);
  } else if (!options.folder.empty()) {
    measure_library(options);
  } else {
    stop("use: measure_duplicates FOLDER [--half tuning|held|all] | --clips N");
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::run(argc, argv);
}
