// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures splices of captured motions against crossfades.
//
//   measure_splices ../shared/data/mocap [--pairs]
//   measure_splices --clips FILE... [--pairs]
//
// Joins each of seven clips (walk, run, punch, kick, dance of CMU and Bandai Namco) to
// each other one: 42 ordered pairs. The second clip is brought to the first one's rate
// and body before, for all methods. The splice chooses its frames and, unless it is
// given, its overlap; a crossfade of 0.3 s with linear weights is measured at the same
// frames, and at five random pairs of frames (fixed seed). All methods get the best
// planar move for their frames.
//
// Slide: horizontal speed of ankle and toe joint in the frames of the overlap, while the
// clip that weighs more has the contact there (retarget::detect_contacts() of that clip).
// A second label is independent of that detection: slower than 0.2 m/s and lower than
// 5 cm in that clip (retarget::label_contacts()); the clips themselves slide under it, so
// their own slide in these frames stands next to it. Acceleration: the largest of a joint
// within 0.3 s of the join and in the overlap, over the largest of the two whole clips;
// and that of the whole joined motion, by which a join is within the bar: planted feet
// change frames beyond the overlap. The measure has its
// own forward kinematics, labels and differences; it takes from the splice only which
// frame of which clip a frame shows. --pairs prints each pair.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "edit/find/find_splice.h"
#include "edit/splice/splice_source.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "benchmarks/editing/splice_figures.h"
#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/format_text.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/contacts/measure_contacts.h"

