// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// How often is a fit to labelled markers wrong without a word? Simulated people by seed
// (tests/support/labelled_wearer.h), half of them with a mistake that people make:
//
//   measure_fits FIRST COUNT
//
// One line per seed, then the table: sessions that are wrong and pass (a limb's joint
// more than 60 mm off, or by more than 5 of its standard deviations and 25 mm, in a tenth
// of the frames or more that call it measured), mistakes that pass, and right sessions
// that are refused, by cause. The verdicts are those of `marey fit`
// (app/label_checks.cpp, app/judge_fit.cpp) on one fit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "reconstruct/check_labels.h"
#include "reconstruct/find_exchanges.h"
#include "tests/support/labelled_wearer.h"

namespace marey {
namespace {

using reconstruct::find_landmark;
using reconstruct::LabelFault;
using reconstruct::Landmark;
using reconstruct::NamedMarker;
using testing::exchange;

/// A wearer with the names that its labels mean.
struct NamedWearer : testing::LabelledWearer {
  std::vector<NamedMarker> labels;
};

NamedWearer wearer(int seed) {
  const auto place_of = [](const std::string& name) {
    const Landmark* landmark = find_landmark(name);
    return testing::WornPlace{landmark->segment,
                              landmark->p_in_segment_per_stature,
                              landmark->sigma_per_stature};
  };
  NamedWearer out{testing::wearer(seed, place_of), {}};
  for (const auto& worn : out.LabelledWearer::labels) {
    out.labels.push_back({worn.label, find_landmark(worn.landmark)});
  }
  return out;
}

/// What is done to a session.
enum class Mistake { kNone, kInTrial, kInAll, kLegs, kMovedMarker, kUnknown };
constexpr std::array kMistakes{"none",
                               "two labels exchanged in a trial",
                               "two labels exchanged in all",
                               "legs exchanged in all",
                               "a marker glued elsewhere",
                               "labels without a meaning"};

constexpr std::array<std::array<const char*, 2>, 6> kPairs{{{"LTHI", "LKNE"},
                                                            {"LKNE", "RKNE"},
                                                            {"RANK", "RHEE"},
                                                            {"LASI", "LPSI"},
                                                            {"RELB", "RWRA"},
                                                            {"LSHO", "RSHO"}}};

Mistake mistake_of(int seed) {
  if (seed % 2 == 0) return Mistake::kNone;
  return static_cast<Mistake>(1 + (seed / 2) % 5);
}

void make(Mistake mistake, int seed, NamedWearer& one) {
  const auto& [a, b] = kPairs[static_cast<std::size_t>(seed / 10) % kPairs.size()];
  switch (mistake) {
    case Mistake::kNone:
      break;
    case Mistake::kInTrial:
      exchange(one.trials[static_cast<std::size_t>(seed / 20) % 3], a, b);
      break;
    case Mistake::kInAll:
      for (MarkerTracks& tracks : one.trials) exchange(tracks, a, b);
      break;
    case Mistake::kLegs:
      for (MarkerTracks& tracks : one.trials) {
        for (const char* part :
             {"THI", "KNE", "KNM", "TIB", "ANK", "MED", "HEE", "TOE"}) {
          exchange(tracks, std::string("L") + part, std::string("R") + part);
        }
      }
      break;
    case Mistake::kMovedMarker: {
      MarkerTracks& tracks = one.trials[1];
      const auto at = std::find(tracks.labels.begin(), tracks.labels.end(), a);
      const auto column = static_cast<std::size_t>(at - tracks.labels.begin());
      for (std::size_t f = 0; f < tracks.frames(); ++f) {
        if (auto& sample = tracks.at(f, column)) sample->p_in_world.y += 0.08;
      }
      break;
    }
    case Mistake::kUnknown:
      for (reconstruct::NamedMarker& marker : one.labels) {
        if (marker.label == "LFIN" || marker.label == "RFIN" || marker.label == "LSHO") {
          marker.landmark = nullptr;
        }
      }
      break;
  }
}

struct Outcome {
  bool is_refused = false;
  std::string cause;
  double worst_m = 0.0;  ///< The joint with the largest tenth of its errors.
  double worst_sigmas = 0.0;
  double stature_off = 0.0;  ///< In standard deviations.
};

/// The ninth tenth of a joint's errors over the frames that call it measured.
void judge_joints(const NamedWearer& one,
                  std::size_t trial,
                  const reconstruct::SolvedMarkers& solved,
                  Outcome& out) {
  const Skeleton skeleton = make_humanoid(one.person.proportions);
  const EstimatedMotion& estimate = solved.estimate;
  for (const HumanBone bone : testing::limb_joints()) {
    std::vector<double> errors_m;
    std::vector<double> errors_sigmas;
    for (std::size_t f = 0; f < estimate.motion.poses.size(); f += 5) {
      const JointDoubt& doubt = estimate.doubt[f][index(bone)];
      if (doubt.source != Source::kMeasured) continue;
      const double time_s = static_cast<double>(f) / one.trials[trial].rate.hz;
      const glm::dvec3 truth =
          world_from_joints(skeleton, one.movements[trial](time_s))[index(bone)]
              .translation;
      const glm::dvec3 ours = world_from_joints(estimate.motion.skeleton,
                                                estimate.motion.poses[f])[index(bone)]
                                  .translation;
      errors_m.push_back(glm::distance(truth, ours));
      errors_sigmas.push_back(errors_m.back() / (1.7320508 * doubt.sigma_m));
    }
    if (errors_m.size() < 5) continue;
    std::sort(errors_m.begin(), errors_m.end());
    std::sort(errors_sigmas.begin(), errors_sigmas.end());
    const std::size_t at = errors_m.size() * 9 / 10;
    out.worst_m = std::max(out.worst_m, errors_m[at]);
    if (errors_m[at] > 0.025) {
      out.worst_sigmas = std::max(out.worst_sigmas, errors_sigmas[at]);
    }
  }
}

void refuse(Outcome& out, const std::string& cause) {
  if (!out.is_refused) out.cause = cause;
  out.is_refused = true;
}

Outcome run(int seed, Mistake mistake) {
  NamedWearer one = wearer(seed);
  make(mistake, seed, one);
  Outcome out;
  const auto fit = reconstruct::fit_markers({}, one.trials, one.labels);
  if (!fit) {
    refuse(out, "no fit");
    return out;
  }
  std::vector<reconstruct::SolvedMarkers> solved;
  for (const MarkerTracks& tracks : one.trials) {
    auto trial = reconstruct::solve_markers(fit->body, tracks);
    if (!trial) {
      refuse(out, "no motion");
      return out;
    }
    solved.push_back(*std::move(trial));
  }
  std::vector<reconstruct::CheckedTrial> trials;
  for (std::size_t t = 0; t < solved.size(); ++t) {
    trials.push_back({&one.trials[t], &solved[t]});
    judge_joints(one, t, solved[t], out);
    if (solved[t].rms_m > 0.030) refuse(out, "far off");
    for (const auto& marker : solved[t].markers) {
      if (marker.rms_m > 0.055) refuse(out, "a marker far off");
    }
  }
  int left_out = 0;
  for (const auto& finding : check_trials(fit->body, one.labels, trials)) {
    if (finding.fault == LabelFault::kExchanged) refuse(out, "exchanged in a trial");
    if (finding.off_m > 0.040) refuse(out, "strays");
  }
  for (const auto& finding : check_fit(*fit, one.labels)) {
    if (finding.fault == LabelFault::kLeftOut) ++left_out;
    if (finding.fault != LabelFault::kLeftOut)
      refuse(out, std::string(name(finding.fault)));
  }
  if (left_out > 1) refuse(out, "left out");
  if (!out.is_refused && find_exchange({}, one.trials, one.labels, *fit)) {
    refuse(out, "exchanged in all");
  }
  if (fit->measured_stature) {
    out.stature_off = (fit->measured_stature->stature_m - one.person.stature_m) /
                      fit->measured_stature->sigma_m;
  }
  return out;
}

int measure(int first, int count) {
  std::array<std::array<int, 3>, kMistakes.size()> table{};
  int within = 0;
  for (int seed = first; seed < first + count; ++seed) {
    const Mistake mistake = mistake_of(seed);
    const Outcome out = run(seed, mistake);
    const bool is_wrong = out.worst_m > 0.060 || out.worst_sigmas > 5.0;
    auto& row = table[static_cast<std::size_t>(mistake)];
    ++row[0];
    row[1] += out.is_refused ? 1 : 0;
    row[2] += !out.is_refused && is_wrong ? 1 : 0;
    within += std::abs(out.stature_off) < 2.0 ? 1 : 0;
    std::printf(
        "%4d %-32s %s%s, worst joint %.0f mm, %.1f sigmas, stature %+.1f sigmas\n",
        seed,
        kMistakes[static_cast<std::size_t>(mistake)],
        out.is_refused ? "refused: " : "passed",
        out.cause.c_str(),
        1e3 * out.worst_m,
        out.worst_sigmas,
        out.stature_off);
    std::fflush(stdout);
  }
  std::printf("\n%-32s sessions  refused  wrong and passed\n", "mistake");
  int silent = 0;
  for (std::size_t i = 0; i < kMistakes.size(); ++i) {
    std::printf(
        "%-32s %8d %8d %8d\n", kMistakes[i], table[i][0], table[i][1], table[i][2]);
    silent += table[i][2];
  }
  std::printf("statures within 2 sigmas: %d of %d\n", within, count);
  return silent == 0 ? 0 : 1;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: measure_fits FIRST COUNT\n");
    return 2;
  }
  return marey::measure(std::atoi(argv[1]), std::atoi(argv[2]));
}
