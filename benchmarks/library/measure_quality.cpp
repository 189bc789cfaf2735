// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_quality FOLDER [--half tuning|held|all] [--figures FILE.csv] [--seed N]
//                 [--speed FACTOR] [--rate HZ] [--stature M]
//
// The quality gate of motion libraries on the BVH and AMC files below FOLDER: share of
// clean clips with a warning, and for each injected defect the recall, the precision of
// its kind and the agreement of its frames. docs/accuracy/library_quality.md has figures.
// Clips belong to one half by a hash of their name: limits were chosen on the tuning
// half. Other clips are made of them: faster by a factor (at the same rate), resampled to
// another rate, retargeted to an average body of another stature. Another seed puts the
// defects to other places.
#include "library/quality/measure_quality.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "library/clips/normal_form.h"
#include "library/clips/put_on_floor.h"
#include "library/quality/contradicted_sizes.h"

#include "app/motion/retarget_files.h"
#include "core/base/parallel.h"
#include "core/base/quantile.h"
#include "core/human/average_proportions.h"
#include "core/resample.h"
#include "retarget/body/body_map.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/simulation/injected_defects.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using testing::Defect;

struct Expected {
  Defect defect;
  std::set<std::string> kinds;  ///< Right names of the defect.
  double bar;                   ///< Recall; 0: only reported.
};

const std::vector<Expected>& expected() {
  static const std::vector<Expected> list{
      {Defect::kSpike5cm, {"spike"}, 0.95},
      {Defect::kSpike10cm, {"spike"}, 0.95},
      {Defect::kLegsCrossed, {"swap"}, 0.95},
      {Defect::kLegChannels, {"swap"}, 0.0},
      {Defect::kSlide10cmS, {"slide"}, 0.95},
      {Defect::kJitter1mm, {"jitter"}, 0.7},
      {Defect::kJitter3mm, {"jitter"}, 0.95},
      {Defect::kFrozenArm, {"frozen"}, 0.95},
      {Defect::kScale110, {"scale"}, 0.95},
      {Defect::kPathScale110, {"float", "scale", "slide"}, 0.0},
      {Defect::kScale100, {"scale"}, 0.95},
      {Defect::kFloor3cm, {"float"}, 0.95},
      {Defect::kTilt3deg, {"tilt"}, 0.95},
      {Defect::kForearmFlip, {"flip"}, 0.95},
      {Defect::kDoubleRate, {"rate"}, 0.0},
      {Defect::kCut300ms, {"cut"}, 0.95},
      {Defect::kMirrored, {"sides"}, 0.7},
  };
  return list;
}

std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  return hash;
}

bool is_tuned_on(const std::string& clip) {
  return (hash_of(clip) >> 32 & 1) == 0;
}

/// Changes to the clips before they are measured.
struct Changes {
  double speed = 1.0;
  double rate_hz = 0.0;    ///< 0: the clip's own.
  double stature_m = 0.0;  ///< 0: the clip's own body.
  unsigned seed = 0;
};

// False: the motion cannot be put on the other body.
bool change(const Changes& changes, Motion& motion) {
  if (changes.speed != 1.0) {
    const FrameRate own = motion.rate;
    motion.rate.hz *= changes.speed;
    motion = resample(motion, own);
  }
  if (changes.rate_hz > 0.0) motion = resample(motion, FrameRate{changes.rate_hz});
  if (changes.stature_m > 0.0) {
    const Skeleton body = make_humanoid(average_proportions(changes.stature_m));
    auto put = retarget::retarget_motion(motion, body, {});
    if (!put) return false;
    motion = std::move(put->motion);
  }
  return true;
}

// Processor time of this thread. Other programs do not change it.
double thread_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Measured {
  library::QualityResult result;
  bool tried = false;
  bool named = false;   ///< A problem has a right kind.
  bool placed = false;  ///< Such a problem has the right frames, within 3.
  bool is_local = false;
};

struct MeasuredClip {
  std::string name;
  int frames = 0;
  double seconds = 0.0;  ///< Time of measure_quality() on the clean clip.
  Measured clean;
  std::vector<Measured> defects;
};