namespace marey {
namespace {

using edit::EditState;

constexpr double kSlideBar_cm_per_s = 0.3;
constexpr double kAccelerationBar = 1.1;
constexpr int kRandomPairs = 5;

struct Clip {
  std::string name;
  EditState state;
};

/// One pair by one method.
struct Measured {
  std::string pair;
  double slide = 0.0;         ///< [cm/s], contacts of the clips
  double worst = 0.0;         ///< [cm/s], largest speed of a point
  double slow_slide = 0.0;    ///< [cm/s], second label
  double clip_slide = 0.0;    ///< [cm/s], second label, the clips' own
  double acceleration = 0.0;  ///< Over the clips', near the join.
  double whole = 0.0;         ///< The same, in the whole joined motion.
  Peak fastest;
  Peak hardest;  ///< In the whole joined motion.
  int join = 0;
  double hz = 0.0;
  std::string cause;
};

struct PairOfClips {
  std::string name;
  const EditState& a;
  const EditState& b;
  std::array<ClipLabels, 2> labels;
  double peak = 0.0;  ///< Largest acceleration of both clips.
};

/// Slide of the clips themselves in the frames that the joined motion shows.
double own_slow_slide(const Joined& joined, const PairOfClips& pair) {
  Slide sum;
  for (int clip = 0; clip < 2; ++clip) {
    const EditState& state = clip == 0 ? pair.a : pair.b;
    int first = -1;
    int last = -1;
    for (int t = joined.first; t <= joined.last; ++t) {
      const ShownFrame& shown = joined.shown[static_cast<std::size_t>(t)];
      if (shown.clip != clip) continue;
      if (first < 0) first = shown.frame;
      last = shown.frame;
    }
    if (first < 0) continue;
    Joined alone{state.motion, {}, 0, first, last};
    for (int t = 0; t < state.frame_count(); ++t) alone.shown.push_back({clip, t});
    const Slide slide =
        slide_of(alone, state.map, {&pair.labels[0].slow, &pair.labels[1].slow});
    sum.way_m += slide.way_m;
    sum.steps += slide.steps;
  }
  return sum.cm_per_s(pair.a.motion.rate.hz);
}

Measured measure(const Joined& joined, const PairOfClips& pair) {
  const double hz = pair.a.motion.rate.hz;
  const int near = static_cast<int>(std::lround(0.3 * hz));
  Measured out;
  out.pair = pair.name;
  const Slide slide =
      slide_of(joined, pair.a.map, {&pair.labels[0].contacts, &pair.labels[1].contacts});
  out.slide = slide.cm_per_s(hz);
  out.worst = 100.0 * slide.worst.value * hz;
  out.fastest = slide.worst;
  out.join = joined.join;
  out.hz = hz;
  out.slow_slide =
      slide_of(joined, pair.a.map, {&pair.labels[0].slow, &pair.labels[1].slow})
          .cm_per_s(hz);
  out.clip_slide = own_slow_slide(joined, pair);
  out.acceleration = peak_acceleration(joined.motion,
                                       std::min(joined.first, joined.join - near),
                                       std::max(joined.last, joined.join + near))
                         .value /
                     pair.peak;
  out.hardest =
      peak_acceleration(joined.motion, 0, static_cast<int>(joined.motion.poses.size()));
  out.whole = out.hardest.value / pair.peak;
  return out;
}

std::string cause_of(const Measured& m, const edit::OpReport& report) {
  std::string out;
  const auto place = [&](const char* what, const Peak& peak) {
    return format_text("%s of %s %+.2f s from the join; ",
                       what,
                       peak.joint.c_str(),
                       (peak.frame - m.join) / m.hz);
  };
  if (m.slide > kSlideBar_cm_per_s) out += place("slide", m.fastest);
  if (m.whole > kAccelerationBar) out += place("acceleration", m.hardest);
  if (out.empty()) return out;
  for (const Finding& finding : report.findings) {
    if (finding.id != "candidates") out += "[" + finding.id + "] ";
  }
  return out;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

void add_summary(const std::string& method,
                 const std::vector<Measured>& all,
                 ResultTable& table) {
  const auto column = [&](double Measured::*value) {
    std::vector<double> out;
    for (const Measured& m : all) out.push_back(m.*value);
    return out;
  };
  const auto worst = [&](double Measured::*value) {
    double out = 0.0;
    for (const Measured& m : all) out = std::max(out, m.*value);
    return out;
  };
  const auto within = std::count_if(all.begin(), all.end(), [](const Measured& m) {
    return m.slide <= kSlideBar_cm_per_s && m.whole <= kAccelerationBar;
  });
  table.rows.push_back({method,
                        static_cast<double>(all.size()),
                        median_of(column(&Measured::slide)),
                        worst(&Measured::slide),
                        median_of(column(&Measured::worst)),
                        median_of(column(&Measured::slow_slide)),
                        median_of(column(&Measured::clip_slide)),
                        median_of(column(&Measured::acceleration)),
                        worst(&Measured::acceleration),
                        worst(&Measured::whole),
                        static_cast<double>(within)});
}

// Adds a clip unless it cannot be read, which is reported.
void add_clip(const std::filesystem::path& file,
              const std::string& name,
              std::vector<Clip>& out) {
  const auto clip = read_clip(file, name);
  if (!clip) {
    std::fprintf(stderr, "%s\n", clip.error().message().c_str());
    return;
  }
  auto state =
      edit::make_edit_state({clip->character.skeleton, {clip->rate_hz}, 0, clip->poses});
  if (state) out.push_back({name, *std::move(state)});
}

std::vector<Clip> read_seven(const std::filesystem::path& mocap) {
  std::vector<Clip> out;
  for (const auto& [name, path] :
       {std::pair{"walk CMU", "cmu_asfamc/02_01.amc"},
        std::pair{"run CMU", "cmu_asfamc/02_03.amc"},
        std::pair{"punch CMU", "cmu_asfamc/02_05.amc"},
        std::pair{"dance CMU", "cmu_bvh_tmoco/05_06.bvh"},
        std::pair{"walk Bandai", "bandai/dataset-1_walk_normal_001.bvh"},
        std::pair{"kick Bandai", "bandai/dataset-1_kick_normal_001.bvh"},
        std::pair{"dance Bandai", "bandai/dataset-1_dance-short_normal_001.bvh"}}) {
    add_clip(mocap / path, name, out);
  }
  return out;
}

/// The second clip at the first one's rate and on its body.
std::optional<EditState> fitted(const EditState& a, const EditState& b) {
  edit::EditInputs inputs;
  inputs.sources.emplace("next", b);
  edit::OpReport report;
  auto made = edit::fit_splice_source(a, "next", inputs, report);
  if (!made) return std::nullopt;
  auto state = edit::make_edit_state(std::move(made->motion), {}, 1);
  if (!state) return std::nullopt;
  return *std::move(state);
}

struct Results {
  std::vector<Measured> chosen;        ///< The splice chooses its overlap.
  std::vector<Measured> given;         ///< An overlap of 0.3 s.
  std::vector<Measured> displaced;     ///< No overlap.
  std::vector<Measured> given_frames;  ///< The splice is given random frames.
  std::vector<Measured> same_frames;
  std::vector<Measured> random_frames;
};

void add_run(const SpliceRun& run, const PairOfClips& pair, std::vector<Measured>& out) {
  out.push_back(measure(run.joined, pair));
  out.back().cause = cause_of(out.back(), run.report);
}

void measure_pair(const PairOfClips& pair, std::mt19937& random, Results& out) {
  const auto made = splice(pair.a, pair.b, {});
  if (made) {
    add_run(*made, pair, out.chosen);
    out.same_frames.push_back(
        measure(crossfade(pair.a, pair.b, made->leave, made->enter), pair));
  } else {
    std::printf("%s: %s\n", pair.name.c_str(), made.error().message().c_str());
  }
  SpliceOp op;
  op.overlap_s = kOverlap_s;
  if (const auto given = splice(pair.a, pair.b, op)) add_run(*given, pair, out.given);
  op.overlap_s = 0.0;
  if (const auto run = splice(pair.a, pair.b, op)) add_run(*run, pair, out.displaced);
  op.overlap_s.reset();
  for (int k = 0; k < kRandomPairs; ++k) {
    const auto draw = [&](const EditState& state) {
      const auto count = static_cast<unsigned>(state.frame_count() * 8 / 10);
      return static_cast<int>(random() % count) + state.frame_count() / 10;
    };
    const int leave = draw(pair.a);
    const int enter = draw(pair.b);
    out.random_frames.push_back(measure(crossfade(pair.a, pair.b, leave, enter), pair));
    op.at = AtFrame{static_cast<double>(leave)};
    op.enter_at = AtFrame{static_cast<double>(enter)};
    if (const auto run = splice(pair.a, pair.b, op))
      add_run(*run, pair, out.given_frames);
  }
}

void print_pairs(const char* method, const std::vector<Measured>& all) {
  std::printf("\n%s: slide, worst cm/s; second label, clips'; acceleration\n", method);
  for (const Measured& m : all) {
    std::printf("%-28s %6.2f %7.2f  %6.2f %6.2f  %5.2f  %s\n",
                m.pair.c_str(),
                m.slide,
                m.worst,
                m.slow_slide,
                m.clip_slide,
                m.whole,
                m.cause.c_str());
  }
}

void print_misses(const char* method, const std::vector<Measured>& all) {
  for (const Measured& m : all) {
    if (m.cause.empty()) continue;
    std::printf("over a limit%s: %s: %.2f cm/s, acceleration %.2f: %s\n",
                method,
                m.pair.c_str(),
                m.slide,
                m.whole,
                m.cause.c_str());
  }
}

// Joins whose acceleration misses the limit and whose report does not say so.
int count_silent(const std::vector<Measured>& all) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), [](const Measured& m) {
    return m.whole > kAccelerationBar &&
           m.cause.find("[acceleration]") == std::string::npos;
  }));
}

int run(const std::vector<Clip>& clips, bool has_pairs) {
  std::mt19937 random(7);
  Results results;
  for (const Clip& a : clips) {
    for (const Clip& b : clips) {
      if (&a == &b) continue;
      const auto second = fitted(a.state, b.state);
      if (!second) continue;
      PairOfClips pair{a.name + " - " + b.name, a.state, *second, {}, 0.0};
      pair.labels = {labels_of(pair.a), labels_of(pair.b)};
      pair.peak =
          std::max(peak_acceleration(pair.a.motion, 0, pair.a.frame_count()).value,
                   peak_acceleration(pair.b.motion, 0, pair.b.frame_count()).value);
      measure_pair(pair, random, results);
    }
  }
  ResultTable table{"splices",
                    "Joins of captured motions",
                    {{"method"},
                     {"joins", 0},
                     {"slide cm/s, median", 2},
                     {"worst", 2},
                     {"fastest point, median", 2},
                     {"second label, median", 2},
                     {"clips' own", 2},
                     {"acceleration, median", 2},
                     {"worst", 2},
                     {"whole motion, worst", 2},
                     {"within 0.3 cm/s and 1.1", 0}},
                    {},
                    {}};
  add_summary("splice", results.chosen, table);
  add_summary("splice, overlap 0.3 s", results.given, table);
  add_summary("splice, overlap 0", results.displaced, table);
  add_summary("splice, random frames", results.given_frames, table);
  add_summary("crossfade, same frames", results.same_frames, table);
  add_summary("crossfade, random frames", results.random_frames, table);
  print_table(table);
  int silent = 0;
  print_misses("", results.chosen);
  print_misses(" (overlap 0.3 s)", results.given);
  print_misses(" (overlap 0)", results.displaced);
  for (const auto* all :
       {&results.chosen, &results.given, &results.displaced, &results.given_frames}) {
    silent += count_silent(*all);
  }
  std::printf("accelerations over the limit without a finding: %d\n", silent);
  if (has_pairs) {
    print_pairs("splice", results.chosen);
    print_pairs("splice, overlap 0.3 s", results.given);
    print_pairs("splice, overlap 0", results.displaced);
    print_pairs("crossfade, same frames", results.same_frames);
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool has_pairs = std::erase(words, "--pairs") > 0;
  std::vector<marey::Clip> clips;
  if (words.size() > 1 && words.front() == "--clips") {
    for (std::size_t k = 1; k < words.size(); ++k) {
      marey::add_clip(words[k], std::filesystem::path(words[k]).stem().string(), clips);
    }
  } else if (words.size() == 1) {
    clips = marey::read_seven(words.front());
  } else {
    std::fprintf(stderr,
                 "usage: measure_splices MOCAP_FOLDER [--pairs]\n"
                 "       measure_splices --clips FILE... [--pairs]\n");
    return 2;
  }
  return marey::run(clips, has_pairs);
}