void judge(const testing::InjectedDefect& truth,
           const std::set<std::string>& kinds,
           Measured& out) {
  out.is_local = truth.is_local;
  for (const ClipProblem& problem : out.result.problems) {
    if (!kinds.contains(problem.kind)) continue;
    out.named = true;
    out.placed =
        out.placed || (std::abs(problem.frames.first - truth.frames.first) <= 3 &&
                       std::abs(problem.frames.last - truth.frames.last) <= 3);
  }
}

MeasuredClip measure_clip(const fs::path& file, const Changes& changes) {
  MeasuredClip out;
  out.name = file.stem().string();
  auto read = app::read_motion(file);
  if (!read) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), read.error().message().c_str());
    return out;
  }
  Motion motion = std::move((*read).motion);
  auto map = retarget::map_body(motion.skeleton);
  if (!map) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), map.error().message().c_str());
    return out;
  }
  if (!change(changes, motion)) return out;
  auto clean = library::make_library_motion(motion);
  if (!clean) return out;
  map = retarget::map_body(clean->motion.skeleton);
  library::put_on_floor(clean->motion, *map);
  const double begin_s = thread_time_s();
  out.clean.result = library::measure_quality(*clean, *map, {});
  out.seconds = thread_time_s() - begin_s;
  out.clean.tried = true;
  out.frames = static_cast<int>(motion.poses.size());
  for (const Expected& one : expected()) {
    Measured measured;
    const auto seed = static_cast<unsigned>(hash_of(out.name)) +
                      static_cast<unsigned>(one.defect) + 1000003U * changes.seed;
    const auto injected = testing::inject(clean->motion, one.defect, seed);
    if (injected) {
      const auto spoilt = library::make_library_motion(injected->motion);
      if (spoilt) {
        const auto own_map = retarget::map_body(spoilt->motion.skeleton);
        measured.result = library::measure_quality(*spoilt, *own_map, {});
        measured.tried = true;
        judge(*injected, one.kinds, measured);
      }
    }
    out.defects.push_back(std::move(measured));
  }
  return out;
}

void write_figures(const std::string& file, const std::vector<MeasuredClip>& clips) {
  std::ofstream out(file);
  out << "clip,defect,main_kind,named,placed,figure,value,joint\n";
  const auto write =
      [&](const MeasuredClip& clip, std::string_view defect, const Measured& measured) {
        for (const ClipFigure& figure : measured.result.figures) {
          out << clip.name << ',' << defect << ',' << measured.result.main_kind << ','
              << measured.named << ',' << measured.placed << ',' << figure.name << ','
              << figure.value << ',' << figure.joint << '\n';
        }
      };
  for (const MeasuredClip& clip : clips) {
    if (clip.clean.tried) write(clip, "clean", clip.clean);
    for (std::size_t k = 0; k < clip.defects.size(); ++k) {
      if (clip.defects[k].tried) {
        write(clip, name(expected()[k].defect), clip.defects[k]);
      }
    }
  }
}

void print_clean(const std::vector<MeasuredClip>& clips) {
  int warned = 0;
  int tried = 0;
  long frames = 0;
  double seconds = 0.0;
  std::map<std::string, int> kinds;
  for (const MeasuredClip& clip : clips) {
    if (!clip.clean.tried) continue;
    ++tried;
    frames += clip.frames;
    seconds += clip.seconds;
    if (clip.clean.result.quality == Verdict::kPass) continue;
    ++warned;
    std::set<std::string> of_clip;
    for (const auto& problem : clip.clean.result.problems) of_clip.insert(problem.kind);
    for (const std::string& kind : of_clip) ++kinds[kind];
  }
  std::printf("%d clips, %ld frames; %.0f frames per second and core\n",
              tried,
              frames,
              static_cast<double>(frames) / seconds);
  std::printf("warned: %d (%.1f %%):", warned, 100.0 * warned / std::max(1, tried));
  for (const auto& [kind, count] : kinds) std::printf(" %s %d", kind.c_str(), count);
  std::printf("\n");
}

struct Share {
  int yes = 0;
  int all = 0;
  void add(bool is) {
    yes += is ? 1 : 0;
    ++all;
  }
  [[nodiscard]] double value() const { return all > 0 ? 1.0 * yes / all : 0.0; }
};

void print_defects(const std::vector<MeasuredClip>& clips) {
  std::printf("%-26s %6s %7s %7s %7s %7s\n",
              "defect",
              "clips",
              "warned",
              "recall",
              "kind",
              "frames");
  Share all_kinds;
  for (std::size_t k = 0; k < expected().size(); ++k) {
    const Expected& one = expected()[k];
    Share warned;
    Share recall;
    Share kind;
    Share frames;
    for (const MeasuredClip& clip : clips) {
      if (clip.defects.size() <= k || !clip.defects[k].tried) continue;
      const Measured& measured = clip.defects[k];
      // Without two flights nothing is known about the rate.
      if (one.defect == Defect::kDoubleRate) {
        const auto& figures = clip.clean.result.figures;
        const auto flights = std::find_if(
            figures.begin(), figures.end(), [](auto& f) { return f.name == "flights"; });
        if (flights->value < 2.0) continue;
      }
      const bool is_warned = measured.result.quality != Verdict::kPass;
      warned.add(is_warned);
      recall.add(measured.named);
      if (is_warned) kind.add(one.kinds.contains(measured.result.main_kind));
      if (measured.named && measured.is_local) frames.add(measured.placed);
    }
    all_kinds.yes += kind.yes;
    all_kinds.all += kind.all;
    std::printf("%-26s %6d %7.3f %7.3f %7.3f %7.3f%s\n",
                std::string(name(one.defect)).c_str(),
                recall.all,
                warned.value(),
                recall.value(),
                kind.value(),
                frames.value(),
                one.bar > 0.0 && recall.value() < one.bar ? "  short of its bar" : "");
  }
  std::printf("precision of kind, all defects: %.3f\n", all_kinds.value());
}

double figure_of(const library::QualityResult& result, std::string_view name) {
  for (const ClipFigure& figure : result.figures) {
    if (figure.name == name) return figure.value;
  }
  return 0.0;
}

// One clip of every ten is scaled by 1.1. The subjects are known, or not.
void print_sizes(const std::vector<MeasuredClip>& clips) {
  for (const bool named : {true, false}) {
    std::vector<library::ClipBody> bodies;
    std::set<std::size_t> scaled;
    for (std::size_t k = 0; k < clips.size(); ++k) {
      if (!clips[k].clean.tried) continue;
      const std::size_t at = bodies.size();
      const auto& result = at % 10 == 4 && clips[k].defects[8].tried
                               ? clips[k].defects[8].result
                               : clips[k].clean.result;
      if (&result != &clips[k].clean.result) scaled.insert(at);
      bodies.push_back({named ? std::to_string(at / 10) : "",
                        figure_of(result, "stature_m"),
                        figure_of(result, "proportions")});
    }
    int found = 0;
    int wrong = 0;
    for (const auto& size : library::find_contradicted_sizes(bodies)) {
      ++(scaled.contains(size.clip) ? found : wrong);
    }
    std::printf("scale x 1.1 of one clip in ten, %s: %d of %zu found, %d wrongly\n",
                named ? "ten clips per subject" : "subjects unknown",
                found,
                scaled.size(),
                wrong);
  }
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  using namespace marey;
  std::string folder;
  std::string half = "held";
  std::string figures;
  Changes changes;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word.rfind("--", 0) != 0 || k + 1 == argc) {
      folder = word;
      continue;
    }
    const char* value = argv[++k];
    if (word == "--half") half = value;
    if (word == "--figures") figures = value;
    if (word == "--speed") changes.speed = std::atof(value);
    if (word == "--rate") changes.rate_hz = std::atof(value);
    if (word == "--stature") changes.stature_m = std::atof(value);
    if (word == "--seed") changes.seed = static_cast<unsigned>(std::atoi(value));
  }
  if (folder.empty()) {
    std::fprintf(stderr, "use: measure_quality FOLDER [--half tuning|held|all]\n");
    return 2;
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".bvh" && ending != ".amc") continue;
    const bool tuned = is_tuned_on(entry.path().stem().string());
    if (half == "all" || tuned == (half == "tuning")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<MeasuredClip> clips(files.size());
  in_parallel(files.size(), 2, [&](std::size_t k) {
    clips[k] = measure_clip(files[k], changes);
  });
  if (!figures.empty()) write_figures(figures, clips);
  print_clean(clips);
  print_defects(clips);
  print_sizes(clips);
  return 0;
}
